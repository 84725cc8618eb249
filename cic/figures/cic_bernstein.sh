#!/bin/sh
# cic_bernstein.sh PROGRAM FOLDER: the wave of bernstein.toml, the field that theory gives to each of its modes; the noise of the same plasma in a longer box as a spectrum,
# and the modes of its wave numbers.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
case=cic/cases/bernstein.toml
plan() { "$program" "$@" --dry-run 2> "$folder/warnings"; }
# The followed mode and all others, in order.
modes() { sed -n 's/.* theory .*omega = \([^,]*\),.*/\1/p; s/.*other Bernstein modes *omega = //p' | tr ', ' '\n\n' | grep . | sort -n; }

"$program" $case --threads 1 --resume --quiet --out "$folder/seeded"
echo 'omega E_k' > "$folder/seeds.partial"
for omega in $(plan $case | modes); do
    echo "$omega $(plan $case theory.near="$omega" | sed -n 's/.*seeded field *E_k = //p')" >> "$folder/seeds.partial"
done
mv "$folder/seeds.partial" "$folder/seeds.dat"

# 40 wave numbers, k v_th / Omega_c = 0.1 ... 4, and no wave but those of the noise.
noise="$case grid.cells_x=256 grid.length_x=62.83185307179586 species.electrons.loading=random species.electrons.particles_per_cell=400"
"$program" $noise species.electrons.amplitude=0 time.end=400 theory.compare=none output.modes=40 output.spectrum=true --out "$folder/noise" --threads 1 --resume --quiet
echo 'k omega_1 omega_2 omega_3 omega_4 omega_5' > "$folder/modes.partial"
for mode in 1 2 3 4 5 6 7 8 9 10 12 14 16 18 20 22 24 26 28 30 32 34 36 38 40; do
    plan $noise theory.mode_x=$mode species.electrons.mode_x=$mode | modes |
        awk -v k=$mode '{ n = int($1 / 0.5 + 1e-9); omega[n < 1 ? 1 : n] = $1 } END { printf "%g", 0.1 * k; for (n = 1; n <= 5; n++) printf " %s", n in omega ? omega[n] : "NaN"; print "" }' >> "$folder/modes.partial"
done
[ "$(wc -l < "$folder/modes.partial")" -eq 26 ]
mv "$folder/modes.partial" "$folder/modes.dat"
