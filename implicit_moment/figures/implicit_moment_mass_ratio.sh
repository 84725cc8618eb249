#!/bin/sh
# implicit_moment_mass_ratio.sh PROGRAM FOLDER: the GEM challenge with m_i/m_e = 25, 180 and 1836, the lighter ones with three seeds, until the rate is known; in rates.dat
# mass ratio, seed, time of unit flux and peak rate of each run.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
cases=implicit_moment/cases

# runs RATIO SEEDS CASE [OVERRIDE...]
runs() {
    ratio=$1
    seeds=$2
    case=$3
    shift 3
    PROGRAM=$program SWEEP=$folder SWEEP_NAME="${ratio}_{1}" sh common/sweep.sh "$case" plasma.seed="$seeds" -- output.fields_interval=0 "$@"
    for seed in $(echo "$seeds" | tr , ' '); do
        of() { awk -v key="results.$1.value" -f common/json_lines.awk "$folder/${ratio}_$seed/summary.json"; }
        echo "$ratio $seed $(of time_at_unit_flux) $(of peak_reconnection_rate)" >> "$folder/rates.new"
    done
}

echo 'mass_ratio seed time_at_unit_flux peak_rate' > "$folder/rates.new"
# To t Omega_ci = 22, and 18 where reconnection starts earlier. With 180 and c/v_A = 20 as with 25, a step has omega_pe dt = 4 and Omega_ce dt = 2.7.
runs 25 1,2,3 $cases/gem.toml time.end=440
runs 180 1,2,3 $cases/gem.toml harris.mass_ratio=180 harris.light_over_alfven=20 time.dt=0.3 time.end=440
runs 1836 1 $cases/gem_1836.toml time.end=900 output.checkpoint_steps=0
mv "$folder/rates.new" "$folder/rates.dat"
