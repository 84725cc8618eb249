#!/bin/sh
# mpm_implicit_iterations.sh PROGRAM FOLDER: the compressed grains on a coarser mesh with CFL numbers from 1/4 to 64 and both preconditioners of conjugate gradients; in iterations.dat what they took.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
PROGRAM=$program SWEEP=$folder SWEEP_NAME='{1}_{2}' sh common/sweep.sh mpm_implicit/cases/compressed.toml solver.preconditioner=grains,diagonal \
    time.alpha=0.25,0.5,1,2,4,8,16,32,64 -- grid.cells_x=40 grid.cells_y=34 time.end=0.3 theory.compare=none output.fringes_interval=0
echo 'alpha grains_iterations grains_solves diagonal_iterations diagonal_solves' > "$folder/iterations.new"
for alpha in 0.25 0.5 1 2 4 8 16 32 64; do
    line=$alpha
    for preconditioner in grains diagonal; do
        run=$folder/${preconditioner}_$alpha
        of() { awk -v key="performance.$1" -f common/json_lines.awk "$run/summary.json"; }
        line="$line $(of iterations_per_step) $(of loops_per_step)"
    done
    echo "$line" | awk '{ print $1, $2 / $3, $3, $4 / $5, $5 }' >> "$folder/iterations.new"
done
mv "$folder/iterations.new" "$folder/iterations.dat"
