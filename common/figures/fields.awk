# fields.awk: the gnuplot commands of fields.gp, after tables.awk. quantities: only these columns, 'J_y E_x'.
# More than round-off.
function varies(i) { return high[i] - low[i] > 1e-6 * (high[i] > -low[i] ? high[i] : -low[i]) }
function wanted(i) { return quantities == "" || index(" " quantities " ", " " name[i] " ") }

function lines(along, first,    i, k, f, rows) {
    for (i = first; i <= columns; i++) if (varies(i) && wanted(i)) varying[++rows] = i
    if (!rows) varying[++rows] = first
    printf("panels = %d; load 'common/figures/panels.gp'; set xlabel '%s'; set xrange [%.9g:%.9g]\n", rows > 12 ? 12 : rows, label(along), low[along], high[along])
    for (k = 1; k <= rows && k <= 12; k++) {
        i = varying[k]
        printf "set title '%s'; set yrange [%.9g:%.9g]; set key %s title 'time' font ',14'\n", label(i), low[i] - 0.05 * (high[i] - low[i]) - !varies(i), high[i] + (k == 1 ? 0.6 : 0.1) * (high[i] - low[i]) + !varies(i), k == 1 ? "on" : "off"
        for (f = from; f <= to; f++) printf "%s'%s' using %d:%d with lines lt %d title '%s'", f == from ? "plot " : ", ", file[f], along, i, f - from + 1, time[f] == "" ? "" : sprintf("%.5g", time[f])
        print ""
    }
    print "unset multiplot"
}

function images(    i, k, fringe, f, rows, ratio, size, least, most) {
    for (i = 3; i <= columns; i++) if (varies(i) && name[i] != "grain" && wanted(i)) varying[++rows] = i
    if (rows > 12) rows = 12
    ratio = (high[2] - low[2]) / (high[1] - low[1])
    # True proportions where both are lengths and the page can hold them.
    true = unit[1] == unit[2] && ratio > 0.15 && ratio < 3
    size_panels(ratio)
    begin_page(285, to - from + 1, rows)
    printf "set xrange [%.9g:%.9g]; set yrange [%.9g:%.9g]\n", low[1], high[1], low[2], high[2]
    printf "set xtics %s; set ytics %s\n", nice((high[1] - low[1]) / 3), nice((high[2] - low[2]) / 3)
    for (k = 1; k <= rows; k++) {
        i = varying[k]
        size = high[i] > -low[i] ? high[i] : -low[i]
        least = low[i]; most = high[i]
        fringe = kind == "fringes" && name[i] == "stress_difference" ? high[i] / 6.5 : 0
        if (fringe) { least = 0; most = 1; print "set palette gray; set cbrange [0:1]" }
        else if (low[i] < 0 && high[i] > 0 && (high[i] < -low[i] ? high[i] : -low[i]) > 0.05 * size) { least = -size; most = size; printf "eval signed(%.9g)\n", size }
        else printf "eval colors(%s); set cbrange [%.9g:%.9g]\n", kind == "phase" ? "inferno" : "viridis", low[i], high[i]
        for (f = from; f <= to; f++) {
            # Field lines over the current.
            if (name[i] == "J_y" && number["A_y"]) printf "eval contours_of('%s', '1:2:%d', 'levels 20', '$lines')\n", file[f], number["A_y"]
            begin_panel(f, k, rows, 1, 2, fringe ? sprintf("fringe: %.3g", fringe) : label(i), least, most)
            printf "set title '%s'\n", time[f] == "" ? plain(name[i]) : plain(name[i]) sprintf(", time %.5g", time[f])
            # Grains as in a polariscope: dark where the stress difference is 0, 1, 2 ... fringes.
            if (fringe) printf "plot '%s' using 1:2:(sin(pi * $%d / %g)**2) with image\n", file[f], i, fringe
            else printf "plot '%s' using 1:2:%d with image%s\n", file[f], i, name[i] == "J_y" && number["A_y"] ? ", $lines using 1:2 @contours" : ""
        }
    }
    print "unset multiplot"
}

function page() {
    if (!plane) lines(1, 2)
    else if (low[2] == high[2]) lines(1, 3)
    else if (low[1] == high[1] || kind == "profile") lines(2, 3)
    else images()
}

END {
    plane = kind != "velocities" && (kind != "fields" || name[2] == "z" || name[2] == "y")
    pages()
}
