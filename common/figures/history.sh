#!/bin/sh
# history.sh RUN [RUN]: the gnuplot commands of history.gp, for one run or two.
set -eu
export LC_ALL=C.UTF-8
result() { [ ! -f "$run/summary.json" ] || awk -v key="results.$1" -f common/json_lines.awk "$run/summary.json" || true; }
run=$1
theory=$(result theory_growth.value)
# The times of the first measurement of the wave.
[ -z "$theory" ] || theory="$theory $(awk -f common/json_lines.awk "$run/summary.json" | sed -nE 's/^results[.](growth|damping|omega)[^ ]*[.]source .*from t = ([^ ]*) to ([^ ;]*).*/\2 \3/p' | head -n 1)"
awk -f common/columns.awk "$1/history.dat" |
    awk -v theory="$theory" -f common/figures/history.awk - "$1/history.dat" ${2:+"$2/history.dat"}
