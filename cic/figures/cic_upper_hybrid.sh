#!/bin/sh
# cic_upper_hybrid.sh PROGRAM FOLDER: the wave of upper_hybrid.toml in magnetic fields of several strengths; the frequencies as a table, and the orbit of one electron, where
# the displacement is largest, in three of them.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
table=$folder/frequencies.dat
echo 'Omega_c omega' > "$table.partial"
wave() { "$program" cic/cases/upper_hybrid.toml output.particles_interval="$1" --threads 1 --resume --quiet --out "$2" plasma.B_y="$3" theory.near="$4" time.end="$5"; }
for B in 0.25 0.5 0.75 1 1.25 1.5 1.75 2; do
    run=$folder/runs/$B
    near=$(awk -v B=$B 'BEGIN { print sqrt(1 + B^2) }')
    wave 0 "$run" $B "$near" 200
    echo "$B $(awk -v key=results.omega.value -f common/json_lines.awk "$run/summary.json")" >> "$table.partial"
    case $B in 0.5 | 1 | 2) ;; *) continue ;; esac
    wave 0.25 "$run/orbit" $B "$near" 15
    awk 'FNR == 1 { for (k = 1; k <= NF; k++) column[$k] = k; row = 0 }
        $1 + 0 == $1 && ++row == 257 { print $column["v_x"], $column["v_z"] }' "$run"/orbit/particles_*.dat > "$folder/orbit_$B.dat"
done
mv "$table.partial" "$table"
