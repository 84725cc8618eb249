# signals.sh: signals at random moments, again and again, until the run is complete; the same bytes.
. tests/torture/lab.sh
whole
end=$(($(date +%s) + seconds)) seed=1
while [ "$(date +%s)" -lt "$end" ]; do
    rm -rf "$folder/parts"
    for part in $(seq 30); do
        seed=$((seed + 1))
        set -- $(awk -v seed=$seed 'BEGIN {
            srand(seed)
            split("INT TERM KILL HUP USR1 QUIT ALRM", name)
            split("2 15 9 1 10 3 14", number)
            k = 1 + int(7 * rand())
            print name[k], 0.3 * rand() * rand(), number[k] }')
        expected=$((128 + $3))
        timeout --foreground --preserve-status -s "$1" "$2" $run "$folder/parts" \
            > "$folder/said" 2>&1
        status=$?
        tried=$((tried + 1))
        [ $status = 0 ] && break
        [ $status = $expected ] || fell "$1 after $2 s: status $status: $(tail -1 "$folder/said")"
    done
    goes_on "$folder/parts" "$part signals"
done
say
