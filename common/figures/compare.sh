#!/bin/sh
# compare.sh A B: the results of two runs as a table: name, the first's, the second's, what is expected, the verdicts; where the runs differ in these, both.
set -eu
export LC_ALL=C.UTF-8
echo "result $(basename "$1" | tr ' ' _) $(basename "$2" | tr ' ' _) expected verdicts"
for which in 1 0; do
    [ $which = 1 ] || shift
    [ -f "$1/summary.json" ] || { echo "$1 has no results yet" >&2; continue; }
    awk -f common/json_lines.awk "$1/summary.json" | awk -f common/figures/results.awk | sed "s/^/$which /"
done | awk '
    $2 == "name" { next }
    {
        if (!($2 in seen)) order[++count] = $2
        seen[$2] = 1
        which = $1
        value[which, $2] = $3 == "null" ? "-" : sprintf("%.6g", $3) ($4 == "-" ? "" : "±" sprintf("%.2g", $4))
        verdict[which, $2] = $7
        if ($5 != "-") expected[which, $2] = $5 ~ /^[<>]/ ? substr($5, 1, 1) sprintf("%.4g", substr($5, 2)) : sprintf("%.4g", $5) ($6 == "-" ? "" : "±" sprintf("%.2g", $6))
    }
    function or_dash(text) { return text == "" ? "-" : text }
    function both(of, n) { return or_dash(of[1, n]) (or_dash(of[1, n]) == or_dash(of[0, n]) ? "" : "," or_dash(of[0, n])) }
    END { for (k = 1; k <= count; k++) { n = order[k]; print n, or_dash(value[1, n]), or_dash(value[0, n]), both(expected, n), both(verdict, n) } }'
