#!/bin/sh
# notes.sh: keeps code and numbers in the lecture notes the same as in the programs.
#
#   a note says                                             and gets
#   <!-- code: cic/deposit_charge.hpp#deposit -->           the lines between  // [deposit]  and
#   ...                                                     // [/deposit]  of that file
#   <!-- end -->
#   <!-- value: out/cic/two_stream/summary.json#results.growth_rate.value %.3g -->0.353<!-- end -->
#
# Runs are not kept with the sources, so lecture_notes/numbers.txt keeps their numbers: lines
# "file#path value tolerance", the tolerance absolute (0.005) or relative (5%).
#
#   notes.sh write      put code and numbers into the notes
#   notes.sh check      say what write would change; status 1 when anything
#   notes.sh refresh    take the numbers from finished runs in out/ into numbers.txt
#   notes.sh compare    finished runs against numbers.txt, within the tolerances
#   notes.sh ledger     every function and test that the ledger of equations names exists
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/.."

numbers=lecture_notes/numbers.txt
ledger=lecture_notes/00_the_talk.md
notes=$(ls lecture_notes/*.md README.md ./*/README.md 2>/dev/null | sed 's|^\./||' | sort -u)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM

# ---- a note with fresh code and numbers ----------------------------------------------------------
fresh='
function fail(message) {
    printf "%s:%d: %s\n", FILENAME, FNR, message > "/dev/stderr"
    failed = 1
    exit 1
}

function language(path) {
    if (path ~ /\.[ch]pp$/) return "cpp"
    if (path ~ /\.toml$/) return "toml"
    if (path ~ /\.gp$/) return "gnuplot"
    if (path ~ /\.sh$/) return "sh"
    if (path ~ /(^|\/)Makefile$/) return "make"
    return ""
}

