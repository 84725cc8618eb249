#!/bin/sh
# fig02.sh PROGRAM FOLDER: the rebound with a quarter of the CFL number and with all of it, up to the middle of the contact and to the end. The mesh is as fine as the case's, its nodes are the same,
# and it reaches farther on all sides: grains that burst need room.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for alpha in 0.25 1; do
    for end in 0.7 2; do
        "$program" mpm_explicit/cases/rebound.toml time.alpha=$alpha time.end=$end time.energy_limit=0 output.particles_interval=$end \
            grid.cells_x=64 grid.cells_y=32 grid.length_x=1.6 grid.low_x=-0.2 grid.low_y=-0.1 --threads 1 --resume --quiet --out "$folder/alpha_${alpha}_to_$end"
    done
done
