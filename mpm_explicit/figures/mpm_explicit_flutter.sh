#!/bin/sh
# mpm_explicit_flutter.sh PROGRAM FOLDER: a block on an incline of 30 degrees with several coefficients of friction, without and with viscosity, by both programs (the other one lies beside PROGRAM).
# Accelerations as tables; and for two of them the kinetic energy less that of the block as a whole, 1/2 m v^2, the largest in every 0.015, half a period of the first mode that flutters.
set -eu
export LC_ALL=C.UTF-8
folder=$2
mkdir -p "$folder"
for scheme in explicit implicit; do
    program=${1%explicit}$scheme
    method=; [ $scheme = explicit ] || method='time.alpha=0.5 method.theta=0.5'
    for viscosity in 0 3e-3; do
        table=$folder/${scheme}_$viscosity.dat
        echo 'friction acceleration theory' > "$table.partial"
        for friction in 0.1 0.2 0.3 0.4 0.5 0.55; do
            run=$folder/${scheme}_${viscosity}_$friction
            "$program" mpm_$scheme/cases/sliding_block.toml contact.friction=$friction material.default.viscosity=$viscosity theory.tolerance=10 $method --threads 1 --resume --quiet --out "$run"
            number() { awk -v key=results.$1 -f common/json_lines.awk "$run/summary.json"; }
            echo "$friction $(number acceleration.value) $(number acceleration.expected)" >> "$table.partial"
            awk -v speed="$(number speed_at_end.value)" '
                NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
                $1 + 0 == $1 { t[++n] = $1; kinetic[n] = $column["kinetic"]; x[n] = $column["momentum_x_block"]; y[n] = $column["momentum_y_block"] }
                END {
                    mass = x[n] / speed
                    for (k = 1; k <= n; ++k) {
                        window = int(t[k] / 0.015); energy = kinetic[k] - (x[k]^2 + y[k]^2) / (2 * mass)
                        if (energy > most[window]) most[window] = energy
                    }
                    for (k = 0; k < window; ++k) print (k + 0.5) * 0.015, most[k]
                }' "$run/history.dat" > "$run.dat"
        done
        mv "$table.partial" "$table"
    done
done
