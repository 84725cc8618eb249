# limits.sh: little memory, short files, few and closed descriptors, a folder that nobody may write
# to, a language with decimal commas. The status is one of the contract, what is complete is right.
. tests/torture/lab.sh
whole
under() {  # under STATUSES COMMAND: a run in a shell that has done this
    rm -rf "$folder/limited"
    tried=$((tried + 1))
    timeout 60 sh -c "$2" sh $run "$folder/limited" > "$folder/said" 2>&1
    status=$?
    # Before the program is there, its loader ends with 127, or crashes.
    [ $status = 139 ] &&
        ! sh -c "export LD_TRACE_LOADED_OBJECTS=1; $2" sh "${run%% *}" > /dev/null 2>&1 && status=127
    case " $1 127 " in
    *" $status "*) ;;
    *) fell "$2: status $status: $(tail -1 "$folder/said")" ;;
    esac
    [ -d "$folder/limited" ] && nothing_half "$folder/limited" "$2"
    goes_on "$folder/limited" "$2"
}
for kilobytes in 12000 16000 20000 24000 28000 32000 40000 60000 100000 400000; do
    under '0 2' "ulimit -v $kilobytes; exec \"\$@\""
done
for kilobytes in 100 200 400 800 1600 6400; do
    under '0 2' "ulimit -d $kilobytes; exec \"\$@\""
done
for blocks in 0 1 2 4 8 16 64 256; do under '0 2' "ulimit -f $blocks; exec \"\$@\""; done
for files in 3 4 5 6 7 8; do under '0 2' "ulimit -n $files; exec \"\$@\""; done
under '0 2' 'ulimit -s 128; exec "$@"'
for closed in '<&-' '>&-' '2>&-' '<&- >&-' '<&- 2>&-' '>&- 2>&-' '<&- >&- 2>&-' '>/dev/full' \
    '2>/dev/full' '>/dev/full 2>&1'; do
    under 0 "exec \"\$@\" $closed"
done

mkdir -p "$folder/locale"
if localedef -i de_DE -f UTF-8 "$folder/locale/de_DE.UTF-8" > /dev/null 2>&1; then
    under 0 "exec env LOCPATH=$PWD/$folder/locale LANG=de_DE.UTF-8 LC_ALL=de_DE.UTF-8 \"\$@\""
else
    echo "$program: skipped: no de_DE here (package locales)"
fi

# The superuser may write everywhere, so it becomes somebody else.
mkdir -m 555 "$folder/closed"
somebody=
[ "$(id -u)" = 0 ] && somebody='setpriv --reuid=65534 --regid=65534 --clear-groups'
if $somebody test -x "$BUILD/$program"; then
    tried=$((tried + 1))
    $somebody $run "$folder/closed/run" > "$folder/said" 2>&1
    [ $? = 2 ] || fell "a folder without rights: $(tail -1 "$folder/said")"
fi

# A control group of either version; who needs more than it has may be killed by the kernel.
for limit in memory/:memory.limit_in_bytes :memory.max; do
    group=/sys/fs/cgroup/${limit%:*}torture_$program limit=${limit#*:}
    grouped=no
    mkdir "$group" 2> /dev/null || continue
    for bytes in 3000000 10000000 30000000; do
        echo $bytes 2> /dev/null > "$group/$limit" || continue
        grouped=yes
        under '0 2 137' "echo \$\$ > $group/cgroup.procs; exec \"\$@\""
    done
    rmdir "$group"
    [ $grouped = yes ] && break
done
[ "${grouped:-no}" = yes ] || echo "$program: skipped: no control group may be made here"
say
