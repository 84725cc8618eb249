#!/bin/sh
# build.sh: the book, out/book/ (HTML) and out/book.pdf, from the notes, the sources and finished runs.
# `make book` calls it. Ends with an error on a formula that does not render or a link that leads nowhere.
#   build.sh html      without the PDF
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/../.."
book=lecture_notes/book work=build/book out=out/book

for tool in pandoc node; do
    command -v "$tool" > /dev/null || { echo "'$tool' is not installed: run 'make deps-book'" >&2; exit 2; }
done
katex=$(node -p "require('./$book/formulas.js').folder || ''")
[ -n "$katex" ] || { echo "KaTeX is not installed: run 'make deps-book'" >&2; exit 2; }

node "$book/formulas.js" check README.md ./*/README.md lecture_notes/*.md lecture_notes/*/*.md

rm -rf "$work" "$out"
mkdir -p "$work" "$out/katex"
cp -rL "$katex/katex.min.css" "$katex/fonts" "$out/katex/"
cp "$book/book.css" "$book/book.js" "$out/"
cp -r lecture_notes/figures "$out/figures"

# ---- the pages, in order: note, page, group ---------------------------------------------------------
{
    echo "$book/index.md index.html Start"
    for note in lecture_notes/0*.md; do
        echo "$note $(basename "$note" .md).html Chapters"
    done
    for method in 1 2 3 4a 4b 5 6; do echo "$work/exercises_$method.md exercises_$method.html Exercises"; done
    for folder in cic flip mpm_explicit mpm_implicit implicit_moment; do
        echo "$folder/README.md program_$folder.html Programs"
    done
    echo "$work/cases.md cases.html Programs"
    for folder in cic flip mpm_explicit mpm_implicit implicit_moment; do echo "$work/cases_$folder.md cases_$folder.html Programs"; done
    for program in $(sed -n "/^mains := /{s///p;q;}" Makefile) common; do
        program=$(basename "$program" .cpp)
        echo "$work/source_$program.md source_$program.html Sources"
    done
    echo "$work/facts.md facts.html Sources"
    echo "validation validation.html Reference"
    echo "$work/bibliography.md bibliography.html Reference"
    echo "$work/index_of_terms.md index_of_terms.html Reference"
} > "$work/pages"

# ---- where the equations are -------------------------------------------------------------------------
awk '{
    line = $0
    while (match(line, /\\tag\{[A-Z]+-[0-9]+(, [0-9]+)?\}/)) {
        label = substr(line, RSTART + 5, RLENGTH - 6)
        line = substr(line, RSTART + RLENGTH)
        page = FILENAME
        sub(/.*\//, "", page); sub(/[.]md$/, ".html", page)
        count = split(label, part, /, /)
        method = part[1]; sub(/[0-9]+$/, "", method)
        print part[1], page "#eq-" part[1]
        if (count > 1) print method part[2], page "#eq-" method part[2]
    }
    line = $0
    while (match(line, /\\tag\{(i+|[A-Z])\}/)) {  # numbers that hold within a chapter
        label = substr(line, RSTART + 5, RLENGTH - 6)
        line = substr(line, RSTART + RLENGTH)
        page = FILENAME
        sub(/.*\//, "", page); sub(/[.]md$/, ".html", page)
        print page ":(" label ")", page "#eq-" label
    }
}' lecture_notes/0*.md > "$work/labels"
grep -o "](figures/[a-z0-9_]*\.png)" lecture_notes/0*.md | sed "s|^lecture_notes/\(.*\)\.md:.*/\(.*\)\.png)|figure:\2 \1.html#figure-\2|" | awk '!seen[$1]++' > "$work/figures"
awk '{ sub(/.*-/, "", $2) } seen[$1]++ { print "the label " $1 " is given twice"; bad = 1 } END { exit bad }' "$work/labels" >&2
cat "$work/figures" >> "$work/labels"

sh "$book/sources.sh" "$work"

sed -n 's|^@[a-z]*{\(.*\),$|\1|p; s|^  doi = {\(.*\)}$|doi \1|p' "$book/references.bib" |
    awk '$1 == "doi" { print key, $2; next } { key = $1 }' > "$work/dois"

# ---- generated pages ---------------------------------------------------------------------------------
for method in 1 2 3 4a 4b 5 6; do
    note=$(echo lecture_notes/0"$method"_*.md)
    { printf '# Exercises of chapter %s\n\n' "$method"
      printf 'To [%s](../%s). Answers are hidden: predict, run, then look. A second run of a case needs a folder of its own, `--out out/NAME`.\n' \
          "$(sed -n '1s/^# *//p' "$note")" "$(basename "$note")"
      for question in $(ls lecture_notes/exercises/"$method"-*.md | sort -t- -k2n); do
          id=$(basename "$question" .md)
          printf '\n<a id="%s"></a>\n\n' "$id"
          sed '/^```exercise/,/^```/d; 1s/^#/##/' "$question"
          printf '\nTo be graded: `make exercise E=%s`, %s.\n' "$id" "$(sed -n 's|^time: ||p' "$question")"
          printf '\n<details><summary>Answer</summary>\n\n'
          sed '1d; /^```answer/,/^```/d' "lecture_notes/solutions/$id.md"
          sed -n 's/^answer: *\(.*\)/\n**\1**/p' "lecture_notes/solutions/$id.md" | sed 's/+-/±/'
          printf '\n</details>\n'
      done
      projects=lecture_notes/exercises/projects-$method.md
      if [ -e "$projects" ]; then
          printf '\n<a id="projects"></a>\n\n'
          sed 's/^#/##/' "$projects"
      fi
    } > "$work/exercises_$method.md"
done
sh "$book/cases.sh" > "$work/cases.md"
printf -- '---\nnocite: "@*"\n---\n\n# Bibliography\n\n' > "$work/bibliography.md"
printf '# Index\n\n@INDEX@\n' > "$work/index_of_terms.md"

# ---- every page, in the frame ------------------------------------------------------------------------
title_of() {
    case $1 in
    validation) echo Validation ;;
    "$work"/source_*) sed -n 's/^title: "\(.*\)"/\1/p' "$1" ;;
    */README.md) echo "${1%/README.md}: run it, read it" ;;
    "$work/facts.md") echo 'Facts of the ledger' ;;
    *) sed -n 's/^# *//p' "$1" | sed -n 1p ;;
    esac
}
while read -r note page group; do
    printf '%s\t%s\t%s\n' "$page" "$group" "$(title_of "$note")"
