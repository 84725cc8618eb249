#!/bin/sh
# thin_sheets.sh PROGRAM FOLDER [END [NAME=VALUE ...]]: the thin current sheets of figures 11 and 13 to 15, each in FOLDER/ratio_..._seed_...: kink.toml with
# T_i/T_e = 4, 2 and 1, three seeds each, and with 10 to t Omega_ci = 12. They run side by side, one thread each, JOBS at a time (default: as
# many as there are processors). What is complete stays, and what was stopped goes on. ONLY=K: the Kth of the ten (thin_sheets.slurm).
set -eu
export LC_ALL=C.UTF-8 program="$1" folder="$2"
end=${3:-$(awk '$1 == "end" { print $3 }' implicit_moment/cases/kink.toml)}
[ $# -lt 3 ] || shift
shift 2
export settings="$*"
runs() {
    echo "2 1 $end"
    for seed in 1 2 3; do
        for ratio in 4 1 2; do [ "$ratio $seed" = '2 1' ] || echo "$ratio $seed $end"; done
    done
    echo '10 1 480'
}
one='exec "$program" implicit_moment/cases/kink.toml time.end="$3" current_sheet.temperature_ratio="$1" plasma.seed="$2" $settings \
    --out "$folder/ratio_$1_seed_$2" --threads 1 --resume --quiet'
# shellcheck disable=SC2046
[ -z "${ONLY:-}" ] || exec sh -c "$one" thin_sheet $(runs | sed -n "${ONLY}p")
runs | xargs -P "${JOBS:-$(getconf _NPROCESSORS_ONLN)}" -L 1 sh -c "$one" thin_sheet
