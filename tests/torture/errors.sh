# errors.sh: a call of the system fails, once or from then on: a full disk, a broken one, no memory,
# no rights. The status is one of the contract, nothing is left in part, and the run goes on.
. tests/torture/lab.sh
whole
strace -f -qq -c -o "$folder/calls" $run "$folder/counted" > /dev/null 2>&1
while read -r call error most; do
    count=$(awk -v call="$call" '$NF == call { print $4 }' "$folder/calls")
    for n in $(awk -v n="${count:-0}" -v most="$most" 'BEGIN {
            if (most > n) most = n
            for (k = 1; k <= most; ++k) print int(k * n / most) }'); do
        for on in '' +; do
            rm -rf "$folder/failing"
            what="$error at $call $n$on"
            timeout 60 strace -f -qq -o "$folder/trace" -e inject="$call:error=$error:when=$n$on" \
                $run "$folder/failing" > "$folder/said" 2>&1
            status=$?
            [ $status = 127 ] && continue  # the loader's own, before the program is there
            tried=$((tried + 1))
            in_contract $status || fell "$what: status $status: $(tail -1 "$folder/said")"
            [ -d "$folder/failing" ] || continue
            # Who cannot take a file away, or see what it has opened, leaves it.
            case $call in unlink | newfstatat) ;; *) nothing_half "$folder/failing" "$what" ;; esac
            goes_on "$folder/failing" "$what"
        done
    done
done << END
write ENOSPC 8
write EIO 4
fsync EIO 4
rename ENOSPC 4
openat EMFILE 8
openat EACCES 4
close EIO 6
ftruncate EIO 3
unlink EACCES 3
mkdir EACCES 1
read EIO 4
newfstatat EIO 4
getdents64 EIO 3
fcntl EBADF 3
mmap ENOMEM 12
END
say