# Print the region of the file as a code block, its common indentation removed.
function print_region(path, region,    line, inside, seen, n, i, indent, least, lines, status) {
    least = 1000
    while ((status = (getline line < path)) > 0) {
        if (line ~ /^[ \t]*(\/\/|#) \[\/?[A-Za-z0-9_]+\][ \t]*$/) {
            gsub(/^[ \t]*(\/\/|#) \[|\][ \t]*$/, "", line)
            if (line == region) {
                if (seen) fail("region " region " opens twice in " path)
                inside = seen = 1
            } else if (line == "/" region) {
                inside = 0
            }
        } else if (inside && line !~ /^ *clock\.lap\(/) {  # the clock of a bench is no part of the method
            lines[++n] = line
            match(line, /^ */)
            if (line ~ /[^ \t]/ && line !~ /^#pragma/ && RLENGTH < least) least = RLENGTH
        }
    }
    close(path)
    if (status < 0) fail("cannot read " path)
    if (!seen) fail("no region // [" region "] in " path)
    if (inside) fail("region // [" region "] has no end // [/" region "] in " path)
    print "```" language(path)
    for (i = 1; i <= n; i++) print lines[i] ~ /^#pragma/ ? lines[i] : substr(lines[i], least + 1)
    print "```"
}

BEGIN {
    while ((getline entry < numbers) > 0) {
        split(entry, part, " ")
        if (entry !~ /^# / && entry != "") value[part[1]] = part[2]
    }
}

opened {
    if ($0 == "<!-- end -->") {
        opened = 0
        print
    } else if (/<!-- (code|value):/) {
        fail("the block of line " opened " is not closed by <!-- end -->")
    }
    next
}

/^<!-- code:/ {
    if ($0 !~ /^<!-- code: [^ #]+#[A-Za-z0-9_]+ -->$/) fail("expected <!-- code: file#region -->")
    print
    split($3, part, "#")
    print_region(part[1], part[2])
    opened = FNR
    next
}

{
    rest = $0
    done = ""
    while (match(rest, /<!-- value: [^ ]+#[^ ]+ %[-+0-9.]*[efg]%?%? -->/)) {
        if (substr(rest, 1, RSTART - 1) ~ /<!-- (code|value):/) break
        marker = substr(rest, RSTART, RLENGTH)
        done = done substr(rest, 1, RSTART - 1) marker
        rest = substr(rest, RSTART + RLENGTH)
        end = index(rest, "<!-- end -->")
        if (!end || index(substr(rest, 1, end - 1), "<!--")) fail("this value is not closed by <!-- end -->")
        split(marker, part, " ")
        if (!(part[3] in value)) fail("no value " part[3] " in " numbers "; run it, then make notes")
        done = done sprintf(part[4], value[part[3]]) "<!-- end -->"
        rest = substr(rest, end + 12)
    }
    if (rest ~ /<!-- (code|value):/) fail("expected <!-- value: file#path %.3g -->...<!-- end --> or a code block at the start of a line")
    if (rest ~ /<!-- end -->/) fail("<!-- end --> without a beginning")
    print done rest
}

END {
    if (!failed && opened) {
        printf "%s:%d: this block is not closed by <!-- end -->\n", FILENAME, opened > "/dev/stderr"
        failed = 1
    }
    exit failed
}'

# ---- the numbers that the notes use ----------------------------------------------------------------
keys_in_use() {
    # shellcheck disable=SC2086
    sed -n 's/<!-- value: /\n&/gp' $notes | sed -n 's/^<!-- value: \([^ ]*#[^ ]*\) .*/\1/p' | sort -u
}

entry_of() {  # the line of numbers.txt for a key
    [ ! -e "$numbers" ] || awk -v key="$1" '$1 == key' "$numbers"
}

finished() {  # is this a summary of a run that ended well and was not overwritten since?
    for folder in "$(dirname "$1")" "$(dirname "$1")/.."; do
        [ -e "$1" ] && [ -e "$folder/.complete" ] && ! [ "$1" -nt "$folder/.complete" ] && return 0
    done
    return 1
}

number_of() {  # the number of a key in the run itself
    number=$(awk -v key="${1#*#}" -f common/json_lines.awk "${1%%#*}") ||
        { echo "${1%%#*}: no value ${1#*#}" >&2; return 1; }
    echo "$number" | grep -Eqx -- '-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?' ||
        { echo "${1%%#*}: ${1#*#} is '$number', not a number" >&2; return 1; }
    echo "$number"
}

within() {  # number, expected, tolerance
    awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
        if (t ~ /%$/) { sub(/%$/, "", t); t = t / 100 * (b < 0 ? -b : b) }
        exit !(a - b <= t + 0 && b - a <= t + 0) }'
}

# ---- the modes -------------------------------------------------------------------------------------
status=0
case ${1:-} in
write | check)
    for note in $notes; do
        if ! awk -v numbers="$numbers" "$fresh" "$note" > "$scratch/fresh"; then
            status=1
        elif ! cmp -s "$note" "$scratch/fresh"; then
            if [ "$1" = write ]; then
                cat "$scratch/fresh" > "$note"
                echo "updated $note"
            else
                line=$(cmp "$note" "$scratch/fresh" 2>&1 | sed 's/.* line \([0-9]*\).*/\1/')
                echo "$note:$line: not what the programs say; run 'make notes'"
                diff -u --label "$note" --label "$note, fresh" "$note" "$scratch/fresh" || true
                status=1
            fi
        fi
    done
    ;;
refresh)
    echo '# Numbers of finished runs, as the notes quote them: file#path value tolerance.' > "$scratch/numbers"
    for key in $(keys_in_use); do
        old=$(entry_of "$key")
        if finished "${key%%#*}"; then
            number=$(number_of "$key") || { status=1; continue; }
            tolerance=$(echo "$old" | awk '{ print $3 }')
            awk -v key="$key" -v number="$number" -v tolerance="${tolerance:-5%}" \
                'BEGIN { printf "%s %.6g %s\n", key, number, tolerance }' >> "$scratch/numbers"
        elif [ -n "$old" ]; then
            echo "$old" >> "$scratch/numbers"
        else
            echo "no number yet for $key: make its figure first" >&2
            status=1
        fi
    done
    if [ -e "$numbers" ] || [ "$(wc -l < "$scratch/numbers")" -gt 1 ]; then
        cmp -s "$scratch/numbers" "$numbers" || { cat "$scratch/numbers" > "$numbers"; echo "updated $numbers"; }
    fi
    ;;
compare)
    count=0
    for key in $(keys_in_use); do
        count=$((count + 1))
        # shellcheck disable=SC2046
        set -- compare $(entry_of "$key")
        if [ $# -ne 4 ]; then
            echo "$numbers: expected a line '$key value tolerance'; run 'make notes'"
            status=1
        elif ! finished "${key%%#*}"; then
            echo "$key: no finished run; make its figure first"
            status=1
        elif ! number=$(number_of "$key") || ! within "$number" "$3" "$4"; then
            echo "$key: the run says ${number:-nothing}, the notes say $3 +- $4"
            status=1
        fi
    done
    echo "$count numbers compared with their runs"
    ;;
ledger)
    awk '
    function fail(message) {
        printf "%s:%d: %s\n", FILENAME, FNR, message
        failed = 1
    }

    # The file as one line, so that a name may be broken over lines; "" when it cannot be read.
    function contents(path,    line, text) {
        if (!(path in known)) {
            while ((getline line < path) > 0) text = text line " "
            close(path)
            gsub(/[ \t]+/, " ", text)
            gsub(/" "/, "", text)
            gsub(/\( "/, "(\"", text)
            known[path] = text
        }
        return known[path]
    }

    # Is the label in the text, by itself or inside a range like IMM-10..12 ?
    function mentions(text, label,    method, number, ends) {
        if (match(text, label "[^0-9.]")) return 1
        method = label; sub(/[0-9]+$/, "", method)
        number = substr(label, length(method) + 1) + 0
        while (match(text, method "[0-9]+[.][.][0-9]+")) {
            split(substr(text, RSTART + length(method), RLENGTH - length(method)), ends, /[.][.]/)
            if (ends[1] + 0 <= number && number <= ends[2] + 0) return 1
            text = substr(text, RSTART + RLENGTH)
        }
        return 0
    }

    # Every `name` (`file`) of a cell, several separated by <br>, must be true.
    function check(cell, label, is_test,    entry, name, path, text, pattern) {
        while (cell != "") {
            if (!match(cell, /^`[^`]+` \(`[^`]+`\)/)) {
                fail(label ": expected `name` (`file`), several separated by <br>, or not built yet; got " cell)
                return
            }
            split(substr(cell, 1, RLENGTH), entry, "`")
            cell = substr(cell, RLENGTH + 1)
            sub(/^ *<br> */, "", cell)
            name = entry[2]; path = entry[4]
            text = contents(path)
            pattern = is_test ? "TEST_CASE[(] ?\"" : "(^|[^A-Za-z0-9_])" name " ?[(<]"
            if (text == "") fail(label ": there is no file " path)
            else if (is_test && !index(text, "TEST_CASE(\"" name "\"")) fail(label ": no TEST_CASE \"" name "\" in " path)
            else if (!is_test && !match(text, pattern)) fail(label ": no function " name " in " path)
            else if (!is_test && !mentions(text, label)) fail(label ": " path " does not mention the label")
        }
    }

    function trimmed(cell) {
        gsub(/^ +| +$/, "", cell)
        return cell
    }

    /^\| *(PIC|COST|[A-Z]+-[0-9]+) *\|/ {
        row = $0
        gsub(/\\\|/, "", row)
        n = split(row, cell, "|")
        label = trimmed(cell[2]); made = trimmed(cell[5]); tested = trimmed(cell[6])
        if (n != 7) { fail(label ": expected five cells"); next }
        if (label in seen && label != "PIC") fail(label " has two rows")
        seen[label] = 1
        if (made == "not built yet" && tested == "not built yet") { waiting++; next }
        check(made, label, 0)
        check(tested, label, 1)
        if (made == "" || tested == "") fail(label ": a cell is empty")
        built++
    }

    END {
        n = split("CIC 1 5 FLIP 6 8 MPM 1 15 IMM 9 13", range, " ")
        for (i = 1; i <= n; i += 3)
            for (k = range[i + 1] + 0; k <= range[i + 2] + 0; k++) {
                label = range[i] "-" k
                if (!(label in seen)) fail(label " has no row")
                delete seen[label]
            }
        n = split("PIC COST", unnumbered, " ")  # slides without numbers
        for (i = 1; i <= n; i++) {
            if (!(unnumbered[i] in seen)) fail(unnumbered[i] " has no row")
            delete seen[unnumbered[i]]
        }
        for (label in seen) fail(label " is not a label of the talk")
        printf "%d equations built, %d not built yet\n", built, waiting
        exit failed
    }' "$ledger" || status=1
    ;;
*)
    sed -n 's/^# \{0,1\}//; 2,17p' "$0" >&2
    exit 2
    ;;
esac
exit $status
