# A name before a bracket, on a line that begins a definition.
function defined(line,    name) {
    if (line !~ /^(    )?[A-Za-z][A-Za-z0-9_:<>,&* ]*[ &*][a-z][A-Za-z0-9_]*\(/) return ""
    if (line ~ /^ *(return|namespace|using|static_assert|template|else|if|for|while|throw|case|delete) *[^A-Za-z_]/) return ""
    if (line ~ /^ *(return|throw|else) /) return ""
    name = line
    sub(/\(.*/, "", name)
    sub(/.*[ &*]/, "", name)
    return name
}
