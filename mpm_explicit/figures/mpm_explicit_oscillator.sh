#!/bin/sh
# mpm_explicit_oscillator.sh PROGRAM FOLDER: one free node between two fixed ends, with particles at rest, for omega dt = 0.5, 1.9 and 2.02. The CFL number alpha = c dt/h follows
# from omega h/c = (4/3 - 1/(3 n^2))^1/2, exact for n x n particles in a cell, here 2 x 2: (5/4)^1/2.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for omega_dt in 0.5 1.9 2.02; do
    # The time step also counts the velocity of the particles, a millionth of that of sound.
    alpha=$(awk -v w=$omega_dt 'BEGIN { printf "%.15g", w / sqrt(1.25) }')
    "$program" mpm_explicit/cases/oscillator.toml time.alpha="$alpha" time.energy_limit=0 --threads 1 --resume --quiet --out "$folder/omega_dt_$omega_dt"
done
