#!/bin/sh
# implicit_moment_mass_ratio.sh PROGRAM FOLDER: the GEM challenge with m_i/m_e = 25, 180 and 1836, the lighter ones with three seeds, until the rate is known; in rates.dat
# mass ratio, seed, time of unit flux and peak rate of each run.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
cases=implicit_moment/cases

# one_run RATIO SEED CASE [OVERRIDE...]
one_run() {
    run=$folder/$1_$2
    ratio=$1
    seed=$2
    shift 2
    "$program" "$@" plasma.seed="$seed" output.fields_interval=0 --out "$run" --resume --quiet
    of() { awk -v key="results.$1.value" -f common/json_lines.awk "$run/summary.json"; }
    echo "$ratio $seed $(of time_at_unit_flux) $(of peak_reconnection_rate)" >> "$folder/rates.new"
}

echo 'mass_ratio seed time_at_unit_flux peak_rate' > "$folder/rates.new"
# To t Omega_ci = 22, and 18 where reconnection starts earlier. With 180 and c/v_A = 20 as with 25, a step has omega_pe dt = 4 and Omega_ce dt = 2.7.
for seed in 1 2 3; do one_run 25 $seed $cases/gem.toml time.end=440; done
for seed in 1 2 3; do one_run 180 $seed $cases/gem.toml harris.mass_ratio=180 harris.light_over_alfven=20 time.dt=0.3 time.end=440; done
for seed in 1; do one_run 1836 $seed $cases/gem_1836.toml time.end=900 output.checkpoint_steps=0; done
mv "$folder/rates.new" "$folder/rates.dat"
