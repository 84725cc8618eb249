#!/bin/sh
# snapshots.sh RUN KIND [FILE ...]: the gnuplot commands of fields.gp and particles.gp, for these files or for four of those that there are. In the environment,
# of movie.sh: FRAME_FOLDER, where each file gets a picture of its own, and QUANTITIES.
set -eu
export LC_ALL=C.UTF-8
run=$1 kind=$2
shift 2
if [ $# = 0 ]; then
    for time in $(sh common/snapshots.sh some "$run" "$kind" 4); do
        set -- "$@" "$(sh common/snapshots.sh file "$run" "$kind" "$time")"
    done
fi
script=common/figures/fields.awk
[ "$kind" != particles ] || script=common/figures/particles.awk
names=$(sed -nE 's/^\[(species|material|grain)[.](.*)\]$/\1 \2/p' "$run/case.toml" 2> /dev/null | tr '\n' ' ')
# A current sheet has species without sections.
[ -n "$names" ] || names=$(sed -n '1s/ /\n/gp' "$run/history.dat" 2> /dev/null | sed -n 's/^kinetic_/species /p' | tr '\n' ' ')
# A Riemann problem has two materials without sections.
! grep -q '^kind = "riemann"' "$run/case.toml" 2> /dev/null || names='material left material right'
awk -f common/columns.awk "$1" | awk -v kind="$kind" -v names="$names" -v frames="${FRAME_FOLDER:-}" -v quantities="${QUANTITIES:-}" -f common/figures/tables.awk -f $script - "$@"
