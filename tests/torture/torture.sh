# torture.sh: the laboratory; MINUTES, JOBS, BUILD and MAKE are those of make. Each experiment
# is made with each program; what has ended is not made again until all have. EXPERIMENTS and
# PROGRAMS choose some of them.
set -u
room=$BUILD/torture/results
mkdir -p "$room" out/torture
for tool in strace clang++; do
    command -v $tool > /dev/null && continue
    echo "'$tool' is not installed: run 'make deps-dev'" >&2
    exit 2
done
export deadline=$(($(date +%s) + 60 * MINUTES)) room MAKE BUILD
# Of all time six tenths are for inputs, a tenth for forged files, a twentieth for signals.
export share=$((60 * MINUTES * JOBS / 7))
programs=${PROGRAMS:-implicit_moment explicit_em mpm_implicit mpm_explicit flip pic cic}
experiments=${EXPERIMENTS:-kills errors signals limits threads forged inputs}
for experiment in $experiments; do
    for program in $programs; do echo "$experiment $program"; done
done | xargs -P "$JOBS" -L 1 sh -c '
    result=$room/$1.$2
    [ -f "$result" ] && exit 0
    [ "$(date +%s)" -lt "$deadline" ] || exit 0
    case $1 in
    inputs) seconds=$((share * 6 / 10)) ;;
    forged) seconds=$((share / 10)) ;;
    *) seconds=$((share / 20)) ;;
    esac
    sh "tests/torture/$1.sh" "$2" "out/torture/$1.$2" $seconds > "$result.part" 2>&1
    mv "$result.part" "$result"
    echo "$1 $2: $(tail -1 "$result")"' sh

printf '\n%-10s %-16s %10s %8s\n' experiment program tried failed
for experiment in $experiments; do
    for program in $programs; do
        result=$room/$experiment.$program
        if [ -f "$result" ]; then
            set -- $(tail -1 "$result")
            printf '%-10s %-16s %10s %8s\n' $experiment $program "$1" "$2"
        else
            printf '%-10s %-16s %10s\n' $experiment $program 'not yet'
        fi
    done
done | tee out/torture/table.txt
if grep -q 'not yet' out/torture/table.txt; then
    echo "not finished; 'make torture' goes on" >&2
    exit 1
fi
for experiment in $experiments; do
    for program in $programs; do
        rm "$room/$experiment.$program"
        cat "out/torture/$experiment.$program/failures" 2> /dev/null
    done
done > out/torture/failures.txt
awk '$3 == 0 || $4 != 0 { bad = 1 } END { exit bad }' out/torture/table.txt && exit 0
echo "what failed: out/torture/failures.txt" >&2
exit 1
