# tables.awk: what fields.awk, particles.awk and profile.awk share. They read from columns.awk (-) what the columns of the files are, and then the files. frames: a folder in which each file gets a
# picture of its own, 000001.png ..., all of the same size and colors.
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
    rows++
    for (i = 1; i <= NF; i++) {
        if ($i + 0 != $i || $i ~ /nan/) continue
        if (!(i in low) || $i < low[i]) low[i] = $i
        if (!(i in high) || $i > high[i]) high[i] = $i
    }
}
function plain(text) { gsub(/_/, "\\\\_", text); return text }
function label(i) { return plain(name[i]) (unit[i] == 1 ? "" : " [" plain(unit[i]) "]") }
function nice(step,    power) {
    power = 10 ^ int(log(step) / log(10) + (step < 1 ? -1 : 0))
    return (step / power < 2 ? 1 : step / power < 5 ? 2 : 5) * power
}

# Size of a panel; of one in true proportions, high over wide.
function size_panels(ratio) {
    width = true && ratio > 1.2 ? 330 / ratio + 60 : 360
    height = true ? width * ratio : 260
    if (height < 120) height = 120
    if (frames != "") { width *= 2; height *= 2 }
}
function begin_page(margin, panels, rows) {
    wide = margin + panels * (width + 25); if (wide < 700) wide = 700
    high_of_page = 150 + rows * (height + 62)
    printf "wide = %d; high = %d; load 'common/style.gp'\n", wide, high_of_page
    print "set multiplot title heading noenhanced font ',24'; unset key; unset grid; set border 15; set tics front font ',14'; set title font ',16' offset 0, -0.5"
    print "set size " (true ? "ratio -1" : "noratio")
}
# The place of panel f in row k, its axes, the columns a and b, and, beside the last, a box of colors from least to most with its label.
function begin_panel(f, k, rows, a, b, box, least, most,    left, top) {
    left = 115 + (f - from) * (width + 25)
    top = high_of_page - 100 - (k - 1) * (height + 62)
    printf "set lmargin at screen %.5f; set rmargin at screen %.5f; set tmargin at screen %.5f; set bmargin at screen %.5f\n", left / wide, (left + width) / wide, top / high_of_page, (top - height) / high_of_page
    print f == from ? "set ylabel '" label(b) "' offset 1, 0 font ',16'; set format y '%g'" : "unset ylabel; set format y ''"
    print k == rows ? "set xlabel '" label(a) "' offset 0, 0.4 font ',16'; set format x '%g'" : "unset xlabel; set format x ''"
    if (box != "" && f == to) printf "set colorbox user origin %.5f, %.5f size %.5f, %.5f; set cbtics %g; set cblabel '%s' font ',%d'; set format cb '%%g'\n", (left + width + 12) / wide, (top - height) / high_of_page, 14 / wide, height / high_of_page, nice((most - least) * 60 / height), box, length(box) * 9 < height ? 16 : 12
    else print "unset colorbox"
}
# page() of all files, or of each.
function pages() {
    from = 1; to = files
    if (frames == "") page()
    else for (from = to = 1; from <= files; from = ++to) {
        printf "out = '%s/%06d.png'\n", frames, from
        page()
    }
}