done < "$work/pages" > "$work/titles"

while read -r note page group; do
    chapter=$(echo "$page" | sed -n 's/^00b_.*/P/p; s/^0*\([0-9][0-9]*[ab]*\)_.*/\1/p; s/^exercises_\(.*\)\.html/E\1/p; s/^program_.*/R/p')
    case $note in
    validation) sh common/validation.sh body > "$work/body" ;;
    "$work"/source_* | "$work/facts.md")
        { echo "<h1>$(title_of "$note")</h1>"; pandoc -f markdown-smart -t html5 --wrap=none "$note"; } > "$work/body" ;;
    "$work/bibliography.md")
        pandoc -f markdown -t html5 --wrap=none --citeproc --bibliography "$book/references.bib" "$note" > "$work/body" ;;
    *)
        source=$note
        case $note in "$work"/exercises_*) source=lecture_notes/exercises/$(basename "$note") ;; esac
        pandoc +RTS -M2g -RTS -f gfm+tex_math_dollars -t html5 --wrap=none --katex -L "$book/page.lua" \
            -M source="$source" -M chapter="${chapter:-0}" "$note" > "$work/body" || exit 1 ;;
    esac
    sh "$book/frame.sh" "$page" < "$work/body" > "$out/$page"
done < "$work/pages"

node "$book/finish.js" "$out" "$out/print.html"

# ---- the PDF -----------------------------------------------------------------------------------------
[ "${1:-}" != html ] || { rm "$out/print.html"; exit 0; }
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
[ -n "$browser" ] || { echo "no PDF: 'chromium' is not installed: run 'make deps-book'" >&2; exit 2; }
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
trap 'exit 1' HUP INT TERM
print_pdf() {
    "$browser" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
        --disable-component-update --disable-sync --user-data-dir="$profile" --no-pdf-header-footer \
        --generate-pdf-document-outline --virtual-time-budget=60000 \
        --print-to-pdf="$PWD/out/book.pdf" "file://$PWD/$out/print.html" 2> "$work/browser" ||
        { cat "$work/browser" >&2; exit 1; }
}
# Twice: where chapters begin is known after the first.
print_pdf
node "$book/page_numbers.js" out/book.pdf "$out/print.html"
print_pdf
rm "$out/print.html"
echo "out/book/index.html, out/book.pdf ($(du -h out/book.pdf | cut -f1))"
