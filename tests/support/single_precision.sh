#!/bin/sh
# single_precision.sh: the programs of `make REAL=float all` beside those of `make all`. Their results are those of
# double precision, as near as the rounding of single precision allows; threads and a restart change no byte.
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/../.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM

fail() { echo "single_precision.sh: $*" >&2; exit 1; }
value() { awk -v key="$2" -f common/json_lines.awk "$scratch/$1/summary.json"; }
near() {  # RUN RUN KEY TOLERANCE: two values of a summary, the tolerance relative
    awk -v a="$(value "$1" "$3")" -v b="$(value "$2" "$3")" -v t="$4" 'BEGIN { d = a - b; if (d < 0) d = -d; s = b < 0 ? -b : b
        if (a == "" || b == "" || !(d <= t * s)) { print "a is " a ", b " b; exit 1 } }' || fail "$3 of $1 and $2 is not near"
}
run() {  # NAME PROGRAM [ARGUMENT ...]
    name=$1
    shift
    "$@" --quiet --out "$scratch/$name" 2> "$scratch/said" || { cat "$scratch/said" >&2; fail "$* ended with status $?"; }
    ! value "$name" 'results.*.verdict' | grep -q FAIL || fail "$* has a FAIL"
}

for precision in double float; do
    build=build
    [ $precision = double ] || build=build/float
    run stream_$precision $build/explicit_em implicit_moment/cases/explicit_two_stream.toml
    run weibel_$precision $build/explicit_em implicit_moment/cases/explicit_weibel.toml
    set -- $build/explicit_em implicit_moment/cases/gem_explicit.toml grid.cells_x=128 grid.cells_z=64 harris.particles=400000 \
        time.end=10 output.checkpoint_steps=300
    run gem_$precision "$@" --threads 1
    run cic_$precision $build/cic cic/cases/landau.toml
done
near stream_float stream_double results.growth_over_theory.value 2e-3
near weibel_float weibel_double results.growth_over_theory.value 2e-3
near cic_float cic_double results.omega_over_theory.value 2e-3
near gem_float gem_double results.flux_initial.value 1e-6
# Charge: as particles are where J has brought them, Gauss's law is kept but for the rounding of weights.
awk -v r="$(value gem_float conservation.largest_gauss_residual.value)" 'BEGIN { exit !(r != "" && r < 1e-5) }' ||
    fail "Gauss's law of gem_float"
# The energies of the last row to 1e-5 of the whole.
paste "$scratch/gem_float/history.dat" "$scratch/gem_double/history.dat" | awk 'NR == 1 { n = NF / 2; for (i = 1; i <= n; i++) name[i] = $i; next }
    { for (i = 1; i <= n; i++) a[i] = $i - $(i + n); whole = 0; for (i = 1; i <= n; i++) if (name[i] == "energy") whole = $i }
    END { for (i = 1; i <= n; i++) if (name[i] ~ /^(energy|electric|magnetic|kinetic_.*)$/) { if (a[i] < 0) a[i] = -a[i]
        if (!(a[i] <= 1e-5 * whole)) { print name[i] " differs by " a[i] " of " whole; bad = 1 } } exit bad }' || fail "energies"

run threads "$@" --threads 2
cmp "$scratch/gem_float/history.dat" "$scratch/threads/history.dat" || fail "two threads change the history"
# Cells of no round number, either order: those that have just crossed are sorted as the push has them.
for order in 1 2; do
    run crossed build/float/explicit_em implicit_moment/cases/gem_explicit.toml grid.cells_x=100 grid.cells_z=52 harris.particles=300000 \
        particles.order=$order time.end=2 output.checkpoint_steps=10 --force
    for checkpoint in "$scratch"/crossed/checkpoint_*.bin; do
        ! build/float/explicit_em --restart "$checkpoint" --quiet --dry-run 2>&1 | grep -q "not sorted" || fail "$checkpoint is not sorted"
    done
done
checkpoint=$(ls "$scratch"/gem_float/checkpoint_*300.bin)
run restarted build/float/explicit_em --restart "$checkpoint" --threads 2
last=$(cd "$scratch/gem_float" && ls fields_*.dat | tail -n 1)
cmp "$scratch/gem_float/$last" "$scratch/restarted/$last" || fail "a restart changes the fields"
! build/explicit_em --restart "$checkpoint" --quiet --out "$scratch/other" 2> "$scratch/said" ||
    fail "a checkpoint in single precision is taken for one in double"
echo "single precision: as double, to its rounding"
