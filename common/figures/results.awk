# results.awk: the results of a summary, from its lines of json_lines.awk, as a table for gnuplot, in the order of the file:
#   name value error expected tolerance verdict source...      with - where there is none
# For a bound, expected is "<BOUND" or ">BOUND".
$1 ~ /^results\./ {
    path = $1
    sub(/^results\./, "", path)
    key = path
    sub(/.*\./, "", key)
    sub(/\.[^.]*$/, "", path)
    if (!(path in seen)) order[++count] = path
    seen[path] = 1
    $1 = ""
    has[path, key] = substr($0, 2)
}
function get(key) { return has[order[k], key] == "" ? "-" : has[order[k], key] }
END {
    print "name value error expected tolerance verdict unit source"
    for (k = 1; k <= count; k++) {
        expected = get("expected")
        if (get("at_most") != "-") expected = "<" get("at_most")
        if (get("at_least") != "-") expected = ">" get("at_least")
        verdict = get("verdict"); unit = get("unit")
        gsub(/ /, "_", verdict); gsub(/ /, "_", unit)
        print order[k], get("value"), get("error"), expected, get("tolerance"), verdict, unit, get("source")
    }
}
