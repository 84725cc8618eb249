#!/bin/sh
# ranks_bench.sh BUILD: particle-steps per second of one rank and of two, one thread each, by the clock, and what messages cost; `make MPI=1 bench` calls it.
# On a machine with other work, or with fewer than two free cores, it says little.
set -eu
export LC_ALL=C.UTF-8 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM
performance() { sed -n "s/.*\"$1\": *\([-+.0-9e]*\).*/\1/p" "$scratch/run/summary.json"; }
# Of three runs of each number of ranks, in turn, the fastest.
measure() {
    title=$1 program=$2
    shift 2
    [ -x "$build/$program" ] || return 0
    : > "$scratch/all"
    for _ in 1 2 3; do
        for ranks in 1 2; do
            mpirun -n $ranks "$build/$program" "$@" --threads 1 --quiet --force --out "$scratch/run" > "$scratch/words" 2>&1 || { cat "$scratch/words"; exit 1; }
            echo "$ranks $(performance particle_steps_per_s) $(performance communication_s) $(performance wall_s)" >> "$scratch/all"
        done
    done
    awk -v title="$title" '$2 > best[$1] { best[$1] = $2; share[$1] = $4 > 0 ? $3 / $4 : 0 }
        END { printf "%-52s %12.3e %12.3e %9.2f %13.1f%%\n", title, best[1], best[2], best[2] / best[1], 100 * share[2] }' "$scratch/all"
}
build=$1
mpirun -n 2 "$build/benches/message_times"
printf '\n%-52s %12s %12s %9s %14s\n' 'particle-steps/s' 'one rank' 'two ranks' 'speed-up' 'communication'
measure 'explicit_em, the slide: 512 x 256, 9.12e6 particles' explicit_em implicit_moment/cases/gem_explicit.toml time.end=1.8 output.fields_interval=0
measure 'cic, 128 x 64 cells, 1e6 particles' cic cic/cases/two_stream_2d.toml species.right.particles_per_cell=64 \
    species.left.particles_per_cell=64 time.end=20 output.fields_interval=0 output.particles_interval=0
measure 'implicit_moment, GEM, 64 x 64 cells, 2e5 particles' implicit_moment implicit_moment/cases/gem.toml time.end=60 output.fields_interval=0
measure 'the same, with the mass matrix' implicit_moment implicit_moment/cases/gem.toml field.response=mass_matrix time.end=30 output.fields_interval=0
