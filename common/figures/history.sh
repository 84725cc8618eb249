#!/bin/sh
# history.sh RUN [RUN]: the gnuplot commands of history.gp, for one run or two.
set -eu
export LC_ALL=C.UTF-8
result() { [ ! -f "$run/summary.json" ] || awk -v key="results.$1" -f common/json_lines.awk "$run/summary.json" || true; }
run=$1
theory=$(result theory_growth.value)
[ -z "$theory" ] || theory="$theory $(result growth.source | sed -n 's/.*from t = \([^ ]*\) to \([^ ;]*\).*/\1 \2/p')"
awk -f common/columns.awk "$1/history.dat" |
    awk -v theory="$theory" -f common/figures/history.awk - "$1/history.dat" ${2:+"$2/history.dat"}
