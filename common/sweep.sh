#!/bin/sh
# sweep.sh CASE KEY=VALUE,VALUE ... [-- KEY=VALUE ...]: runs of a case with all combinations of these values, side by side, one thread each; a table of all results in the folder, results.dat, and a figure of them.
#   sh common/sweep.sh cic/cases/thermal_heating.toml method.weighting=ngp,cic,tsc seed=1,2,3 -- time.end=200
# A key without a section is completed (seed: plasma.seed); what follows -- is the same for all runs. Runs go to out/sweep/CASE/KEY=VALUE_KEY=VALUE; stopped, the same command goes
# on, and what is complete is not run again. In the environment, all optional:
#   PROGRAM           the program, where the folder of the case does not say it
#   SWEEP             folder of the runs;  SWEEP_NAME: their names, e.g. '{2}_{1}' of the first and the second value
#   PARALLEL_OPTIONS  of GNU parallel, e.g. '-j 4', or '--sshloginfile hosts --workdir .' for hosts that share this folder
#   SWEEP_ONLY=K/N    only every Nth run, beginning with the Kth: one element of a Slurm array, when the program is built (make would build it in each),
#                     sbatch --array=1-8 --wrap 'SWEEP_ONLY=$SLURM_ARRAY_TASK_ID/8 sh common/sweep.sh CASE KEY=VALUE,VALUE ...'
# Without GNU parallel (make deps-sweep) one run follows the other. Who publishes what came out of it is asked by GNU parallel to cite it: parallel --citation.
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/.."

fail() { echo "$*" >&2; exit 2; }

case=${1:-}
[ -z "$case" ] || [ -f "$case" ] || fail "no such case: $case"
[ -n "$case" ] && [ $# -ge 2 ] || fail "which case, and which values? make sweep CASE=cic/cases/thermal_heating.toml KEYS='method.weighting=ngp,cic,tsc seed=1,2,3'"
shift
program=${PROGRAM:-${case%%/*}}
[ "${program##*/}" != "$program" ] || program=${BUILD:-build}/$program
[ -x "$program" ] || fail "$program is not there: build it, or name the program of $case with PROGRAM=..."
folder=${SWEEP:-out/sweep/$(basename "$case" .toml)}
mkdir -p "$folder"

full_name() {  # of a key without its section
    case $1 in *.*) echo "$1"; return ;; esac
    full=$("$program" --help | sed -n "s/^  \([a-z_.]*\.$1\) .*/\1/p")
    [ -n "$full" ] || full=$("$program" --help | sed -n "s/^  \([a-z_.<>]*\.$1\) .*/\1/p" | head -n 1)
    [ -n "$full" ] || fail "'$1' is no parameter of $program"
    [ "$(echo "$full" | grep -c .)" = 1 ] || fail "'$1' is the key of several parameters of $program: $(echo $full)"
    case $full in *'<name>'*) fail "'$1' is a key of each: $full" ;; esac
    echo "$full"
}

word() { printf "'%s'" "$(printf %s "$1" | sed "s/'/'\\\\''/g")"; }
lists="" fixed=""
while [ $# -gt 0 ]; do
    case $1 in
    --)
        shift
        for one; do
            case $one in
            --force | --strict) ;;
            -*) fail "'$one' cannot follow --: each run has one thread and a folder of its own; KEY=VALUE, --force and --strict can" ;;
            *=*) ;;
            *) fail "'$one' is not KEY=VALUE" ;;
            esac
            fixed="$fixed $(word "$one")"
        done
        break
        ;;
    -*) fail "'$1' is not KEY=VALUE,VALUE; what is the same for all runs follows --" ;;
    *= | *=,* | *,,* | *,) fail "'$1' lacks a value: KEY=VALUE,VALUE" ;;
    *=*) lists="$lists $(full_name "${1%%=*}")=${1#*=}" ;;
    *) fail "'$1' is not KEY=VALUE,VALUE" ;;
    esac
    shift
done

