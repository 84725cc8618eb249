#!/bin/sh
# cases.sh: the table of all case files: what each is, the figures that are drawn from it, and the
# chapter. In Markdown; paths are relative to build/book/. For each folder a page of its cases, build/book/cases_FOLDER.md:
# the command, the file with its comments, what the program says of it before it runs, and what a finished run in out/ is compared with.
set -eu
program_of() {
    case $1 in
    */sphere_hits_plate.toml) echo pic ;;
    implicit_moment/cases/*explicit*) echo explicit_em ;;
    *) echo "${1%%/*}" ;;
    esac
}
page_of() {  # case
    name=$(basename "$1" .toml) program=$(program_of "$1")
    printf '\n<a id="case-%s"></a>\n\n## %s\n\n    build/%s %s\n\n' "$name" "$name" "$program" "$1"
    printf '```toml\n%s\n```\n' "$(cat "$1")"
    if said=$("build/$program" "$1" --dry-run 2>/dev/null); then printf '\nWith `--dry-run`, before it runs:\n\n```\n%s\n```\n' "$said"; fi
    run=out/$program/$name
    [ -f "$run/summary.json" ] || return 0
    printf '\n| result | is | expected | by |\n|---|---|---|---|\n'
    awk -f common/json_lines.awk "$run/summary.json" | awk -f common/figures/results.awk | awk '
        $6 != "-" && NR > 1 {
            text = $0; sub(/^([^ ]* ){7}/, "", text); gsub(/[\\*_<>|$^`]/, "\\\\&", text)
            expected = $4; sub(/^</, "at most ", expected); sub(/^>/, "at least ", expected)
            printf "| `%s` | %.5g | %s%s | %s |\n", $1, $2, expected, $5 == "-" ? "" : " ± " $5, text
        }'
    printf '\n<a href="validation.html#%s">This run</a> took %.3g s.\n' "$run" "$(awk -v key=performance.wall_s -f common/json_lines.awk "$run/summary.json")"
}
make -pqn menu 2> /dev/null | awk '
/^out\/.*\/[.]complete:/ || /^out\/figures\/.*[.]png:/ {
    target = $1; sub(/:$/, "", target)
    for (i = 2; i <= NF; i++) needs[target] = needs[target] " " $i
}
function folder_of(program) {
    return program ~ /^(pic|flip)$/ ? "flip" : program == "explicit_em" ? "implicit_moment" : program
}
END {
    for (target in needs) {
        if (target !~ /[.]png$/) continue
        name = target; sub(/.*\//, "", name); sub(/[.]png$/, "", name)
        if (name ~ /_quick$/) continue
        count = split(needs[target], run, " ")
        for (i = 1; i <= count; i++) {
            if (run[i] !~ /complete$/) continue
            # A run of one case has its name; a series says what it needs.
            split(run[i], part, "/")
            print folder_of(part[2]) "/cases/" part[3] ".toml", name
            number = split(needs[run[i]], file, " ")
            for (j = 1; j <= number; j++) if (file[j] ~ /[.]toml$/) print file[j], name
        }
    }
}' | sort -u > build/book/figures_of_cases
echo '# Table of cases'
echo
echo 'Every case is complete and runs by its path, for example `build/cic cic/cases/landau.toml`. The program compares the result with theory or a publication.'
for folder in cic flip mpm_explicit mpm_implicit implicit_moment; do
    notes=$(ls lecture_notes/0*.md | case $folder in
        cic) grep /01_ ;; flip) grep '/0[23]_' ;; mpm_explicit) grep /04a_ ;; mpm_implicit) grep /04b_ ;; *) grep '/0[56]_' ;;
        esac)
    printf '\n## %s\n\n' "$folder"
    for note in $notes; do printf '[%s](../../%s). ' "$(sed -n '1s/^# *//p' "$note")" "$note"; done
    printf '\n\n| case | what it is | figures |\n|---|---|---|\n'
    printf '# Cases of %s\n\nAll are in the [table of cases](cases.md).\n' "$folder" > "build/book/cases_$folder.md"
    for case in "$folder"/cases/*.toml; do
        what=$(awk '/^#/ { sub(/^# */, ""); if ($0 == "") exit; text = text " " $0; next } { exit } END { sub(/^ /, "", text); print text }' "$case" |
            sed 's/\([a-z0-9)]\{3,\}\)[.] [A-Z].*/\1./; s/[\\*_<>|$^`]/\\&/g')
        figures=$(awk -v case="$case" '$1 == case { printf "%s`%s`", separator, $2; separator = ", " }' build/book/figures_of_cases)
        name=$(basename "$case" .toml)
        printf '| [`%s`](cases_%s.md#case-%s) | %s | %s |\n' "$name.toml" "$folder" "$name" "$what" "$figures"
        page_of "$case" >> "build/book/cases_$folder.md"
        echo "file $case cases_$folder.html#case-$name" >> build/book/places
    done
done
