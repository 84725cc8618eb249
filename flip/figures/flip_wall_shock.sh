#!/bin/sh
# flip_wall_shock.sh PIC FLIP FOLDER: a cold stream against a wall and a piston in warm gas, with artificial viscosity and without.
set -eu
export LC_ALL=C.UTF-8
folder=$3

for case in wall_shock piston; do
    for program in "$1" "$2"; do
        run() { "$program" "flip/cases/$case.toml" --resume --quiet --threads 1 --out "$folder/${case}_$(basename "$program")$1" $2; }
        run "" ""
        end=0.8
        if [ $case = wall_shock ]; then end=2; fi
        run _without_q "viscosity.linear=0 viscosity.quadratic=0 time.end=$end"
    done
done
