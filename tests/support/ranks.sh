#!/bin/sh
# ranks.sh BUILD FACT: facts about the programs of `make MPI=1 all`, beside those of `make all`. Status 77, for "not tested", where there are
# none. Ranks share the cores of this machine.
set -u
export LC_ALL=C.UTF-8
one=$1 many=$1/mpi
command -v mpirun > /dev/null || { echo "there is no mpirun (make deps-mpi): not tested"; exit 77; }
[ -x "$many/explicit_em" ] || { echo "build/mpi is empty (make MPI=1 all): not tested"; exit 77; }
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
status=0
complain() { echo "$*" >&2; status=1; }

# A sheet that reconnects; a beam through the periodic ends of a mesh of four strips, of which the last has one row, .93 cells per step; a plasma
# thrown at a wall, which leaves rows empty behind it.
records='output.history_steps=2 output.checkpoint_steps=30'
sheet="explicit_em implicit_moment/cases/gem_explicit.toml grid.cells_x=32 grid.cells_z=32 time.dt=0.2 harris.particles=1e4 $records
    time.end=12 output.fields_interval=3 output.particles_interval=3"
neutral='[plasma]\nsetup = "uniform"\nloading = "random"\n[uniform]\nparticles_per_cell = %s\n[species.ions]\ncharge = 1\nmass = 1\ndrift_z = %s\ntemperature_x = 1e-3
    \ntemperature_z = 1e-3\n[species.electrons]\ncharge = -1\nmass = 0.5\ndrift_z = %s\n[grid]\ncells_x = 8\ncells_z = %s\nlength_x = 8\nlength_z = %s\nboundary_z = "%s"
    \n[time]\ndt = %s\nend = %s\n[particles]\norder = %s\n[theory]\nwave = "none"\n'
# shellcheck disable=SC2059
{
    printf "$neutral" 20 5 5 12 1.2 periodic 0.095 5.7 2 > "$scratch/beam.toml"
    printf "$neutral" 40 0.6 0.6 32 3.2 wall 0.08 4.8 1 > "$scratch/crowd.toml"
}
beam="explicit_em $scratch/beam.toml field.smoothing_passes=2 $records"
crowd="explicit_em $scratch/crowd.toml $records"

# same A B: the files of two runs, and their results; what a summary says of ranks and times is theirs.
same() {
    for file in "$1"/*; do
        file=${file##*/}
        [ "$file" = summary.json ] || cmp -s "$1/$file" "$2/$file" || complain "$2: another $file"
    done
    for run in "$1" "$2"; do sed -n '/"results"/,/"performance"/p' "$run/summary.json" > "$run.results"; done
    cmp -s "$1.results" "$2.results" || complain "$2: other results"
}
performance() { sed -n "s/.*\"$2\": *\([0-9.]*\).*/\1/p" "$1/summary.json"; }
# start N OUT ...: N ranks, 0: the program without ranks
start() {
    n=$1 out=$2 said=$2.said; shift 2
    if [ "$n" = 0 ]; then set -- "$one/$program" "$@"; else set -- timeout 120 mpirun -n "$n" "$many/$program" "$@"; fi
    "$@" --quiet --out "$out" 2> "$said"
}

case $2 in
bytes)
    for name in sheet beam crowd; do
        eval "set -- \$$name"
        program=$1; shift
        start 0 "$scratch/$name" "$@" --threads 1 || complain "$name: $(cat "$said")"
        for n in 1 2 3 4; do
            for threads in 1 2; do
                start $n "$scratch/$name.$n.$threads" "$@" --threads $threads || complain "$out: $(cat "$said")"
                same "$scratch/$name" "$out"
                [ "$(performance "$out" ranks)" = $n.0 ] || complain "$out: it had '$(performance "$out" ranks)' ranks"
            done
        done
    done
    # Borders have moved: with those of the start one of two ranks would have three quarters of the crowd.
    awk "BEGIN { exit !($(performance "$scratch/crowd.2.1" imbalance) <= 1.2) }" || complain "most of the crowd is with one rank"
    ;;
restart)
    for name in sheet beam; do
        eval "set -- \$$name"
        program=$1; shift
        start 0 "$scratch/$name" "$@" --threads 1
        for pair in '4 0' '4 1' '0 3' '2 4' '3 2'; do
            start "${pair% *}" "$scratch/$name.${pair% *}${pair#* }" "$@" --threads 1
            rm "$out/checkpoint_0000000060.bin" "$out/summary.json"
            start "${pair#* }" "$out" --restart "$out/checkpoint_0000000030.bin" --threads 1 || complain "$pair: $(cat "$said")"
            same "$scratch/$name" "$out"
        done
    done
    ;;
*) complain "no such fact: $2" ;;
esac
exit $status
