#!/bin/sh
# mpm_explicit_sulsky_disks.sh PROGRAM FOLDER: the colliding disks, pressed where they touch, and wherever they approach and share nodes.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
disks() { "$program" mpm_explicit/cases/sulsky_disks.toml output.particles_interval=0.5 --threads 1 --resume --quiet --out "$@"; }
disks "$folder/when_near"
disks "$folder/on_approach" contact.separation=0
