#!/bin/sh
# mpm_explicit_energy.sh PROGRAM FOLDER: the rebound with CFL numbers up to 1; and, with a quarter, grains that press wherever they approach and share nodes. The mesh is as fine as the case's, its
# nodes are the same, and it reaches farther on all sides: grains that burst need room.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
rebound() {
    "$program" mpm_explicit/cases/rebound.toml time.energy_limit=0 output.particles_interval=0 grid.cells_x=64 grid.cells_y=32 grid.length_x=1.6 grid.low_x=-0.2 grid.low_y=-0.1 \
        --threads 1 --resume --quiet --out "$@"
}
# Status 3: a particle has left even this mesh.
for alpha in 0.25 0.5 0.7 0.9 1; do rebound "$folder/alpha_$alpha" time.alpha=$alpha || test $? = 3; done
rebound "$folder/on_approach" contact.separation=0
