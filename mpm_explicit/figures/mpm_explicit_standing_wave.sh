#!/bin/sh
# mpm_explicit_standing_wave.sh PROGRAM FOLDER: the wave between rollers on meshes of 8 to 128 cells, with three shape functions; its error as a table of each.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
mkdir -p "$folder"
wave() {
    name=$1
    shift
    table=$folder/$name.dat
    echo 'cells velocity_error' > "$table.partial"
    for cells in 8 16 32 64 128; do
        run=$folder/runs/${name}_$cells
        "$program" mpm_explicit/cases/standing_wave.toml grid.cells_x=$cells grid.cells_y=$((cells / 4)) --threads 1 --resume --quiet --out "$run" "$@"
        echo "$cells $(awk -v key=results.velocity_error.value -f common/json_lines.awk "$run/summary.json")" >> "$table.partial"
    done
    mv "$table.partial" "$table"
}
wave linear
wave gimp method.shape=gimp
wave quadratic method.shape=quadratic
