#!/bin/sh
# sources.sh FOLDER: one page of sources for each program, in reading order: main, the step, the
# headers of the step in the order in which the step calls them, and what these use.
#   out:  FOLDER/source_PROGRAM.md, and FOLDER/places, lines "kind name page#anchor": where each file, region,
#         each function of a file (FILE:FUNCTION), and each test (TESTFILE:NAME) is shown
set -eu
folder=$1
: > "$folder/places"
: > "$folder/shown"

# The headers that a step includes, of methods only, in the order in which it calls what they define.
in_order_of_calls() {  # step.hpp
    sed -n 's/^#include "\(.*\)"/\1/p' "$1" | grep -vE '^common/|/(setup|theory|output)/' |
        while read -r header; do
            awk -v step="$1" -v header="$header" -f lecture_notes/book/defined.awk -f /dev/stdin "$header" << 'END'
            BEGIN { while ((getline line < step) > 0) if (line !~ /^#include/) text = text line "\n" }
            (name = defined($0)) != "" && match(text, "[^A-Za-z0-9_]" name "[(<]") && (!first || RSTART < first) { first = RSTART }
            END { print (first ? first : 1000000 + NR), header }
END
        done | sort -s -n -k1,1 | sed 's/^[0-9]* //'
}

# The files of methods that the files on stdin include, themselves included.
with_what_they_use() {
    cat > "$folder/known"
    : > "$folder/before"
    until cmp -s "$folder/known" "$folder/before"; do
        cp "$folder/known" "$folder/before"
        xargs sed -n 's/^#include "\(.*\)"/\1/p' < "$folder/before" |
            grep -vE '^common/|/(setup|theory|output)/' |
            awk 'FILENAME == ARGV[1] { seen[$0] = 1; next } !seen[$0]++' "$folder/before" - >> "$folder/known"
    done
    cat "$folder/known"
}

# Files of a folder that the notes name and that are on no page so far.
named_in_notes() {  # folder
    cat lecture_notes/*.md | grep -oE "\(?(\.\./)?$1/[A-Za-z0-9_/]*\.[ch]pp" | sed 's|^(||; s|^\.\./||' |
        sort -u | while read -r file; do [ -e "$file" ] && echo "$file"; done
}

page() {  # page, title; the files on stdin
    page=$1
    printf -- '---\ntitle: "%s"\n---\n\n' "$2" > "$folder/$page.md"
    awk 'FILENAME == ARGV[1] { shown[$1] = $2; next } { print $0, ($0 in shown ? shown[$0] : "new") }' \
        "$folder/shown" - > "$folder/files"
    echo 'In reading order:' >> "$folder/$page.md"
    echo >> "$folder/$page.md"
    while read -r file where; do
        [ "$where" != new ] || where=$page
        first=$(awk '/^\/\/ / { sub(/^\/\/ /, ""); text = text " " $0; if (/[.:](  *\[[^]]*\])?$/) exit; next } { exit }
            END { sub(/^ /, "", text); gsub(/[\\*_<>$`^|\[\]]/, "\\\\&", text); print text }' "$file")
        anchor=$(echo "$file" | tr / .)
        echo "1. [\`$file\`]($where.html#$anchor) $first" >> "$folder/$page.md"
    done < "$folder/files"
    echo >> "$folder/$page.md"
    while read -r file where; do
        [ "$where" = new ] || continue
        echo "$file $page" >> "$folder/shown"
        anchor=$(echo "$file" | tr / .)
        { printf '## %s {#%s}\n\n' "$file" "$anchor"
          awk -v file="$file" -v page="$page.html" -v anchor="$anchor" -v places="$folder/places" \
              -v labels="$folder/labels" -f lecture_notes/book/defined.awk -f lecture_notes/book/source.awk "$file"; } >> "$folder/$page.md"
    done < "$folder/files"
}

program() {  # name, main
    step=${2%/*}/step.hpp
    { printf '%s\n%s\n' "$2" "$step"
      in_order_of_calls "$step"; } | with_what_they_use > "$folder/reading_order"
    page "source_$1" "$1: the source" < "$folder/reading_order"
}

for main in $(sed -n '/^mains := /{s///p;q;}' Makefile); do
    program "$(basename "$main" .cpp)" "$main"
done
{ ls common/*.hpp
  for top in cic flip mpm_explicit mpm_implicit implicit_moment common tests/support; do named_in_notes "$top"; done
  for note in */README.md; do
      grep -oE "\]\([a-z0-9_/]*\.[ch]pp\)" "$note" | sed "s|^](|${note%/*}/|; s|)$||"
  done
  awk -F'`' '/^\| *(PIC|COST|[A-Z]+-[0-9]+) *\|/ { for (i = 4; i <= NF; i += 4) if ($i ~ /^[a-z_]+\/.*[.]hpp$/ && $i !~ /^tests/) print $i }' \
      lecture_notes/00_the_talk.md; } | awk '!seen[$0]++' > "$folder/others"
awk 'FILENAME == ARGV[1] { shown[$1] = 1; next } !($0 in shown)' "$folder/shown" "$folder/others" > "$folder/rest"
page source_common 'Common headers, set-up and theory' < "$folder/rest"

# The tests that the ledger names, each from its first line to its closing brace.
{ printf -- '---\ntitle: "Facts of the ledger"\n---\n\n'
  echo 'Each equation of [the ledger](00_the_talk.html#the-ledger) names tests. Here they are, as they run.'
  echo; } > "$folder/facts.md"
awk '/^\| *(PIC|COST|[A-Z]+-[0-9]+) *\|/ {
    line = $0
    while (match(line, /`[^`]+` \(`tests\/[^`]+`\)/)) {
        split(substr(line, RSTART, RLENGTH), part, "`")
        print part[4] "\t" part[2]
        line = substr(line, RSTART + RLENGTH)
    } }' \
    lecture_notes/00_the_talk.md | awk '!seen[$0]++' | sort -s -k1,1 > "$folder/wanted"
while IFS='	' read -r file name; do
    number=$((${number:-0} + 1))
    printf '## %s {#fact-%s}\n\n`%s`\n\n``` {.cpp}\n' "$name" "$number" "$file" >> "$folder/facts.md"
    awk -v name="$name" '
    /^TEST_CASE/ { text = ""; on = 1 }
    on { text = text $0 "\n"
         joined = text; gsub(/"[ \n]+"/, "", joined); gsub(/\([ \n]+"/, "(\"", joined) }
    on && (/^}/ || /^TEST_CASE.*}$/) { on = 0; if (index(joined, "TEST_CASE(\"" name "\"")) { printf "%s", text; found = 1 } }
    END { exit !found }' "$file" >> "$folder/facts.md" ||
        { echo "sources.sh: $file has no test '$name'" >&2; exit 1; }
    printf '```\n\n' >> "$folder/facts.md"
    printf 'test %s:%s facts.html#fact-%s\n' "$file" "$(echo "$name" | tr ' ' '_')" "$number" >> "$folder/places"
done < "$folder/wanted"
