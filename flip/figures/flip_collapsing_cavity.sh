#!/bin/sh
# flip_collapsing_cavity.sh PIC FLIP FOLDER: an empty cavity that closes, in the middle of a drop and, on twice the cells, at a wall.
set -eu
export LC_ALL=C.UTF-8
folder=$3
"$2" flip/cases/collapsing_cavity.toml --resume --quiet --threads 1 --out "$folder/drop"
"$2" flip/cases/collapsing_cavity.toml grid.cells_x=160 grid.cells_z=160 region.liquid.radius=3.6 region.cavity.center_z=1 time.cfl=0.3 time.end=1.2 output.particles_interval=0.1 theory.compare='"none"' --resume --quiet --threads 1 --out "$folder/wall"
