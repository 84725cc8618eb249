#!/bin/sh
# mpm_implicit_identity.sh PROGRAM FOLDER: an oblique rebound with friction, with a theta above one half and the lumped mass matrix, so that every term of the energy theorem has its part.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
"$program" mpm_implicit/cases/rebound.toml grain.left.y=0.2 grain.right.y=0.4 grid.cells_y=32 grid.low_y=-0.1 contact.friction=0.3 method.theta=0.75 method.mass=lumped theory.compare=none output.particles_interval=0 --resume --quiet --out "$folder/oblique"
