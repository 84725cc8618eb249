#!/bin/sh
# exercise.sh: exercises that say themselves whether they were done right. `make exercise` calls it.
#
#   lecture_notes/exercises/ID.md ends with             lecture_notes/solutions/ID.md with
#   ```exercise                                         ```answer
#   time: 20 s                                          answer: 0.577 +- 0.01
#   run a: PROGRAM CASE.toml key=value                  expect a: results.X.value = 0.06 +- 2%
#   expect a: results.X.verdict = PASS                  ```
#   patch: lecture_notes/exercises/ID.patch
#   ```
#   expect RUN: PATH = VALUE [+- TOLERANCE], or <= VALUE, or >= VALUE. PATH is status, a path in
#   summary.json, or history.COLUMN.last, .first, .max, .min, .at TIME. A RUN that refined its mesh
#   has the parts RUN/1, RUN/2 ... Where no status is expected it has to be 0.
#
#   exercise.sh list               every exercise with its title and the time that it takes
#   exercise.sh programs ID        the programs that it needs
#   exercise.sh run ID             the question, the runs, and whether their numbers are right
#   exercise.sh answer ID VALUE    is the answer right? Its value is not shown
#   exercise.sh test ID            the runs as a test; with a patch in a copy of the sources
#   exercise.sh check              every exercise is complete and has a solution, and vice versa; its code is that of
#                                  the patch, and no two runs that it prints go to one folder
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/.."

exercises=lecture_notes/exercises
solutions=lecture_notes/solutions
build=${BUILD:-build}

number='^[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$'

stop() { printf '%s\n' "$*" >&2; exit 2; }

block() {  # the lines of the block of this kind in a file
    awk -v kind="$1" '$0 == "```" kind { on = 1; next } /^```/ { on = 0 } on' "$2"
}

keys() {  # the values of this key ("run", "expect") in a block, as lines "name: value"
    sed -n "s/^$1  *\([^:]*:\)  */\1 /p"
}

find_exercise() {
    id=$1
    question=$exercises/$id.md solution=$solutions/$id.md
    [ -e "$question" ] || stop "there is no exercise '$id'; 'make exercises' lists them"
    [ -e "$solution" ] || stop "$question has no solution"
    block exercise "$question" > "$scratch/exercise"
    block answer "$solution" > "$scratch/answer"
    keys run < "$scratch/exercise" > "$scratch/runs"
    patch=$(sed -n 's/^patch: *//p' "$scratch/exercise")
}

programs_of() { sed 's/^[^:]*: *\([^ ]*\).*/\1/' "$scratch/runs" | sort -u; }

applies() (  # the patch to the tree in this folder, whether a repository is around it or not
    cd "$1"
    # shellcheck disable=SC2086
    env -u GIT_DIR GIT_CEILING_DIRECTORIES="$(dirname "$PWD")" git apply $3 "$2" 2>&1
)

# ---- one number of a run --------------------------------------------------------------------------
value_in_history() {  # file, COLUMN.last or COLUMN.at TIME
    awk -v column="${2%%.*}" -v which="${2#*.}" '
    BEGIN { at = split(which, part, " ") == 2 && part[1] == "at"; which = part[1] }
    NR == 1 {  # the names
        for (k = 1; k <= NF; k++) {
            if ($k == column) here = k
            if ($k == "time") time = k
        }
        if (!here || (at && !time)) exit
    }
    $1 + 0 == $1 {
        x = $here
        distance = $time - part[2]
        if (distance < 0) distance = -distance
        if (rows++ == 0 || which == "last" || (which == "max" && x + 0 > found + 0) ||
            (which == "min" && x + 0 < found + 0) || (at && distance < nearest)) {
            found = x
            nearest = distance
        }
    }
    END { if (rows == 0 || which !~ /^(first|last|min|max|at)$/) exit 1; print found }' "$1"
}

value_of() {  # folder of the run, path
    case $2 in
    status) cat "$1.status" ;;
    history.*) value_in_history "$1/history.dat" "${2#history.}" ;;
    *) awk -v key="$2" -f common/json_lines.awk "$1/summary.json" ;;
    esac
}

