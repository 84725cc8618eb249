#!/bin/sh
# links.sh: every relative link of the documents leads to a file, and every #anchor to a heading,
# named as GitHub names it; what is cited by its DOI is in the bibliography. Every figure of the talk is shown in a chapter.
set -eu
export LC_ALL=C
cd "$(dirname "$0")/../.."
documents=$(ls README.md ./*/README.md lecture_notes/*.md lecture_notes/*/*.md | sed 's|^\./||')
status=0

# The text without code, in which brackets are no links.
# shellcheck disable=SC2086
awk '
function fail(message) {
    printf "%s:%d: %s\n", FILENAME, FNR, message
    failed = 1
}
# GitHub: lower case, without punctuation, spaces as hyphens; the second of a name gets -1.
function slug(heading,    name) {
    gsub(/\[|\]\([^)]*\)/, "", heading)
    name = tolower(heading)
    gsub(/[!-,.\/:-@\[-^`{-~]/, "", name)
    gsub(/ /, "-", name)
    return name
}
function resolved(path,    part, count, i, n, kept) {  # without . and ..
    count = split(path, part, "/")
    for (i = 1; i <= count; i++) {
        if (part[i] == "..") n--
        else if (part[i] != "." && part[i] != "") kept[++n] = part[i]
    }
    path = kept[1]
    for (i = 2; i <= n; i++) path = path "/" kept[i]
    return path
}
FNR == 1 { fenced = 0; folder = FILENAME; if (!sub(/[^\/]*$/, "", folder)) folder = "" }
/^ *```/ { fenced = !fenced; next }
fenced { next }
/^#+ / {
    heading = $0
    sub(/^#+ +/, "", heading)
    name = slug(heading)
    known[FILENAME "#" name (seen[FILENAME, name]++ ? "-" seen[FILENAME, name] - 1 : "")] = 1
}
/^    / { next }
{
    line = $0
    gsub(/`[^`]*`/, "", line)
    while (match(line, /<a id="[^"]*"/)) {
        known[FILENAME "#" substr(line, RSTART + 7, RLENGTH - 8)] = 1
        line = substr(line, RSTART + RLENGTH)
    }
    line = $0
    gsub(/`[^`]*`/, "", line)
    while (match(line, /\]\([^) ]+\)/)) {
        target = substr(line, RSTART + 2, RLENGTH - 3)
        line = substr(line, RSTART + RLENGTH)
        if (sub(/^https:..doi.org./, "", target)) {
            gsub(/%28/, "(", target)
            gsub(/%29/, ")", target)
            if (system("grep -qF \"{" target "}\" lecture_notes/book/references.bib")) fail("the bibliography has no " target)
            continue
        }
        if (target ~ /^https?:/) continue
        links++
        anchor = ""
        if (target ~ /^#/) target = FILENAME target
        else target = folder target
        if (match(target, /#/)) {
            anchor = substr(target, RSTART + 1)
            target = substr(target, 1, RSTART - 1)
        }
        place[links] = FILENAME ":" FNR
        file[links] = resolved(target)
        wanted[links] = anchor
    }
}
END {
    for (i = 1; i <= links; i++) {
        if (system("test -e \"" file[i] "\"")) {
            printf "%s: there is no %s\n", place[i], file[i]
            failed = 1
        } else if (wanted[i] != "" && file[i] ~ /[.]md$/ && !((file[i] "#" wanted[i]) in known)) {
            printf "%s: %s has no heading #%s\n", place[i], file[i], wanted[i]
            failed = 1
        }
    }
    printf "%d links followed\n", links
    exit failed || !links
}' $documents || status=1

for figure in fig01 fig02 fig03 fig04 fig05 fig06 fig07 fig08 fig09 fig10 fig11 fig12 fig13 fig14 fig15 fig_cost; do
    grep -q "](figures/$figure.png)" lecture_notes/*.md || { echo "no chapter shows $figure"; status=1; }
done
for picture in lecture_notes/figures/*; do
    grep -q "figures/${picture##*/})" README.md ./*/README.md lecture_notes/*.md ||
        { echo "$picture is shown nowhere"; status=1; }
done
exit $status
