#!/bin/sh
# flip_gravity_wave.sh PIC FLIP FOLDER: a wave on water, with steps of two levels theta, with another transfer, and on half the cells; longer than the water stays quiet with the transfer of flip.
set -eu
export LC_ALL=C.UTF-8
flip=$2
folder=$3
wave=flip/cases/gravity_wave.toml

"$flip" $wave time.end=20 output.particles_interval=0.5 --resume --quiet --out "$folder/flip"
"$flip" $wave time.end=20 flip.transfer=xpic --resume --quiet --out "$folder/xpic"
"$flip" $wave flip.theta=0.5 time.dt=0.05 time.end=6 --resume --quiet --out "$folder/theta"
"$flip" $wave grid.cells_x=16 grid.cells_z=32 theory.tolerance=0.06 --resume --quiet --out "$folder/coarse"
