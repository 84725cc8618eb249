#!/bin/sh
# page_numbers.sh: the contents of the book get the pages on which its chapters begin, and a chapter that is on no page is an error.
set -eu
command -v node > /dev/null || exit 77
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM
printf '%s\n' '7 0 obj' '<</Type /Pages' '/Kids [4 0 R 9 0 R]>>' '4 0 obj' '<</Type /Page' '/Parent 7 0 R>>' '9 0 obj' '<</Type /Page' '/Parent 7 0 R>>' \
    '<</one [4 0 R /XYZ 0 837.4 0]' '/two--part [9 0 R /XYZ 0 460.1 0]>>' > "$scratch/pdf"
contents='<li><a href="#one">One $a$</a><i></i></li><li><a href="#two--part">Two</a><i></i></li>'
echo "$contents" > "$scratch/print"
node lecture_notes/book/page_numbers.js "$scratch/pdf" "$scratch/print"
[ "$(cat "$scratch/print")" = "$(echo "$contents" | sed 's|<i>|<i>1|; s|<i></i>|<i>2</i>|')" ] || { echo "wrong pages: $(cat "$scratch/print")"; exit 1; }
echo "${contents}<li><a href=\"#three\">Three</a><i></i></li>" > "$scratch/print"
! node lecture_notes/book/page_numbers.js "$scratch/pdf" "$scratch/print" 2> /dev/null || { echo "a chapter on no page was not told"; exit 1; }
