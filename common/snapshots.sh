#!/bin/sh
# snapshots.sh: which snapshots of a kind (fields, particles, phase, fringes ...) a run has.
#   snapshots.sh all RUN KIND              their times, in order
#   snapshots.sh some RUN KIND N           at most N of these times, evenly chosen, the first and the last among them
#   snapshots.sh near RUN KIND 'T T ...'   of these times the nearest to each; says so when one is not there
#   snapshots.sh file RUN KIND T           the file that is nearest to this time
# Without such files nothing.
set -eu
export LC_ALL=C.UTF-8
what=$1 run=$2 kind=$3 wanted=${4:-0}

files=$(ls "$run/${kind}"_[0-9]*.dat 2>/dev/null) || exit 0
echo "$files" | tr '\n' '\0' | xargs -0 awk '/^# time/ { print $3, FILENAME } FNR == 3 { nextfile }' |
    awk -v what="$what" -v wanted="$wanted" -v run="$run" -v kind="$kind" '
    { time[NR] = $1; sub(/^[^ ]* /, ""); file[NR] = $0 }
    function nearest(t,    i, best) {
        best = 1
        for (i = 2; i <= NR; i++) if ((time[i] - t) ^ 2 < (time[best] - t) ^ 2) best = i
        return best
    }
    END {
        if (what == "file") { print file[nearest(wanted)]; exit }
        if (what == "near") {
            # Steps do not divide all times: a part of the interval beside is the same time.
            slack = NR > 1 ? 0.1 * (time[NR] - time[1]) / (NR - 1) : 0
            count = split(wanted, t)
            for (k = 1; k <= count; k++) {
                i = nearest(t[k])
                if ((time[i] - t[k]) ^ 2 > slack ^ 2 + 1e-12 * t[k] ^ 2)
                    printf "note: %s has no %s at time %g; drawn at %g\n", run, kind, t[k], time[i] > "/dev/stderr"
                if (k == 1 || i > last) list = list (k > 1 ? " " : "") time[i]
                last = i
            }
        } else {
            count = what == "all" || NR < wanted ? NR : wanted
            for (k = 1; k <= count; k++)
                list = list (k > 1 ? " " : "") time[count == 1 ? NR : 1 + int((k - 1) * (NR - 1) / (count - 1) + 0.5)]
        }
        print list
    }'
