#!/bin/sh
# frame.sh PAGE: the body on stdin in the frame of the book: contents at the side, the pages before
# and after it. Without build/book/titles, which `make book` writes, the page stands alone.
set -eu
titles=build/book/titles
[ -e "$titles" ] || titles=/dev/null
awk -F'\t' -v here="$1" -v body=/dev/stdin '
function escaped(text) {
    gsub(/&/, "\\&amp;", text); gsub(/</, "\\&lt;", text); gsub(/`/, "", text)
    gsub(/\$[^$]*\$/, "", text)
    return text
}
FILENAME == ARGV[1] {
    page[++n] = $1; group[n] = $2; title[n] = escaped($3)
    if ($1 == here) at = n
    next
}
{
    if (/@TITLE@/) sub(/@TITLE@/, at ? title[at] : "Validation")
    if (/@NAV@/) {
        for (i = 1; i <= n; i++) {
            if (group[i] != last) print (i > 1 ? "</ul>" : "") "<p>" group[i] "</p><ul>"
            last = group[i]
            printf "<li%s><a href=\"%s\">%s</a></li>\n", (i == at ? " class=\"here\"" : ""), page[i], title[i]
        }
        if (n) print "</ul>"
        next
    }
    if (/@BODY@/) { while ((getline line < body) > 0) print line; next }
    if (/@TURN@/) sub(/@TURN@/, (at > 1 ? "<a href=\"" page[at - 1] "\">← " title[at - 1] "</a>" : "<span></span>") \
                                (at && at < n ? "<a href=\"" page[at + 1] "\">" title[at + 1] " →</a>" : ""))
    print
}' "$titles" lecture_notes/book/page.html
