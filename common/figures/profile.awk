# profile.awk: the gnuplot commands of profile.gp, after tables.awk.
# Which column is the exact solution of column i: rho_exact of rho, v_exact of v_r.
function exact_of(i,    j, base) {
    for (j = 2; j <= columns; j++) {
        base = name[j]
        if (sub(/_exact$/, "", base) && (base == name[i] || index(name[i], base "_") == 1 && name[i] !~ /_exact$/)) return j
    }
    return 0
}
function page(    i, k, e, top, bottom, panel, panels) {
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
END { pages() }
