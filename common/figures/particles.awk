# particles.awk: the gnuplot commands of particles.gp, after tables.awk.
$1 + 0 == $1 {
    count[files]++; seen[$(group = number["species"] + number["material"] + number["grain"])]
    speed = 0
    for (i = 1; i <= NF; i++) if (name[i] ~ /^v_[xyz]$/) speed += $i * $i
    if (speed > fastest) fastest = speed
}
function range(axis, i,    wide) {
    wide = high[i] > low[i] ? high[i] - low[i] : 1
    return sprintf("set %srange [%.9g:%.9g]; set %stics %g", axis, low[i] - 0.03 * wide, high[i] + 0.03 * wide, axis, nice(wide / 3))
}

# One row of the page: the columns a and b, in the color of the group or, colored, of the speed.
function row(k, a, b, colored,    f) {
    print range("x", a) "; " range("y", b)
    if (colored) printf "eval colors(viridis); set cbrange [0:%.9g]\n", sqrt(fastest)
    for (f = from; f <= to; f++) {
        begin_panel(f, k, rows_of_page, a, b, colored && fastest > 0 ? "speed" of_speed : "", 0, sqrt(fastest))
        printf "set title 'time %.5g'\n", time[f]
        size = count[f] > 5000 ? 0.15 : count[f] > 500 ? 0.4 : 1
        if (!count[f]) print "plot -1e30"
        else printf "plot '%s' using %d:%d:(%s) with points pt 7 ps %g lc %s notitle%s\n", file[f], a, b, colored ? "sqrt(" squares ")" : group ? "color_of($" group ")" : "0x0072B2", size, colored ? "palette" : "rgb variable", colored || f < to ? "" : key
    }
}

function page() {
    begin_page(250 + (longest > 6 ? 13 * (longest - 6) : 0), to - from + 1, rows_of_page)
    print "color_of(n) = n < 0 ? 0x777777 : int(word('29362 13983232 40563 13400487 15113984 5682409 7829367 0', 1 + int(n) % 8)); set key at screen " (115 + (to - from + 1) * (width + 25)) / wide ", graph 1 left top Left reverse samplen 0.5 font ',16'"
    row(1, x, plane ? other : number["v_x"] ? number["v_x"] : columns, 0)
    if (rows_of_page == 2) row(2, x, other, 1)
    print "unset multiplot"
}

END {
    split(names, list, " "); for (i = 1; i in list; i += 2) if (number[list[i]]) entry[++entries] = list[i + 1]
    for (i = 1; i <= entries && entries <= 8; i++) if (i - 1 in seen) {
        key = key sprintf(", keyentry with points pt 7 ps 1 lc rgb color_of(%d) title '%s'", i - 1, plain(entry[i]))
        if (length(entry[i]) > longest) longest = length(entry[i])
    }
    other = number["z"] ? number["z"] : number["y"]
    x = number["x"]
    plane = other && high[other] - low[other] > 1e-9 * (high[x] - low[x])
    for (i = 1; i <= columns; i++) if (name[i] ~ /^v_[xyz]$/) { squares = squares (squares == "" ? "" : " + ") "$" i "**2"; of_speed = unit[i] == 1 ? "" : " [" plain(unit[i]) "]" }
    ratio = plane && high[x] > low[x] ? (high[other] - low[other]) / (high[x] - low[x]) : 1
    true = plane && ratio >= 0.15 && ratio <= 3
    size_panels(ratio)
    rows_of_page = plane && squares != "" ? 2 : 1
    pages()
}