# All combinations, the last key the fastest, as lines "NAME KEY=VALUE ...".
# shellcheck disable=SC2086
combinations=$(echo $lists | awk -v pattern="${SWEEP_NAME:-}" '
    function combine(k, name, keys,    value, n, i, part, key) {
        if (k > NF) { print (pattern == "" ? substr(name, 2) : filled()) keys; return }
        key = substr($k, 1, index($k, "=") - 1)
        n = split(substr($k, index($k, "=") + 1), value, ",")
        for (i = 1; i <= n; i++) {
            now[k] = value[i]
            part = key
            sub(/.*\./, "", part)
            combine(k + 1, name "_" part "=" value[i], keys " \047" key "=" value[i] "\047")
        }
    }
    function filled(    text, k) {
        text = pattern
        for (k = 1; k <= NF; k++) gsub("[{]" k "[}]", now[k], text)
        return text
    }
    { combine(1, "", "") }')

# One line of the shell for each run.
only=${SWEEP_ONLY:-1/1}
commands=$folder/commands${SWEEP_ONLY:+.${only%/*}}
echo "$combinations" | start="$(word "$program") $(word "$case") --threads 1 --resume --quiet --out $(word "$folder/")" \
    fixed=$fixed awk -v k="${only%/*}" -v n="${only#*/}" '(NR - k) % n == 0 { name = $1; $1 = ""; print ENVIRON["start"] "\047" name "\047" $0 ENVIRON["fixed"] }' > "$commands"

status=0 log=
if command -v parallel >/dev/null; then
    log=$commands.log
    # shellcheck disable=SC2086
    parallel --joblog "$log" ${PARALLEL_OPTIONS:-} < "$commands" || status=$?
else
    echo "note: GNU parallel is not installed (make deps-sweep): one run follows the other" >&2
    while read -r line; do sh -c "$line" </dev/null || status=$((status + 1)); done < "$commands"
fi
[ $status = 0 ] || echo "not all of the $(grep -c . "$commands") runs ended as they should: see ${log:+$log, and }what they said above" >&2

# The table, of earlier calls too: the keys of this call and those in which the runs differ, then every result with its error, expected value and verdict; "-" where there is none.
names=$(echo "$combinations" | sed 's/ .*//')
{ echo "$names"; find "$folder" -mindepth 1 -maxdepth 1 -type d | sed 's|.*/||' | sort -V; } | awk '!seen[$0]++' | while read -r name; do
    [ -f "$folder/$name/summary.json" ] || continue
    lines=$(awk -f common/json_lines.awk "$folder/$name/summary.json")
    echo "= $name/case.toml $(printf '%s\n' "$lines" | sed -n 's/^command //p')"
    printf '%s\n' "$lines" | awk -f common/figures/results.awk | sed 1d
done | folder=$folder awk -v lists="$lists" '
    function add_key(word) {
        if (!match(word, /^[a-z_]+[.][A-Za-z0-9_.-]+=/)) return
        word = substr(word, 1, RLENGTH - 1)
        if (!(word in is_key)) { is_key[word] = 1; key[++keys] = word }
    }
    function read_case(file,    line, section, at) {  # the complete input of the run
        while ((getline line < file) > 0) {
            if (line ~ /^\[/) { gsub(/[][]/, "", line); section = line }
            else if (at = index(line, " = ")) { given[rows, section "." substr(line, 1, at - 1)] = substr(line, at + 3) }
        }
        close(file)
    }
    function value_of(row, k,    text) { text = given[row, k]; gsub(/"/, "", text); gsub(/ /, "_", text); return text == "" ? "-" : text }
    BEGIN { n = split(lists, list, " "); for (i = 1; i <= n; i++) { add_key(list[i]) } asked = keys }
    $1 == "=" { rows++; read_case(ENVIRON["folder"] "/" $2); for (i = 3; i <= NF; i++) { add_key($i) } next }
    {
        if (!($1 in is_result)) { is_result[$1] = 1; results[++result_count] = $1 }
        cell[rows, $1] = $2 " " $3 " " $4 " " $6
    }
    END {
        for (k = 1; k <= keys; k++) {
            differs = k <= asked
            for (row = 2; row <= rows; row++) if (value_of(row, key[k]) != value_of(1, key[k])) differs = 1
            if (differs) { shown[++columns] = key[k]; printf "%s ", key[k] }
        }
        for (k = 1; k <= result_count; k++) printf "%s %s_error %s_expected %s_verdict ", results[k], results[k], results[k], results[k]
        print ""
        for (row = 1; row <= rows; row++) {
            for (k = 1; k <= columns; k++) printf "%s ", value_of(row, shown[k])
            for (k = 1; k <= result_count; k++) printf "%s ", ((row, results[k]) in cell) ? cell[row, results[k]] : "- - - -"
            print ""
        }
    }' > "$folder/results.dat.$$"
mv "$folder/results.dat.$$" "$folder/results.dat"
[ "$(grep -c . "$folder/results.dat")" -gt 1 ] || fail "no run has left results: there is no figure"
[ -n "${SWEEP_NAME:-}" ] || echo "table: $folder/results.dat, $(($(grep -c . "$folder/results.dat") - 1)) runs; this call has $(echo "$names" | grep -c .)"
if [ -z "${SWEEP_NAME:-}" ] && command -v gnuplot >/dev/null; then
    mkdir -p out/figures
    picture=out/figures/sweep_$(basename "$folder").png
    gnuplot -e "table='$folder/results.dat'; out='$picture'" common/figures/sweep.gp && echo "figure: $picture"
fi
[ $status = 0 ] || exit 1
