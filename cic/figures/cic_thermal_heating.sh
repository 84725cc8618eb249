#!/bin/sh
# cic_thermal_heating.sh PROGRAM FOLDER: a warm plasma at rest on meshes that do and do not resolve its Debye length; one table per scheme in FOLDER.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for scheme in ngp_momentum cic_momentum tsc_momentum cic_energy; do
    table=$folder/$scheme.dat
    echo 'debye_length_over_dx kinetic_over_initial debye_length_over_dx_at_the_end' > "$table.partial"
    for ratio in 0.05 0.1 0.2 0.3183 0.5 1; do
        run=$folder/runs/${scheme}_$ratio
        "$program" cic/cases/thermal_heating.toml method.weighting=${scheme%_*} method.scheme=${scheme#*_} grid.length_x="$(awk -v r=$ratio 'BEGIN { print 64 / r }')" \
            --threads 1 --resume --quiet --out "$run" 2> "$folder/warnings"
        result() { awk -v key="results.$1.value" -f common/json_lines.awk "$run/summary.json"; }
        echo "$ratio $(result kinetic_over_initial) $(result debye_length_over_dx)" >> "$table.partial"
    done
    mv "$table.partial" "$table"
done
