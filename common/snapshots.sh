#!/bin/sh
# snapshots.sh: which snapshots of a kind (fields, particles, phase, fringes ...) a run has.
#   snapshots.sh all RUN KIND              their times, in order
#   snapshots.sh some RUN KIND N           at most N of these times, evenly chosen, the first and the last among them
#   snapshots.sh nearest RUN KIND TIME     the file that is nearest to a time; when it is not of that time, says so
# A missing kind gives nothing.
set -eu
export LC_ALL=C.UTF-8
what=$1 run=$2 kind=$3 wanted=${4:-0}

files=$(ls "$run/${kind}"_[0-9]*.dat 2>/dev/null) || exit 0
echo "$files" | while read -r file; do
    echo "$(sed -n '1,3s/^# time \([^ ]*\).*/\1/p' "$file") $file"
done |
    awk -v what="$what" -v wanted="$wanted" -v run="$run" -v kind="$kind" '
    { time[NR] = $1; sub(/^[^ ]* /, ""); file[NR] = $0 }
    END {
        if (what == "all") wanted = NR
        if (what == "nearest") {
            best = 1
            for (i = 2; i <= NR; i++)
                if ((time[i] - wanted) ^ 2 < (time[best] - wanted) ^ 2) best = i
            print file[best]
            # Half a step beside is the same time, for steps do not divide all times.
            spacing = NR > 1 ? (time[NR] - time[1]) / (NR - 1) : 0
            if ((time[best] - wanted) ^ 2 > (0.05 * spacing) ^ 2 + 1e-12 * wanted ^ 2)
                printf "%s has no %s at time %g; drawn at %g\n", run, kind, wanted, time[best] > "/dev/stderr"
        } else {
            count = NR < wanted ? NR : wanted
            for (i = 1; i <= count; i++)
                printf "%s%s", time[count == 1 ? NR : 1 + int((i - 1) * (NR - 1) / (count - 1) + 0.5)], i < count ? " " : "\n"
        }
    }'
