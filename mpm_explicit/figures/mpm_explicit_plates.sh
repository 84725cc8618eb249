#!/bin/sh
# mpm_explicit_plates.sh PROGRAM FOLDER: a block below a plate that goes down and up, which yields or does not; and one below a plate that stops, with contact on both velocities of the leapfrog and on the new one alone (status 3).
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
"$program" mpm_explicit/cases/cyclic_plate.toml --threads 1 --resume --quiet --out "$folder/yields"
"$program" mpm_explicit/cases/cyclic_plate.toml material.default.law=elastic --threads 1 --resume --quiet --out "$folder/elastic"
"$program" mpm_explicit/cases/plate_holds.toml --threads 1 --resume --quiet --out "$folder/both"
"$program" mpm_explicit/cases/plate_holds.toml contact.levels=1 --threads 1 --resume --quiet --out "$folder/new" 2>"$folder/burst.txt" || [ $? = 3 ]
