#!/bin/sh
# implicit_moment_dispersion.sh PROGRAM FOLDER: light and cold Langmuir waves with theta = 1/2 and 1 at
# several time steps; one table per wave and theta in FOLDER. The angle is c dt K for light and omega_p dt for the plasma; damping is over the exact
# one where there is one, and the measured rate where there is none (theta = 1/2).
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
cases=implicit_moment/cases

# entry NAME RUN: a result of a run
entry() { awk -v key="results.$1.value" -f common/json_lines.awk "$2/summary.json" || true; }

for wave in light langmuir; do
    file=$cases/$wave.toml
    [ $wave = light ] && file=$cases/light_wave.toml
    for theta in 0.5 1; do
        table=$folder/${wave}_$theta.dat
        echo 'angle frequency_over_exact damping theory_omega theory_growth dt' > "$table.partial"
        for angle in 0.1 0.3 0.6 1 1.5 2 3 5; do
            run=$folder/runs/${wave}_${theta}_$angle
            # For light the angle is c dt K with K = 0.98135 of the mesh; for the plasma it is omega_p dt = dt.
            dt=$angle
            [ $wave = light ] && dt=$(awk -v a="$angle" 'BEGIN { print a / 0.981354 }')
            "$program" "$file" time.dt="$dt" time.end="$(awk -v dt="$dt" 'BEGIN { print 100 * dt }')" field.theta=$theta \
                --out "$run" --resume --quiet
            damping=$(entry damping_over_theory "$run")
            [ -n "$damping" ] || damping=$(entry damping "$run")
            echo "$angle $(entry omega_over_theory "$run") $damping $(entry theory_omega "$run") $(entry theory_growth "$run") $dt" >> "$table.partial"
        done
        mv "$table.partial" "$table"
    done
done
