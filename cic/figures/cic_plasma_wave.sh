#!/bin/sh
# cic_plasma_wave.sh PROGRAM FOLDER: frequencies of cold plasma waves, one table per scheme in FOLDER; the noise of a warm plasma as a spectrum, and the roots of its
# dispersion relation.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
cases=cic/cases

entry() { awk -v key="results.$1.value" -f common/json_lines.awk "$2/summary.json"; }

for scheme in momentum energy; do
    for weighting in cic tsc; do
        table=$folder/${weighting}_$scheme.dat
        echo 'mode frequency theory' > "$table.partial"
        for mode in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
            run=$folder/runs/${weighting}_${scheme}_$mode
            "$program" $cases/plasma_wave.toml method.weighting=$weighting method.scheme=$scheme \
                species.electrons.mode_x=$mode theory.mode_x=$mode output.modes=0 --out "$run" --threads 1 --resume --quiet
            echo "$mode $(entry omega "$run") $(entry theory_omega "$run")" >> "$table.partial"
        done
        mv "$table.partial" "$table"
    done
done

# 80 wave numbers, k lambda_D = 0.0125 ... 1, and no wave but those of the noise.
warm="$cases/landau.toml grid.cells_x=2048 grid.length_x=502.6548245743669 species.electrons.loading=random \
    species.electrons.particles_per_cell=50 output.phase_interval=0"
"$program" $warm species.electrons.amplitude=0 time.dt=0.2 time.end=400 theory.compare=none output.modes=80 output.spectrum=true --out "$folder/warm" --threads 1 --resume --quiet
printf '%s\n' 'mode frequency growth' '0 1 0' > "$folder/roots.partial"
for mode in 8 12 16 20 24 28 32 36 40 44 48 52 56 60 64 68 72 76 80; do
    "$program" $warm theory.mode_x=$mode species.electrons.mode_x=$mode --dry-run |
        sed -n "s|.* omega = \([^,]*\), growth = \([^ ]*\) .*|$mode \1 \2|p" >> "$folder/roots.partial"
done
[ "$(wc -l < "$folder/roots.partial")" -eq 21 ]
mv "$folder/roots.partial" "$folder/roots.dat"
