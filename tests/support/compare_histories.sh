#!/bin/sh
# compare_histories.sh OLD NEW [SECONDS]: whether two checkouts, both built with 'make all', write the
# same numbers: every shipped case runs with every program of its method in both, for at most SECONDS
# (120), and the rows that both have written are compared byte by byte; names of columns may differ.
# Run it in NEW. Says what differs, and ends with status 1 if something does.
set -u
export LC_ALL=C.UTF-8
old=$1 new=$2 seconds=${3:-120}
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
trap 'exit 1' HUP INT TERM
same=0 differ=0 skipped=0
run() {  # run CHECKOUT PROGRAM CASE: rows of the history to $room/$4, without the names
    rm -rf "$room/out"
    (cd "$1" && timeout "$seconds" "build/$2" "$3" --out "$room/out" --quiet --threads 1) >/dev/null 2>&1
    status=$?
    [ -e "$room/out/history.dat" ] || return 1
    # A run that was stopped may have begun a row.
    grep -v '^#' "$room/out/history.dat" | if [ "$status" = 0 ]; then cat; else sed '$d'; fi > "$room/$4"
}
for case in */cases/*.toml; do
    method=${case%%/*}
    case $method in
        flip) programs='pic flip' ;;
        implicit_moment) programs='implicit_moment explicit_em' ;;
        *) programs=$method ;;
    esac
    for program in $programs; do
        run "$old" "$program" "$case" old || { skipped=$((skipped + 1)); continue; }
        run "$new" "$program" "$case" new || { echo "$program $case: NEW has no history"; differ=$((differ + 1)); continue; }
        rows=$(wc -l < "$room/old")
        [ "$rows" -le "$(wc -l < "$room/new")" ] || rows=$(wc -l < "$room/new")
        head -n "$rows" "$room/old" > "$room/old.rows"
        head -n "$rows" "$room/new" > "$room/new.rows"
        if cmp -s "$room/old.rows" "$room/new.rows"; then
            same=$((same + 1))
            echo "$program $case: $rows rows, the same"
        else
            differ=$((differ + 1))
            echo "$program $case: DIFFERENT within $rows rows"
        fi
    done
done
echo "$same the same, $differ different, $skipped not for that program"
[ "$differ" = 0 ]
