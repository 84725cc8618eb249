#!/bin/sh
# keep_thin_sheets.sh RUNS FOLDER: keeps what figures 11 and 13 to 15 need of the runs of thin_sheets.sh, so that they are drawn in a second. Letters are the
# talk's: y along the current, z across the sheet, B_x = -B_y of the files.
set -eu
export LC_ALL=C.UTF-8
runs=$1
folder=$2
# What FOLDER has stays until all is there.
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT
trap 'exit 1' HUP INT TERM
entry() { awk -v key="$2" -f common/json_lines.awk "$1/summary.json" || echo nan; }
given() { awk -v path="$2" '/^\[/ { section = $1; gsub(/[][]/, "", section) } $2 == "=" && section "." $1 == path { print $3; exit }' "$1/case.toml"; }
first=$runs/ratio_2_seed_1
where="# implicit_moment $(entry "$first" version), implicit_moment/cases/kink.toml: $(given "$first" grid.cells_x) x $(given "$first" grid.cells_z) cells, $(given "$first" current_sheet.particles) particles"

# Growth of the kink and level of m_y = 4, run by run, and how the runs were.
{
    echo "$where"
    echo '# rates in Omega_ci, times in 1/Omega_ci, levels in B0; nan where no e-folding stands out'
    echo '# T_i/T_e,seed,t_end,growth,error,begin,end,growth_of_displacement,error,level,error,energy_drift'
    for ratio in 4 2 1; do
        for run in "$runs/ratio_$ratio"_seed_*/; do
            of() { entry "$run" "results.$1"; }
            t_end=$(awk '$1 + 0 == $1 { t = $2 } END { print t }' "$run/history.dat")
            echo "$ratio,$(given "$run" plasma.seed),$t_end,$(of kink_growth.value),$(of kink_growth.error),$(of kink_growth_begin.value),$(of kink_growth_end.value),$(of kink_growth_of_displacement.value),$(of kink_growth_of_displacement.error),$(of lhdi_level.value),$(of lhdi_level.error),$(of energy_drift_at_end.value)"
        done
    done
} > "$new/all"
awk -F, -v OFS=, '/^#/ { print; next } { for (k = 3; k <= NF; ++k) $k = $k + 0 == $k ? sprintf("%.4g", $k) : "nan"; print }' "$new/all" > "$new/thin_sheet_runs.csv"

# The modes against time.
{
    echo "$where"
    echo '# rms over z of modes 1 and 4 of B_x along the current, in B0'
    echo '# T_i/T_e,seed,t_Omega_ci,B_1,B_4'
    for ratio in 4 2 1; do
        for run in "$runs/ratio_$ratio"_seed_*/; do
            awk -v ratio="$ratio" -v seed="$(given "$run" plasma.seed)" '
                NR == 1 { for (k = 1; k <= NF; ++k) { if ($k ~ /^B_1$/) one = k; if ($k ~ /^B_4$/) four = k; if ($k ~ /^time_Omega_ci/) t = k } next }
                $1 + 0 == $1 && $t >= next_one - 1e-6 { printf "%s,%s,%.1f,%.5f,%.6f\n", ratio, seed, $t, $one, $four; next_one += 0.5 }' "$run/history.dat"
        done
    done
} > "$new/thin_sheet_modes.csv"

# J_y(z, t), T_i/T_e = 1; and the mean velocities at t Omega_ci = 12.
profiles() { cat "$runs/ratio_$1_seed_"$2/profile_*.dat > "$new/all"; }
{
    echo "$where"
    echo '# T_i/T_e = 1: mean of J_y along the current, in its first value in the middle; times in 1/Omega_ci'
    echo '# t_Omega_ci,z_over_L,J_y'
    profiles 1 1
    awk '$1 + 0 == $1 && $2 >= -3.05 && $2 <= 3.05 && ($1 < 12.01 ? $1 * 2 - int($1 * 2 + 0.01) < 0.05 : $1 / 2 - int($1 / 2 + 0.01) < 0.02) { printf "%.1f,%.4f,%.4f\n", $1, $2, $4 }' "$new/all"
} > "$new/thin_sheet_current.csv"
{
    echo "$where"
    echo '# means along the current, over t Omega_ci = 11 to 13 and over all seeds, over v_i = (2 T_i/m_i)^(1/2)'
    echo '# T_i/T_e,z_over_L,v_ions,v_electrons'
    for ratio in 10 4 2 1; do
        profiles "$ratio" "*"
        awk -v ratio="$ratio" '$1 + 0 == $1 && $1 > 10.99 && $1 < 13.01 && $2 >= -3.05 && $2 <= 3.05 { ions[$2] += $7; electrons[$2] += $8; ++count[$2] }
            END { for (z in count) printf "%s,%.4f,%.4f,%.4f\n", ratio, z, ions[z] / count[z], electrons[z] / count[z] }' "$new/all" | sort -t, -k2g
    done
} > "$new/thin_sheet_velocity.csv"

# B_x(y, z) at the end, T_i/T_e = 2.
{
    last=$(ls "$first"/fields_*.dat | tail -n 1)
    echo "$where"
    awk -v b="$(given "$first" current_sheet.light_over_alfven)" -v ratio="$(given "$first" current_sheet.temperature_ratio)" '
        BEGIN { L = sqrt(ratio / (1 + ratio)); print "# T_i/T_e = " ratio ": lengths in L, field in B0" }
        /^# time/ { printf "# t Omega_ci = %.0f\n", $3 / b; print "# y_over_L z_over_L B_x" }
        /^x / || $1 == "x" { for (k = 1; k <= NF; ++k) if ($k == "B_y") c = k }
        $1 + 0 == $1 && $2 / L >= -2.1 && $2 / L <= 2.1 { if ($2 != z && z != "") print ""; z = $2; printf "%.4f %.4f %.4f\n", $1 / L, $2 / L, -$c * b }' "$last"
} > "$new/thin_sheet_field.dat"
mv "$new"/thin_sheet_* "$folder/"
