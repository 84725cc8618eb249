#!/bin/sh
# flip_gresho.sh PIC FLIP FOLDER: one turn of the Gresho vortex at Mach 0.1, 0.01 and 0.001, its particles following the mesh in three ways; and at 0.001 with the density of cells.
set -eu
export LC_ALL=C.UTF-8
flip=$2
folder=$3

for mach in 0.1 0.01 0.001; do
    pressure=$(awk -v M=$mach 'BEGIN { printf "%.17g", 1 / (1.4 * M * M) - 0.5 }')
    for transfer in flip apic pic; do
        "$flip" flip/cases/gresho.toml region.gas.pressure="$pressure" flip.transfer=$transfer output.fields_interval=1.256 \
            --resume --quiet --out "$folder/$transfer-$mach"
    done
done
# It would not reach the end: what is noise moves ever faster.
"$flip" flip/cases/gresho.toml flip.density=cells time.end=0.1 --resume --quiet --out "$folder/cells"
