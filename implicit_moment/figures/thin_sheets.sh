#!/bin/sh
# thin_sheets.sh PROGRAM FOLDER [CASE]: the thin current sheet with T_i/T_e = 10, 4, 2 and 1 to t Omega_ci = 12, each in FOLDER/ratio_...
# Electrons are the faster against L the warmer they are, v_the/L ~ (T_e/T_i)^(1/2), and the warmest take shorter steps: v_the dt/dx < 1.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
case=implicit_moment/cases/${3:-lhdi}.toml

dt=$(awk '$1 == "dt" { print $3 }' "$case")
for ratio_and_part in '10 1' '4 1' '2 0.85' '1 0.6'; do
    set -- $ratio_and_part
    "$program" "$case" current_sheet.temperature_ratio="$1" time.dt="$(awk "BEGIN { print $dt * $2 }")" \
        output.fields_interval=0 --out "$folder/ratio_$1" --resume --quiet
done
