#!/bin/sh
# kinks.sh PROGRAM FOLDER [CASE]: the thin current sheet with T_i/T_e = 4, 2 and 1 to t Omega_ci = 110, each in FOLDER/ratio_...; in
# FOLDER/kinks.dat growth rate of the kink and level of the lower-hybrid drift instability beside figure 14 of the talk, and whether they have its order.
# Electrons are the faster against L the warmer they are, v_the/L ~ (T_e/T_i)^(1/2), and the warmest take shorter steps: v_the dt/dx < 0.9.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
case=implicit_moment/cases/${3:-kink}.toml
dt=$(awk '$1 == "dt" { print $3 }' "$case")

echo 'T_i/T_e kink_growth talk_growth lhdi_level talk_level energy_drift' > "$folder/kinks.new"
while read -r ratio part growth level; do
    run=$folder/ratio_$ratio
    "$program" "$case" current_sheet.temperature_ratio="$ratio" time.dt="$(awk "BEGIN { print $dt * $part }")" --out "$run" --resume --quiet
    of() { awk -v key="results.$1.value" -f common/json_lines.awk "$run/summary.json" || echo nan; }
    echo "$ratio $(of kink_growth) $growth $(of lhdi_level) $level $(of energy_drift_at_end)" >> "$folder/kinks.new"
done <<END
4 1 0.1 6.5e-3
2 1 0.07 3.5e-3
1 0.75 0.04 1.5e-3
END
awk '{ print } $1 + 0 == $1 { growth[++n] = $2; level[n] = $4 }
    function order(a) { return a[1] > a[2] && a[2] > a[3] ? "holds" : "does not hold" }
    END { print "# order 4 > 2 > 1 of the growth rates " order(growth) ", of the levels " order(level) }' \
    "$folder/kinks.new" > "$folder/kinks.dat"
rm "$folder/kinks.new"
