# kills.sh: a run is killed at the n-th call of each kind that it makes of the system, and goes on.
. tests/torture/lab.sh
whole
strace -f -qq -c -o "$folder/calls" $run "$folder/counted" > /dev/null 2>&1
kinds='write openat close rename fsync ftruncate unlink newfstatat getdents64 fcntl mmap brk read
    mkdir exit_group'
for call in $kinds; do
    count=$(awk -v call="$call" '$NF == call { print $4 }' "$folder/calls")
    most=4
    [ "$call" = write ] && most=24
    for n in $(awk -v n="${count:-0}" -v most=$most 'BEGIN {
            if (most > n) most = n
            for (k = 1; k <= most; ++k) print int(k * n / most) }'); do
        rm -rf "$folder/killed"
        timeout 60 strace -f -qq -o "$folder/trace" -e inject="$call:signal=KILL:when=$n" \
            $run "$folder/killed" > "$folder/said" 2>&1
        tried=$((tried + 1))
        goes_on "$folder/killed" "killed at $call $n"
    done
done 2> /dev/null
say
