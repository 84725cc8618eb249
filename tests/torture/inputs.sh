# inputs.sh: what libFuzzer thinks of, see fuzz.cpp. A crash, a hang of five seconds of this processor or
# a status outside the contract is kept in FOLDER/found; each is tried once more to be counted.
. tests/torture/lab.sh
BUILD=$BUILD/torture/fuzz
[ -n "${SKIP_BUILD:-}" ] || $MAKE -s BUILD="$BUILD" CXX=clang++ SANITIZE=fuzzer-no-link,address,undefined \
    OPTIMIZE='-O1 -gline-tables-only -fno-sanitize-coverage=trace-cmp' "$BUILD/fuzz/$program" > "$folder/built" 2>&1 ||
    fell "is not built: $(tail -1 "$folder/built")"
[ -w /dev/shm ] && export TMPDIR=/dev/shm
export ASAN_OPTIONS=detect_leaks=0:malloc_context_size=4:quarantine_size_mb=8:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1 OMP_THREAD_LIMIT=1 FUZZ_COUNT="$folder/count"
mkdir -p "$folder/corpus" "$folder/found"
end=$(($(date +%s) + seconds)) start=1
while left=$((end - $(date +%s))) && [ $left -gt 0 ] && [ $failed -lt 50 ]; do
    "$BUILD/fuzz/$program" -seed=$start -detect_leaks=0 -timeout=10 -entropic=0 -close_fd_mask=3 -rss_limit_mb=3000 -max_len=20000 \
        -artifact_prefix="$folder/found/" -max_total_time=$left "$folder/corpus" > "$folder/said.$start" 2>&1
    tried=$((tried + $(od -A n -t d8 "$folder/count")))
    start=$((start + 1))
    for input in "$folder"/found/*; do
        case $input in *.said | *'*') continue ;; esac
        [ ! -f "$input.said" ] || continue
        (ulimit -t 5; "$BUILD/fuzz/$program" -detect_leaks=0 -close_fd_mask=3 "$input") > "$input.said" 2>&1 && continue
        fell "$input: $(grep -m 1 -hE ': status|nobody expected|runtime error|SUMMARY' "$input.said")"
    done
done
say
