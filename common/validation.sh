#!/bin/sh
# validation.sh: what the finished runs in out/ say, beside theory, as a page. Nothing is remembered:
# every number comes from a summary.json that a program wrote.
#   validation.sh         writes out/book/validation.html
#   validation.sh body    prints the page without its frame
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")/.."
runs=${RUN_FOLDER:-out}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM

# Which figure is drawn from the runs of a folder: lines "folder figure".
make -pqn menu 2> /dev/null | awk '/^out\/figures\/.*[.]png:/ {
    figure = $1; sub(/.*\//, "", figure); sub(/[.]png:$/, "", figure)
    for (i = 2; i <= NF; i++) if (sub(/\/[.]complete$/, "", $i)) print $i, figure }' > "$scratch/figures" || true

picture_of() {  # folder of a run: the name of its picture, which is copied beside the page
    for folder in "$1" "${1%/*}"; do
        awk -v folder="$folder" '$1 == folder { print $2 }' "$scratch/figures"
    done | while read -r figure; do
        picture=out/figures/$figure.png
        [ -e "$picture" ] || continue
        mkdir -p out/book/runs
        cp "$picture" out/book/runs/
        echo "$figure"
    done | sort -u | tr '\n' ' '
}

body() {
    find "$runs" -mindepth 2 -name summary.json ! -path "$runs/exercises/*" | sort > "$scratch/runs"
    echo '<h1>Validation</h1>'
    if [ ! -s "$scratch/runs" ]; then
        echo '<p>There are no finished runs in <code>out/</code>. Make some, for example <code>make cic_landau fig09</code>, or all: <code>make figures</code>.</p>'
        return
    fi
    while read -r summary; do
        folder=${summary%/summary.json}
        echo "= $folder $(picture_of "$folder")"
        awk -f common/json_lines.awk "$summary"
    done < "$scratch/runs" > "$scratch/lines"
    awk '
    function escaped(text) {
        gsub(/\\"/, "\"", text); gsub(/&/, "\\&amp;", text); gsub(/</, "\\&lt;", text); gsub(/>/, "\\&gt;", text)
        return text
    }
    function short(number) { return number == "" || number == "null" ? "" : number ~ /^[-+0-9.]/ ? sprintf("%.5g", number) : escaped(number) }
    function cell(text) { return "<td>" text "</td>" }
    function flush(    i, name, row, expected, verdict, rest) {
        if (folder == "") return
        if (value["", "program"] != program) { program = value["", "program"]; print "<h2" (headed[program]++ ? "" : " id=\"" program "\"") ">" program "</h2>" }
        print "<h3 id=\"" folder "\">" (index(folder, program "/") ? substr(folder, index(folder, program "/") + length(program) + 1) : folder) "</h3>"
        print "<table class=\"wide\"><thead><tr><th>result</th><th>measured</th><th>error</th><th>expected</th><th>tolerance</th>" \
              "<th>verdict</th><th>source</th></tr></thead><tbody>"
        for (i = 1; i <= results; i++) {
            name = order[i]
            verdict = value[name, "verdict"]
            expected = short(value[name, "expected"])
            if (value[name, "at_most"] != "") expected = "at most " short(value[name, "at_most"])
            if (value[name, "at_least"] != "") expected = "at least " short(value[name, "at_least"])
            row = cell("<code>" name "</code>") cell(short(value[name, "value"]) " " escaped(value[name, "unit"])) \
                  cell(short(value[name, "error"])) cell(expected) cell(short(value[name, "tolerance"])) \
                  cell("<span class=\"" verdict "\">" verdict "</span>") cell(escaped(value[name, "source"]))
            if (verdict != "") { print "<tr>" row "</tr>"; count[verdict]++ }
            else rest = rest "<tr>" row "</tr>\n"
        }
        print "</tbody></table>"
        if (rest != "") print "<details><summary>Numbers without a verdict</summary><table>" rest "</table></details>"
        command = value["", "command_line"] value["", "command"]
        if (command == "") command = "build/" value["", "program"] " " folder "/case.toml --out out/again"
        revision = value["", "source_revision"] value["", "revision"]
        print "<p>Again: <code>" escaped(command) "</code>. " \
              (revision != "" ? "Revision " escaped(revision) ", v" : "V") "ersion " value["", "version"] ", " \
              sprintf("%.3g", value["performance", "wall_s"]) " s on " short(value["performance", "threads"]) (value["performance", "threads"] == 1 ? " thread" : " threads") ".</p>"
        for (i = 1; i <= pictures; i++)
            print "<figure><a href=\"runs/" picture[i] ".png\"><img src=\"runs/" picture[i] ".png\" alt=\"" picture[i] "\" loading=\"lazy\"></a></figure>"
        delete_all()
    }
    function delete_all(    i) { for (i in value) delete value[i]; for (i in order) delete order[i]; results = 0 }
    /^= / {
        flush()
        folder = $2
        pictures = 0
        for (i = 3; i <= NF; i++) if (!shown[$i]++) picture[++pictures] = $i
        runs++
        next
    }
    {
        count_of_parts = split($1, key, ".")
        text = substr($0, length($1) + 2)
        if (count_of_parts == 1) value["", key[1]] = text
        else if (key[1] ~ /^command/) value["", key[1]] = value["", key[1]] (key[2] == 0 ? "" : " ") text  # a list of words
        else if (key[1] == "performance") value["performance", key[2]] = text
        else if (key[1] == "results") {
            if (!((key[2], "seen") in value)) { value[key[2], "seen"] = 1; order[++results] = key[2] }
            value[key[2], key[3]] = text
        }
    }
    END {
        flush()
        printf "<!-- %d runs", runs
        for (verdict in count) { printf ", %d %s", count[verdict], verdict }
        print " -->"
    }' "$scratch/lines" > "$scratch/body"
    sed -n 's/^<!-- \(.*\) -->$/<p>\1. Each row is a number that a program measured, beside what theory or a publication says. An EXPECTED FAILURE is a case that exists to show one.<\/p>/p' "$scratch/body"
    grep -v '^<!--' "$scratch/body"
}

case ${1:-} in
body) body ;;
'')
    mkdir -p out/book
    cp lecture_notes/book/book.css lecture_notes/book/book.js out/book/
    body > "$scratch/page"
    sh lecture_notes/book/frame.sh validation.html < "$scratch/page" > out/book/validation.html
    echo out/book/validation.html
    ;;
*)
    sed -n 's/^# \{0,1\}//; 2,5p' "$0" >&2
    exit 2
    ;;
esac