# Is the value as expected? in: value, =, <= or >=, what is expected.
holds() {
    awk -v value="$1" -v relation="$2" -v expected="$3" 'BEGIN {
        tolerance = 0
        if (split(expected, part, / *\+- */) == 2) { expected = part[1]; tolerance = part[2] }
        number = "'"$number"'"
        if (expected !~ number || value !~ number) exit !(relation == "=" && value "" == expected "")
        if (tolerance ~ /%$/) {
            sub(/%$/, "", tolerance)
            tolerance *= (expected < 0 ? -expected : expected) / 100
        }
        difference = value - expected
        if (relation == "=") exit !(difference <= tolerance + 0 && -difference <= tolerance + 0)
        exit !(relation == "<=" ? difference <= 0 : difference >= 0)
    }'
}

# Is the answer the expected value, rounded to as many digits as the answer has?
is_rounded() {
    awk -v value="$1" -v expected="$2" 'BEGIN {
        digits = value
        sub(/[eE].*/, "", digits)
        gsub(/[-+.]/, "", digits)
        sub(/^0*/, "", digits)
        exit !(digits != "" && sprintf("%.*e", length(digits) - 1, expected) + 0 == value + 0)
    }'
}

asks_for() { awk '/^```exercise/ { exit } /^Your answer:/' "$question" | grep -q "$1"; }

# The answer without blanks around it; what is no number is refused.
number_of_answer() {
    value=$(printf '%s' "$1" | tr '\n' ' ' | sed 's/^[[:space:]]*//; s/[[:space:]]*$//')
    [ -n "$value" ] || stop "the answer is empty: give a number, like ANSWER=0.5"
    case $value in
    *%*)
        asks_for 'per cent' && stop "the answer is asked for in per cent: write 92 for 92 %"
        stop "write 0.92 for 92 %"
        ;;
    esac
    case $value in
    *,*)
        point=$(printf '%s' "$value" | tr , .)
        printf '%s\n' "$point" | grep -qE "$number" && stop "'$value' is no number: write a point, $point"
        ;;
    esac
    printf '%s\n' "$value" | grep -qE "$number" ||
        stop "'$value' is no number: a number looks like 0.5, .5 or 5e-1"
}

# ---- the runs and their numbers --------------------------------------------------------------------
run_lines() {  # folder of the programs, folder of the runs; what the programs say goes to 4
    binaries=$1 folder=$2
    rm -rf "$folder"
    mkdir -p "$folder"
    while IFS= read -r line <&3; do
        name=${line%%:*}
        eval "set -- ${line#*: }"
        program=$1
        shift
        printf '\n%s: %s\n' "$name" "$build/${line#*: }"
        result=0
        "$binaries/$program" "$@" --out "$folder/$name" >&4 2>&4 || result=$?
        [ "$result" -lt 128 ] || exit "$result"
        echo "$result" > "$folder/$name.status"
    done 3< "$scratch/runs"
}

shown() { echo "$1" | awk '{ print /^[-+]?[0-9]/ ? sprintf("%.6g", $0) : $0 }'; }

