#!/bin/sh
# mpm_rolling.sh IMPLICIT EXPLICIT FOLDER: a cylinder rolls down 30 degrees on three meshes, in both programs; its results as a table of each. Runs whose results fail are part of the picture (status 0).
set -eu
export LC_ALL=C.UTF-8
folder=$3
mkdir -p "$folder"
for program in "$1" "$2"; do
    name=$(basename "$program")
    table=$folder/$name.dat
    echo 'cells acceleration theory vertical_speed speed_over_rim' > "$table.partial"
    for cells in 4 8 16; do
        run=$folder/${name}_$cells
        "$program" "$name/cases/rolling_cylinder.toml" grid.cells_x=$((20 * cells)) grid.cells_y=$((4 * cells)) theory.tolerance="$(awk "BEGIN { print 0.12 / $cells }")" --threads 1 --resume --quiet --out "$run" 2>"$folder/results.txt"
        number() { awk -v key=results.$1 -f common/json_lines.awk "$run/summary.json"; }
        echo "$cells $(number acceleration.value) $(number acceleration.expected) $(number vertical_speed.value) $(number speed_over_rim.value)" >> "$table.partial"
    done
    mv "$table.partial" "$table"
done
