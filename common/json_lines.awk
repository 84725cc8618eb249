# json_lines.awk: a JSON file as lines "path value", e.g. "results.flux_initial.value 0.2".
# With  -v key=PATH  only that value, and status 1 when it is not there.

function fail(message) {
    printf "%s: character %d: %s\n", FILENAME, at, message > "/dev/stderr"
    failed = 1
    exit 2
}

function skip_blanks() {
    while (index(" \t\r\n", substr(text, at, 1)) && at <= length(text)) at++
}

function take(character) {
    skip_blanks()
    if (substr(text, at, 1) != character) return 0
    at++
    return 1
}

function take_string(    start) {
    start = at
    if (!take("\"")) fail("expected a string")
    start = at
    while (substr(text, at, 1) != "\"") {
        if (at > length(text)) fail("a string does not end")
        at += substr(text, at, 1) == "\\" ? 2 : 1
    }
    at++
    return substr(text, start, at - start - 1)
}

function show(path, value) {
    if (key == "") print path, value
    else if (path == key) {
        print value
        found = 1
    }
}

function take_value(path,    prefix, count, start) {
    prefix = path == "" ? "" : path "."
    skip_blanks()
    if (take("{")) {
        if (take("}")) return
        do {
            skip_blanks()
            start = take_string()
            if (!take(":")) fail("expected ':'")
            take_value(prefix start)
        } while (take(","))
        if (!take("}")) fail("expected ',' or '}'")
    } else if (take("[")) {
        if (take("]")) return
        do take_value(prefix count++)
        while (take(","))
        if (!take("]")) fail("expected ',' or ']'")
    } else if (substr(text, at, 1) == "\"") {
        show(path, take_string())
    } else {
        start = at
        while (at <= length(text) && !index(",]} \t\r\n", substr(text, at, 1))) at++
        if (at == start) fail("expected a value")
        show(path, substr(text, start, at - start))
    }
}

{ text = text $0 "\n" }

END {
    if (!failed) {
        at = 1
        take_value("")
        skip_blanks()
        if (at <= length(text)) fail("something follows the end")
    }
    exit failed ? 2 : (key != "" && !found)
}
