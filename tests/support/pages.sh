#!/bin/sh
# pages.sh BUILD: every run of the pages in lecture_notes/page is a case of its program, and every slider one of its
# parameters, at both ends; chapters and code that a page points at are there.
set -eu
build=$1
out=$(mktemp)
trap 'rm -f "$out"' EXIT
trap 'exit 1' HUP INT TERM
# One line for each command: program, case and parameters.
awk '
    /^    [a-z_]+: \{/ { runs = 0 }
    /\{program: / {
        rest = $0
        while (match(rest, /\{program: "[a-z_]+", args: \[[^]]*\]/)) {
            run = substr(rest, RSTART, RLENGTH)
            rest = substr(rest, RSTART + RLENGTH)
            gsub(/\{program: |args: \[|[]",]/, " ", run)
            print run
            command[runs++] = run
        }
    }
    /sliders: / {
        rest = $0
        while (match(rest, /\["[^]]*\]/)) {
            split(substr(rest, RSTART + 2, RLENGTH - 3), part, /"?, */)
            rest = substr(rest, RSTART + RLENGTH)
            for (r = 0; r < runs; ++r)
                for (end = 2; end <= 3; ++end)
                    if (part[4] == "" || part[4] == r) {
                        changed = command[r]  # in the place of what the page itself sets
                        gsub(" " part[1] "=[^ ]*", "", changed)
                        print changed, part[1] "=" part[end]
                    }
        }
    }' lecture_notes/page/cases.js > "$out"
[ "$(wc -l < "$out")" -gt 60 ] || { echo "cases.js: only $(wc -l < "$out") commands were found" >&2; exit 1; }
status=0
while read -r program arguments; do
    # shellcheck disable=SC2086
    said=$("$build/$program" $arguments --dry-run 2>&1) || { status=1; echo "$program $arguments: $said" >&2; }
done < "$out"
for file in $(sed -n 's/.*chapter: "\([^"]*\)", step: "\([^"]*\)".*/lecture_notes\/\1 \2/p' lecture_notes/page/cases.js); do
    [ -f "$file" ] || { status=1; echo "cases.js: there is no $file" >&2; }
done
exit $status
