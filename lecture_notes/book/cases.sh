#!/bin/sh
# cases.sh: the table of all case files: what each is, the program that runs it, the figures that
# are drawn from it, and the chapter. In Markdown; paths are relative to build/book/.
set -eu
make -pqn menu 2> /dev/null | awk '
/^out\/.*\/[.]complete:/ || /^out\/figures\/.*[.]png:/ {
    target = $1; sub(/:$/, "", target)
    for (i = 2; i <= NF; i++) needs[target] = needs[target] " " $i
}
END {
    for (target in needs) {
        if (target !~ /[.]png$/) continue
        name = target; sub(/.*\//, "", name); sub(/[.]png$/, "", name)
        if (name ~ /_quick$/) continue
        count = split(needs[target], run, " ")
        for (i = 1; i <= count; i++) {
            number = split(needs[run[i]], file, " ")
            if (run[i] !~ /complete$/) continue
            for (j = 1; j <= number; j++) if (file[j] ~ /[.]toml$/) print file[j], name
        }
    }
}' | sort -u > build/book/figures_of_cases
echo '# Table of cases'
echo
echo 'Every case is complete and runs by its path, `build/PROGRAM PATH`. The program compares the result with theory or a publication.'
for folder in cic flip mpm_explicit mpm_implicit implicit_moment; do
    printf '\n## %s\n\n| case | what it is | figures |\n|---|---|---|\n' "$folder"
    for case in "$folder"/cases/*.toml; do
        what=$(awk '/^#/ { sub(/^# */, ""); if ($0 == "") exit; text = text " " $0; next } { exit } END { sub(/^ /, "", text); print text }' "$case" |
            sed 's/\([a-z0-9)]\{3,\}\)[.] [A-Z].*/\1./; s/[\\*_<>|$^`]/\\&/g')
        figures=$(awk -v case="$case" '$1 == case { printf "%s`%s`", separator, $2; separator = ", " }' build/book/figures_of_cases)
        printf '| `%s` | %s | %s |\n' "$(basename "$case")" "$what" "$figures"
    done
done
