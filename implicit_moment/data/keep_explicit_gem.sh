#!/bin/sh
# keep_explicit_gem.sh RUN FOLDER: keeps what figures need of a full explicit GEM run: the flux every half of 1/Omega_ci, the profiles at unit flux (9 and 10), and
# where its particles are (implicit_moment_ranks).
# What FOLDER has already stays as long as the run is shorter.
set -eu
export LC_ALL=C.UTF-8
run=$1
folder=$2
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT
trap 'exit 1' HUP INT TERM
entry() { awk -v key="$1" -f common/json_lines.awk "$run/summary.json"; }
where="explicit_em $(entry version), implicit_moment/cases/gem_explicit.toml: 512 x 256 cells, 9.12e6 particles, omega_pe dt = 0.15"
ends() { awk -F, '!/^#/ { t = $1 } END { print t + 0 }' "$1"; }
column() { awk -v name="$1" '{ for (k = 1; k <= NF; k++) if ($k == name) print k; exit }' "$run/history.dat"; }
{
    echo "# $where"
    echo '# reconnected flux in B0 d_i against t Omega_ci'
    echo '# time_Omega_ci,flux'
    awk -v t="$(column time_Omega_ci)" -v f="$(column flux)" '$1 + 0 == $1 && $t >= next_one - 1e-6 { printf "%.3f,%.5f\n", $t, $f; next_one += 0.5 }
        $1 + 0 == $1 { last = sprintf("%.3f,%.5f", $t, $f) } END { print last }' "$run/history.dat" | uniq
} > "$new/flux.csv"
if [ -f "$folder/explicit_gem_flux.csv" ] && awk -v a="$(ends "$new/flux.csv")" -v b="$(ends "$folder/explicit_gem_flux.csv")" 'BEGIN { exit !(a < b) }'; then
    echo "keep_explicit_gem.sh: $run is shorter than what $folder has, which stays" >&2
    exit 0
fi
mv "$new/flux.csv" "$folder/explicit_gem_flux.csv"
[ -f "$run/profile.dat" ] || exit 0
{
    echo "# $where"
    printf '# along z = 0: averages from t Omega_ci = %.2f to %.2f, the first steps of unit flux, and B_z at the first; v_A, n0, B0\n' \
        "$(entry results.profile_begin.value)" "$(entry results.profile_end.value)"
    echo '# x,v_x_electrons,rho_ions,v_x_ions,B_z'
    awk '$1 + 0 == $1 { printf "%.3f,%.4f,%.4f,%.4f,%.5f\n", $1, $2, $3, $4, $5 }' "$run/profile.dat"
} > "$new/profile.csv"
mv "$new/profile.csv" "$folder/explicit_gem_profile.csv"
# Strips of four rows of cells are what ranks divide. in: the field files of t Omega_ci = 0, 15, 30
[ -f "$run/fields_020000.dat" ] || exit 0
for step in 0 10000 20000; do
    file=$(printf '%s/fields_%06d.dat' "$run" "$step")
    awk -v cells="$(sed -n 's/^cells_z *= *//p' "$run/case.toml")" '
        NR == 1 { for (k = 1; k <= NF; k++) { if ($k == "z") z = k; if ($k == "rho_ions") i = k; if ($k == "rho_electrons") e = k } }
        $1 + 0 == $1 { if (!($z in row)) { row[$z] = rows++ } of_row[row[$z]] += $i - $e }
        # A row of cells has half of what is on the rows of nodes on both sides.
        END {
            for (j = 0; j < cells; j++) { strip[int(j / 4)] += of_row[j] + of_row[j + 1]; all += of_row[j] + of_row[j + 1] }
            for (k = 0; k < cells / 4; k++) printf "%.6f\n", strip[k] / all
        }' "$file" > "$new/strips_$step"
done
{
    echo "# $where"
    echo '# share of all particles in each strip of four rows of cells, at t Omega_ci = 0, 15, 30'
    echo '# t0,t15,t30'
    paste -d , "$new/strips_0" "$new/strips_10000" "$new/strips_20000"
} > "$new/strips.csv"
mv "$new/strips.csv" "$folder/explicit_gem_strips.csv"
