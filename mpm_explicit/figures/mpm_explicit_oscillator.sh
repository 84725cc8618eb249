#!/bin/sh
# mpm_explicit_oscillator.sh PROGRAM FOLDER: one free node between two fixed ends, with particles at rest, for omega dt = 0.5, 1.9 and 2.02. The time step follows
# from omega h/c = (4/3 - 1/(3 n^2))^1/2, exact for n x n particles in a cell, here 2 x 2: (5/4)^1/2; h = 1, and c = 3.6690 for E = 1e4, nu = 0.3, density = 1000.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for omega_dt in 0.5 1.9 2.02; do
    dt=$(awk -v w=$omega_dt 'BEGIN { printf "%.15g", w / sqrt(1.25 * 10 * 0.7 / (1.3 * 0.4)) }')
    end=$(awk -v dt="$dt" 'BEGIN { printf "%.15g", 80 * dt }')
    "$program" mpm_explicit/cases/oscillator.toml time.alpha=2 time.dt="$dt" time.end="$end" time.energy_limit=0 --threads 1 --resume --quiet --out "$folder/omega_dt_$omega_dt"
done
