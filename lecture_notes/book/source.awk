# source.awk: one source file as Markdown: comments of functions and files as text, code between them.
# Needs defined.awk.
#   -v file=PATH -v page=PAGE -v anchor=ANCHOR -v places=FILE (lines are added) -v labels=FILE
# Labels of equations in comments become links; every function gets a line in places.
BEGIN {
    while ((getline line < labels) > 0) {
        split(line, part, " ")
        target[part[1]] = part[2]
    }
    print "file", file, page "#" anchor >> places
}

function escaped(text) {
    gsub(/&/, "\\&amp;", text); gsub(/</, "\\&lt;", text); gsub(/>/, "\\&gt;", text)
    return text
}

function linked(text,    done, label) {
    text = escaped(text)
    while (match(text, /(CIC|FLIP|MPM|IMM)-[0-9]+/)) {
        label = substr(text, RSTART, RLENGTH)
        done = done substr(text, 1, RSTART - 1)
        done = done (label in target ? "<a class=\"label\" href=\"" target[label] "\">" label "</a>" : label)
        text = substr(text, RSTART + RLENGTH)
    }
    return done text
}

function close_piece() {
    if (open == "p") print "</p>"
    if (open == "pre") print "</pre>"
    open = ""
}

# Sentences flow; what is indented is a formula; in:, out:, exact: begin a line of their own.
function flush_comment(    i, line, key, keyed) {
    if (!comments) return
    print "```{=html}"
    print "<div class=\"comment\">"
    for (i = 1; i <= comments; i++) {
        line = comment[i]
        if (line ~ /^ *$/) { close_piece(); keyed = 0 }
        else if (match(line, /^(in|out|in\/out|exact|note|source|errors|Run|room|where):/)) {
            close_piece()
            key = substr(line, 1, RLENGTH)
            sub(/^[^:]*: */, "", line)
            print "<p class=\"key\"><b>" key "</b> " linked(line)
            open = "p"; keyed = 1
        } else if (line ~ /^  / && !(keyed && line ~ /^      /)) {
            if (open != "pre") { close_piece(); print "<pre>"; open = "pre"; keyed = 0 }
            print linked(line)
        } else {
            sub(/^ +/, "", line)
            if (open != "p") { close_piece(); print "<p>"; open = "p" }
            print linked(line)
        }
    }
    close_piece()
    print "</div>\n```\n"
    comments = 0
}

function flush_code(    i, first, last, name) {
    first = 1; last = lines
    while (first <= last && code[first] ~ /^ *$/) first++
    while (last >= first && code[last] ~ /^ *$/) last--
    if (first <= last) {
        first += start - 1; last += start - 1
        printf "``` {#%s.L%d .cpp .numberLines startFrom=\"%d\"}\n", anchor, first, first
        for (i = first; i <= last; i++) {
            print code[i - start + 1]
            if (match(code[i - start + 1], /\/\/ \[[A-Za-z0-9_]+\]$/))
                print "region", file "#" substr(code[i - start + 1], RSTART + 4, RLENGTH - 5), page "#" anchor ".L" first "-" i >> places
            name = defined(code[i - start + 1])
            if (name != "" && !seen[name]++) print "function", file ":" name, page "#" anchor ".L" first "-" i >> places
        }
        print "```\n"
    }
    lines = 0
}

/^\/\// && !/^\/\/ \[\/?[A-Za-z0-9_]+\]$/ {
    flush_code()
    text = $0
    sub(/^\/\/\/? ?/, "", text)
    comment[++comments] = text
    next
}
{
    flush_comment()
    if (!lines) start = FNR
    code[++lines] = $0
}
END { flush_comment(); flush_code() }
