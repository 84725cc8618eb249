# fields.awk: the gnuplot commands of fields.gp, from what columns.awk says of the files, and the files. quantities: only these columns, 'J_y E_x'. frames: a folder in which each
# file gets a picture of its own, 000001.png ..., all of the same size and colors.
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
        if ($i + 0 != $i || $i == "nan" || $i == "NaN" || $i == "-nan") continue
        if (!(i in low) || $i < low[i]) low[i] = $i
        if (!(i in high) || $i > high[i]) high[i] = $i
    }
}
function plain(text) { gsub(/_/, "\\\\_", text); return text }
function label(i) { return plain(name[i]) (unit[i] == 1 ? "" : " [" plain(unit[i]) "]") }

# More than round-off.
function varies(i) { return high[i] - low[i] > 1e-6 * (high[i] > -low[i] ? high[i] : -low[i]) }
function wanted(i) { return quantities == "" || index(" " quantities " ", " " name[i] " ") }

function lines(along, first,    i, k, f, rows) {
    for (i = first; i <= columns; i++) if (varies(i) && wanted(i)) varying[++rows] = i
    if (!rows) varying[++rows] = first
    printf("panels = %d; load 'common/figures/panels.gp'; set xlabel '%s'; set xrange [%.9g:%.9g]\n", rows > 12 ? 12 : rows, label(along), low[along], high[along])
    for (k = 1; k <= rows && k <= 12; k++) {
        i = varying[k]
        printf "set title '%s'; set yrange [%.9g:%.9g]; set key %s title 'time'\n", label(i), low[i] - 0.05 * (high[i] - low[i]) - !varies(i), high[i] + 0.4 * (high[i] - low[i]) + !varies(i), k == 1 ? "on" : "off"
        for (f = from; f <= to; f++) printf "%s'%s' using %d:%d with lines lt %d title '%s'", f == from ? "plot " : ", ", file[f], along, i, f - from + 1, time[f] == "" ? "" : sprintf("%.5g", time[f])
        print ""
    }
    print "unset multiplot"
}

function images(    i, k, fringe, f, rows, ratio, width, height, wide, high_of_page, size, top) {
    for (i = 3; i <= columns; i++) if (varies(i) && name[i] != "grain" && wanted(i)) varying[++rows] = i
    if (rows > 12) rows = 12
    ratio = (high[2] - low[2]) / (high[1] - low[1])
    # True proportions where both are lengths and the page can hold them.
    true = unit[1] == unit[2] && ratio > 0.15 && ratio < 3
    width = true && ratio > 1.2 ? 330 / ratio + 60 : 360
    height = true ? width * ratio : 260
    if (height < 120) height = 120
    if (frames != "") { width *= 2; height *= 2 }
    wide = 285 + (to - from + 1) * (width + 25); if (wide < 700) wide = 700
    high_of_page = 150 + rows * (height + 62)
    printf "wide = %d; high = %d; load 'common/style.gp'\n", wide, high_of_page
    print "set multiplot title heading noenhanced font ',24'; unset key; unset grid; set border 15; set tics front font ',14'; set title font ',16' offset 0, -0.5"
    printf "set size %s; set xrange [%.9g:%.9g]; set yrange [%.9g:%.9g]\n", true ? "ratio -1" : "noratio", low[1], high[1], low[2], high[2]
    printf "set xtics %s; set ytics %s\n", nice((high[1] - low[1]) / 3), nice((high[2] - low[2]) / 3)
    for (k = 1; k <= rows; k++) {
        i = varying[k]
        top = high_of_page - 100 - (k - 1) * (height + 62)
        size = high[i] > -low[i] ? high[i] : -low[i]
        fringe = kind == "fringes" && name[i] == "stress_difference" ? high[i] / 6 : 0
        if (fringe) print "set palette gray; set cbrange [0:1]"
        else if (low[i] < 0 && high[i] > 0 && (high[i] < -low[i] ? high[i] : -low[i]) > 0.05 * size) printf "eval signed(%.9g)\n", size
        else printf "eval colors(%s); set cbrange [%.9g:%.9g]\n", kind == "phase" ? "inferno" : "viridis", low[i], high[i]
        for (f = from; f <= to; f++) {
            # Field lines over the current.
            if (name[i] == "J_y" && number["A_y"]) printf "set format '%%g'; eval contours_of('%s', '1:2:%d', 'levels 20', '$lines')\n", file[f], number["A_y"]
            left = 105 + (f - from) * (width + 25)
            printf "set lmargin at screen %.5f; set rmargin at screen %.5f; set tmargin at screen %.5f; set bmargin at screen %.5f\n", left / wide, (left + width) / wide, top / high_of_page, (top - height) / high_of_page
            if (f == from) printf "set ylabel '%s' offset 0.5, 0 font ',16'; set format y '%%g'\n", label(2)
            else print "unset ylabel; set format y ''"
            if (k == rows) printf "set xlabel '%s' offset 0, 0.4 font ',16'; set format x '%%g'\n", label(1)
            else print "unset xlabel; set format x ''"
            if (f == to) printf "set colorbox user origin %.5f, %.5f size %.5f, %.5f; set cbtics autofreq; set cblabel '%s' font ',16'; set format cb '%%.2g'\n", (left + width + 12) / wide, (top - height) / high_of_page, 14 / wide, height / high_of_page, label(i)
            else print "unset colorbox"
            printf "set title '%s'\n", time[f] == "" ? plain(name[i]) : plain(name[i]) sprintf(", time %.5g", time[f])
            # Grains as in a polariscope: dark where the stress difference is 0, 1, 2 ... fringes.
            if (fringe) printf "set cblabel 'polarized light, a fringe is %.3g'; plot '%s' using 1:2:(sin(pi * $%d / %g)**2) with image\n", fringe, file[f], i, fringe
            else printf "plot '%s' using 1:2:%d with image%s\n", file[f], i, name[i] == "J_y" && number["A_y"] ? ", $lines using 1:2 @contours" : ""
        }
    }
    print "unset multiplot"
}

function nice(step,    power) {
    power = 10 ^ int(log(step) / log(10) + (step < 1 ? -1 : 0))
    return (step / power < 2 ? 1 : step / power < 5 ? 2 : 5) * power
}

function page() {
    if (!plane) lines(1, 2)
    else if (low[2] == high[2]) lines(1, 3)
    else if (low[1] == high[1] || kind == "profile") lines(2, 3)
    else images()
}

END {
    plane = kind != "velocities" && (kind != "fields" || name[2] == "z" || name[2] == "y")
    from = 1; to = files
    if (frames == "") page()
    else for (from = to = 1; from <= files; from = ++to) {
        printf "out = '%s/%06d.png'\n", frames, from
        page()
    }
}
