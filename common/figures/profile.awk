# profile.awk: the gnuplot commands of profile.gp, from what columns.awk says of the file, and the file.
FILENAME == "-" {
    name[$1] = $2
    columns = $1
    sub(/^[^ ]* [^ ]* /, "")
    unit[columns] = $0
    next
}
$1 + 0 == $1 {
    rows++
    for (i = 1; i <= NF; i++) {
        if ($i + 0 != $i) continue
        if (!(i in low) || $i < low[i]) low[i] = $i
        if (!(i in high) || $i > high[i]) high[i] = $i
    }
}
function plain(text) { gsub(/_/, "\\\\_", text); return text }
function label(i) { return plain(name[i]) (unit[i] == 1 ? "" : " [" plain(unit[i]) "]") }
# Which column is the exact solution of column i: rho_exact of rho, v_exact of v_r.
function exact_of(i,    j, base) {
    for (j = 2; j <= columns; j++) {
        base = name[j]
        if (sub(/_exact$/, "", base) && (base == name[i] || index(name[i], base "_") == 1 && name[i] !~ /_exact$/)) return j
    }
    return 0
}
END {
    for (i = 2; i <= columns; i++) if (name[i] !~ /_exact$/) panel[++panels] = i
    printf("panels = %d; load 'common/figures/panels.gp'; set xlabel '%s'; set xrange [%.9g:%.9g]\n", panels, label(1), low[1], high[1] > low[1] ? high[1] : low[1] + 1)
    for (k = 1; k <= panels; k++) {
        i = panel[k]; e = exact_of(i)
        bottom = e && low[e] < low[i] ? low[e] : low[i]
        top = e && high[e] > high[i] ? high[e] : high[i]
        if (!(top - bottom > 1e-9 * (top < 0 ? -bottom : top))) { bottom -= 1; top += 1 }
        printf("set title '%s'; set yrange [%.9g:%.9g]; set key %s\n", label(i), bottom - 0.05 * (top - bottom), top + 0.2 * (top - bottom), k == 1 && e ? "on" : "off")
        printf("plot '%s' using 1:%d with points pt 7 ps %g title 'run'", FILENAME, i, rows > 300 ? 0.4 : 0.8)
        if (e) printf ", '%s' using 1:%d with lines lt 8 lw 2 title 'exact'", FILENAME, e
        print ""
    }
    print "unset multiplot"
}