judge_lines() {  # folder of the runs, block, yes where the expected values may be shown; sets wrong
    keys expect < "$2" > "$scratch/expected"
    while IFS= read -r line; do
        name=${line%%:*} rest=${line#*: }
        path=${rest%% [=<>]*}
        rest=${rest#"$path "}
        relation=${rest%% *} expected=${rest#* }
        if ! value=$(value_of "$1/$name" "$path" 2>/dev/null); then
            echo "  $name: the run says nothing of $path: NOT AS EXPECTED"
            wrong=1
        elif holds "$value" "$relation" "$expected"; then
            echo "  $name: $path is $(shown "$value"): as expected"
        else
            [ "$3" = yes ] && expected=" ($relation $expected)" || expected=
            echo "  $name: $path is $(shown "$value"): NOT AS EXPECTED$expected"
            wrong=1
        fi
    done < "$scratch/expected"
}

judge() {  # folder of the runs, whether the values of the solution may be shown
    wrong=0
    sed 's/:.*//' "$scratch/runs" | while read -r name; do
        grep -q "^expect *$name: *status" "$scratch/exercise" "$scratch/answer" || echo "expect $name: status = 0"
    done > "$scratch/well"
    judge_lines "$1" "$scratch/well" yes
    judge_lines "$1" "$scratch/exercise" yes
    judge_lines "$1" "$scratch/answer" "$2"
}

# A copy of the sources with the patch. What differs is copied with a new date, so that make sees it.
copy_with_patch() {
    tree=$build/exercises/tree
    find Makefile cic flip mpm_explicit mpm_implicit implicit_moment common -name Makefile -o -name '*.[ch]pp' |
        while read -r file; do
            cmp -s "$file" "$tree/$file" || { mkdir -p "$(dirname "$tree/$file")"; cp "$file" "$tree/$file"; }
        done
    applies "$tree" "$PWD/$patch" "" || stop "$patch does not apply to the sources"
    for program in $(programs_of); do
        env -u MAKEFLAGS -u MAKELEVEL -u BUILD -u SANITIZE -u TRAP -u REAL make -C "$tree" JOBS=1 OPTIMIZE=-O1 "build/$program"
    done
}

# The folders of the runs that the text of an exercise prints, the default ones, too.
folders_shown() {
    awk '
    /^```exercise/ { exit }
    /^    build\/[a-z]/ || /^    mpirun / { on = 1; line = "" }
    on {
        line = line " " $0
        if (sub(/\\$/, "", line)) next
        on = 0
        count = split(line, word, " ")
        program = name = folder = ""
        for (k = 1; k <= count; k++) {
            if (program == "" && word[k] ~ /^build\//) { program = word[k]; sub(/.*\//, "", program) }
            else if (name == "" && word[k] ~ /[.]toml$/) { name = word[k]; sub(/.*\//, "", name); sub(/[.]toml$/, "", name) }
            else if (word[k] == "--out") folder = word[k + 1]
            else if (word[k] == "--dry-run" || word[k] == "--help") next
        }
        print folder == "" ? "out/" program "/" (name == "" ? "the default case" : name) : folder
    }' "$question"
}

# The lines of code that the text shows: indented, and no commands.
code_shown() {
    awk '/^```exercise/ { exit } /^    [a-z]/ && !/^    (build\/|make |mpirun )/ { print }' "$question" | sed 's/^ *//'
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' HUP INT TERM

case ${1:-}:$# in
list:1)
    for question in $(ls "$exercises" | grep '^[0-9].*[.]md$' | sort -t- -k1,1 -k2n); do
        time=$(block exercise "$exercises/$question" | sed -n 's/^time: *//p')
        sed -n '1s/^# *//p' "$exercises/$question" | awk -v time="${time:--}" \
            '{ id = $1; sub(/^[^ ]+ +/, ""); printf "  %-6s %-8s %s\n", id, time, $0 }'
    done
    echo "The time is that of the runs. A program that is missing or that you have changed is compiled before, up to a minute or two."
    ;;
programs:2)
    find_exercise "$2"
    programs_of
    ;;
run:2)
    find_exercise "$2"
    awk '/^```exercise/ { exit } { print }' "$question"
    [ -s "$scratch/runs" ] || { echo "Nothing to run: give an answer, make exercise E=$id ANSWER=..."; exit 0; }
    exec 4>&1
    run_lines "$build" "out/exercises/$id"
    echo
    judge "out/exercises/$id" no
    if [ -n "$patch" ] && [ "$wrong" = 1 ] && applies . "$PWD/$patch" --check > /dev/null; then
        echo "The lines that this exercise is about are as they came: change them first."
    elif [ -n "$patch" ]; then
        echo "The change is undone with: git checkout$(sed -n 's|^+++ b/| |p' "$patch" | tr -d '\n')"
    fi
    grep -q '^answer:' "$scratch/answer" && echo "Your answer: make exercise E=$id ANSWER=..."
    exit "$wrong"
    ;;
answer:3)
    find_exercise "$2"
    expected=$(sed -n 's/^answer: *//p' "$scratch/answer")
    [ -n "$expected" ] || stop "exercise $id does not ask for a number"
    number_of_answer "$3"
    if holds "$value" = "$expected"; then
        echo "$expected" | awk -F' *[+]- *' '
            $1 == 0 || $2 + 0 == 0 { print "right"; exit }
            $2 ~ /%$/ { sub(/ *%/, "", $2); print "right (within " $2 " %)"; exit }
            { printf "right (within %.2g %%)\n", 100 * $2 / ($1 < 0 ? -$1 : $1) }'
        exit
    fi
    if asks_for 'power of ten' && holds "$value" ">=" 0 && holds "$value" "<=" 1; then
        echo "not right; the exponent is asked for, as -2 for 1e-2"
    else
        holds "$value" ">=" "${expected%% *}" && side=large || side=small
        if is_rounded "$value" "${expected%% *}"; then
            echo "not right, but near; give more digits: it is too $side"
        elif holds "$value" = "${expected%% *} +- 2%"; then
            echo "not right: near, but beyond the tolerance; too $side"
        else
            echo "not right; too $side"
        fi
    fi
    exit 1
    ;;
