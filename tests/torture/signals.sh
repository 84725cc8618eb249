# signals.sh: signals at random moments, again and again, until the run is complete; the same bytes.
. tests/torture/lab.sh
whole
end=$(($(date +%s) + seconds)) seed=1
while [ "$(date +%s)" -lt "$end" ]; do
    rm -rf "$folder/parts"
    for part in $(seq 30); do
        seed=$((seed + 1))
        set -- $(awk -v seed=$seed 'BEGIN { srand(seed); split("INT TERM KILL HUP USR1 QUIT ALRM", s)
            print s[1 + int(7 * rand())], 0.3 * rand() * rand() }')
        # What catches no other signal than INT and TERM is ended by it as by KILL.
        case $1 in INT) expected=130 ;; TERM) expected=143 ;; *) expected=$((128 + $(kill -l "$1"))) ;; esac
        timeout --foreground --preserve-status -s "$1" "$2" $run "$folder/parts" > "$folder/said" 2>&1
        status=$?
        tried=$((tried + 1))
        [ $status = 0 ] && break
        [ $status = $expected ] || fell "$1 after $2 s: status $status: $(tail -1 "$folder/said")"
    done
    goes_on "$folder/parts" "$part signals"
done
say
