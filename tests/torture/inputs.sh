# inputs.sh: case files and command lines that libFuzzer thinks of, see fuzz.cpp. A crash, a hang of
# five seconds of this processor or a status outside the contract is kept in FOLDER/found; each is
# tried once more, to be counted.
. tests/torture/lab.sh
made fuzz fuzzer-no-link,address,undefined -fno-sanitize-coverage=trace-cmp fuzzers
fuzzer=$BUILD/torture/fuzz/fuzz/$program
[ -w /dev/shm ] && export TMPDIR=/dev/shm
export ASAN_OPTIONS=detect_leaks=0:malloc_context_size=4:quarantine_size_mb=8
export ASAN_OPTIONS=$ASAN_OPTIONS:allocator_may_return_null=1:intercept_memcmp=0
export UBSAN_OPTIONS=print_stacktrace=1 OMP_THREAD_LIMIT=1 FUZZ_COUNT="$folder/count"
mkdir -p "$folder/corpus" "$folder/found"
# Of the forged checkpoints of the corpus libFuzzer begins with the refused ones; those that fell
# are tried again.
if [ -n "${FUZZ_ONLY:-}" ]; then
    for list in refused fallen; do
        grep -E "^($program|every) " tests/torture/corpus/$list.txt | while read -r name line; do
            at=$((${at:-0} + 1))
            [ $list = refused ] && where=corpus || where=found
            echo "forge $line" | sed 's/ | /\n/g' > "$folder/$where/$list$at"
        done
    done
fi
silent='-detect_leaks=0 -close_fd_mask=3'
look_at_found() {
    for input in "$folder"/found/*; do
        case $input in *.said | *'*') continue ;; esac
        [ ! -f "$input.said" ] || continue
        (ulimit -t 5; "$fuzzer" $silent "$input") > "$input.said" 2>&1 && continue
        what=$(grep -m 1 -E ': status|nobody expected|runtime error|SUMMARY' "$input.said")
        fell "$input: $what"
    done
}
look_at_found
end=$(($(date +%s) + seconds)) start=1
while left=$((end - $(date +%s))) && [ $left -gt 0 ] && [ $failed -lt 50 ]; do
    "$fuzzer" $silent -seed=$start -timeout=5 -entropic=0 -rss_limit_mb=3000 \
        -max_len=20000 -artifact_prefix="$folder/found/" -max_total_time=$left \
        "$folder/corpus" > "$folder/said.$start" 2>&1
    tried=$((tried + $(od -A n -t d8 "$folder/count")))
    start=$((start + 1))
    look_at_found
done
say