test:2)
    find_exercise "$2"
    binaries=$build folder=$build/exercises/$id
    if [ -n "$patch" ]; then
        copy_with_patch > "$scratch/words" 2>&1 || { cat "$scratch/words"; exit 1; }
        binaries=$build/exercises/tree/build
    fi
    exec 4> "$scratch/words"
    run_lines "$binaries" "$folder"
    judge "$folder" yes
    if [ "$wrong" = 0 ]; then rm -rf "$folder"; else tail -n 40 "$scratch/words"; fi
    exit "$wrong"
    ;;
check:1)
    status=0
    complain() { echo "$*"; status=1; }
    for solution in "$solutions"/[0-9]*.md; do
        [ -e "$exercises/${solution##*/}" ] || complain "$solution has no exercise"
    done
    for question in "$exercises"/[0-9]*.md; do
        id=$(basename "$question" .md)
        [ -e "$solutions/$id.md" ] || { complain "$question has no solution"; continue; }
        find_exercise "$id"
        cat "$scratch/exercise" "$scratch/answer" > "$scratch/both"
        head -n 1 "$question" | grep -q "^# $id [^ ]" || complain "$question: the first line is not '# $id TITLE'"
        head -n 1 "$solution" | grep -q "^# $id [^ ]" || complain "$solution: the first line is not '# $id TITLE'"
        grep -qE '^(answer:|expect )' "$scratch/answer" || complain "$solution has no block 'answer' that says something"
        grep -qE '^time: [0-9]+ s$' "$scratch/exercise" || complain "$question: no line 'time: N s'"
        grep -vE '^(answer: .+|time: .+|patch: .+|run [a-z0-9_]+: .+|expect [a-z0-9_/]+: [^ ]+( [0-9.]+)? (=|<=|>=) .+)$' \
            "$scratch/both" > "$scratch/other" && complain "$id: not a line of an exercise: $(cat "$scratch/other")"
        while IFS= read -r line; do
            for word in ${line#*: }; do
                case $word in
                *=* | *\"*) ;;
                *.toml) [ -e "$word" ] || complain "$question: there is no $word" ;;
                esac
            done
            program=$(echo "${line#*: }" | sed 's/ .*//')
            grep -q "^mains.*/$program\.cpp" Makefile || complain "$question: there is no program '$program'"
            grep -q "^expect *${line%%:*}[/:]" "$scratch/both" || complain "$id: nothing is expected of run ${line%%:*}"
        done < "$scratch/runs"
        keys expect < "$scratch/both" | sed 's|[/:].*||' | sort -u | while read -r name; do
            grep -q "^$name:" "$scratch/runs" || echo "$id: there is no run $name"
        done > "$scratch/strange"
        [ ! -s "$scratch/strange" ] || complain "$(cat "$scratch/strange")"
        twice=$(folders_shown | sort | uniq -d)
        [ -z "$twice" ] || complain "$question: two of the runs that it prints go to $twice: give them --out"
        if [ -n "$patch" ]; then
            applies . "$PWD/$patch" --check > "$scratch/words" || complain "$patch: $(cat "$scratch/words")"
            sed -n 's/^[ +] *//p' "$patch" > "$scratch/new"
            code_shown | grep -vxF -f "$scratch/new" > "$scratch/other" &&
                complain "$question: not a line of $patch: $(cat "$scratch/other")"
        fi
    done
    exit "$status"
    ;;
*)
    sed -n 's/^# \{0,1\}//; 2,21p' "$0" >&2
    exit 2
    ;;
esac
