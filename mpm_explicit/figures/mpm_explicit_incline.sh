#!/bin/sh
# mpm_explicit_incline.sh PROGRAM FOLDER: a block and a cylinder on a plate inclined by 30 degrees, with several coefficients of friction; accelerations as a table of each.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
mkdir -p "$folder"
for body in block cylinder; do
    table=$folder/$body.dat
    case=mpm_explicit/cases/incline_block.toml
    [ $body = block ] || case=mpm_explicit/cases/rolling_cylinder.toml
    echo 'friction acceleration theory' > "$table.partial"
    for friction in 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7; do
        run=$folder/${body}_$friction
        "$program" "$case" contact.friction=$friction --threads 1 --resume --quiet --out "$run" 2>"$folder/results.txt"
        number() { awk -v key=results.acceleration.$1 -f common/json_lines.awk "$run/summary.json"; }
        echo "$friction $(number value) $(number expected)" >> "$table.partial"
    done
    mv "$table.partial" "$table"
done
