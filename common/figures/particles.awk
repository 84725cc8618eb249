# particles.awk: the gnuplot commands of particles.gp, from what columns.awk says of the files, and the files; frames as in fields.awk.
FILENAME == "-" {
    name[$1] = $2
    number[$2] = $1
    columns = $1
    sub(/^[^ ]* [^ ]* /, "")
    unit[columns] = $0
    next
}
FNR == 1 { file[++files] = FILENAME; next }
$1 == "#" && $2 == "time" { time[files] = $3; next }
$1 + 0 == $1 {
    for (i = 1; i <= NF; i++) {
        if (!(i in low) || $i < low[i]) low[i] = $i
        if (!(i in high) || $i > high[i]) high[i] = $i
    }
    count[files]++
    speed = 0
    for (i = 1; i <= NF; i++) if (name[i] ~ /^v_[xyz]$/) speed += $i * $i
    if (speed > fastest) fastest = speed
}
function plain(text) { gsub(/_/, "\\\\_", text); return text }
function label(i) { return plain(name[i]) (unit[i] == 1 ? "" : " [" plain(unit[i]) "]") }
function range(axis, i,    wide) {
    wide = high[i] > low[i] ? high[i] - low[i] : 1
    return sprintf("set %srange [%.9g:%.9g]; set %stics %g", axis, low[i] - 0.03 * wide, high[i] + 0.03 * wide, axis, nice(wide / 3))
}
function nice(step,    power) {
    power = 10 ^ int(log(step) / log(10) + (step < 1 ? -1 : 0))
    return (step / power < 2 ? 1 : step / power < 5 ? 2 : 5) * power
}

# One row of the page: the columns a and b, in the color of the group or, colored, of the speed.
function row(k, a, b, colored,    f, left, top) {
    top = high_of_page - 100 - (k - 1) * (height + 62)
    print range("x", a) "; " range("y", b)
    print "set size " (true ? "ratio -1" : "noratio")
    if (colored) printf "eval colors(viridis); set cbrange [0:%.9g]\n", sqrt(fastest)
    for (f = from; f <= to; f++) {
        left = 115 + (f - from) * (width + 25)
        printf "set lmargin at screen %.5f; set rmargin at screen %.5f; set tmargin at screen %.5f; set bmargin at screen %.5f\n", left / wide, (left + width) / wide, top / high_of_page, (top - height) / high_of_page
        print f == from ? "set ylabel '" label(b) "' offset 0.5, 0 font ',16'; set format y '%g'" : "unset ylabel; set format y ''"
        print k == rows ? "set xlabel '" label(a) "' offset 0, 0.4 font ',16'; set format x '%g'" : "unset xlabel; set format x ''"
        if (colored && f == to) printf "set colorbox user origin %.5f, %.5f size %.5f, %.5f; set cblabel 'speed%s' font ',16'; set format cb '%%.2g'\n", (left + width + 12) / wide, (top - height) / high_of_page, 14 / wide, height / high_of_page, of_speed
        else print "unset colorbox"
        printf "set title 'time %.5g'\n", time[f]
        size = count[f] > 5000 ? 0.15 : count[f] > 500 ? 0.4 : 1
        if (!count[f]) print "plot -1e30"
        else printf "plot '%s' using %d:%d:(%s) with points pt 7 ps %g lc %s\n", file[f], a, b, colored ? "sqrt(" squares ")" : group ? "color_of($" group ")" : "0x0072B2", size, colored ? "palette" : "rgb variable"
    }
}

END {
    group = number["species"] + number["material"] + number["grain"]
    other = number["z"] ? number["z"] : number["y"]
    plane = other && high[other] - low[other] > 1e-9 * (high[number["x"]] - low[number["x"]])
    for (i = 1; i <= columns; i++) if (name[i] ~ /^v_[xyz]$/) { squares = squares (squares == "" ? "" : " + ") "$" i "**2"; of_speed = unit[i] == 1 ? "" : " [" plain(unit[i]) "]" }
    x = number["x"]
    true = plane
    ratio = plane && high[x] > low[x] ? (high[other] - low[other]) / (high[x] - low[x]) : 1
    if (ratio < 0.15 || ratio > 3) true = 0
    width = true && ratio > 1.2 ? 330 / ratio + 60 : 360
    height = true ? width * ratio : 260
    if (height < 120) height = 120
    if (frames != "") { width *= 2; height *= 2 }
    rows = !plane ? 1 : squares == "" ? 1 : 2
    wide = 250 + (frames == "" ? files : 1) * (width + 25)
    if (wide < 700) wide = 700
    high_of_page = 150 + rows * (height + 62)
    from = 1; to = files
    if (frames == "") page()
    else for (from = to = 1; from <= files; from = ++to) {
        printf "out = '%s/%06d.png'\n", frames, from
        page()
    }
}

function page() {
    printf "wide = %d; high = %d; load 'common/style.gp'\n", wide, high_of_page
    print "set multiplot title heading noenhanced font ',24'; unset key; unset grid; set border 15; set tics front font ',14'; set title font ',16' offset 0, -0.5"
    print "color_of(n) = n < 0 ? 0x777777 : int(word('29362 13983232 40563 13400487 15113984 5682409 7829367 0', 1 + int(n) % 8))"
    if (plane) row(1, x, other, 0)
    if (plane && rows == 2) row(2, x, other, 1)
    if (!plane) row(1, x, number["v_x"] ? number["v_x"] : columns, 0)
    print "unset multiplot"
}
