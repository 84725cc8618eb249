#!/bin/sh
# mpm_implicit_billet.sh IMPLICIT EXPLICIT FOLDER: the block of the case, pressed by one per cent, with CFL numbers from 1 to 1000, those below 64 over a shorter time; and by leapfrog with 0.25, damped, as it would else drown in noise. In costs.dat the seconds that the whole of it takes.
set -eu
export LC_ALL=C.UTF-8
implicit=$1
explicit=$2
folder=$3
end=80
seconds() { awk -v key=performance.wall_s -f common/json_lines.awk "$1/summary.json"; }
{
    echo 'alpha steps wall'
    for alpha in 1 4 16 64 250 1000; do
        share=$(awk "BEGIN { a = $alpha / 64; print a < 1 ? a : 1 }")
        run=$folder/alpha_$alpha
        "$implicit" mpm_implicit/cases/billet.toml time.alpha=$alpha time.end=$(awk "BEGIN { print $share * $end }") theory.compare=none --threads 1 --resume --quiet --out "$run" >&2
        awk "BEGIN { s = $(awk -v key=performance.steps -f common/json_lines.awk "$run/summary.json"); print $alpha, s / $share, $(seconds "$run") / $share }"
    done
} > "$folder/costs.new"
# What the explicit program has no word for is left out.
sed '/^\[method\]/,/^$/d; /^\[theory\]/,/^$/d; s/^alpha = .*/alpha = 0.25/' mpm_implicit/cases/billet.toml > "$folder/explicit.toml"
"$explicit" "$folder/explicit.toml" time.end=$end load.damping=20 output.history_steps=200 --threads 1 --resume --quiet --out "$folder/explicit"
echo "0.25 $(awk -v key=performance.steps -f common/json_lines.awk "$folder/explicit/summary.json") $(seconds "$folder/explicit")" > "$folder/costs_explicit.dat"
mv "$folder/costs.new" "$folder/costs.dat"
