# sweep.awk: the gnuplot commands of sweep.gp from the table of sweep.sh.
NR == 1 {
    columns = NF
    for (i = 1; i <= NF; i++) name[i] = $i
    for (keys = 0; name[keys + 3] != name[keys + 1] "_expected" && keys < NF; ) keys++
    next
}
{
    rows++
    for (i = 1; i <= columns; i++) cell[rows, i] = $i
    for (k = 1; k <= keys; k++) {
        if (!((k, $k) in seen)) { seen[k, $k] = ++different[k]; value[k, different[k]] = $k }
        if ($k + 0 != $k) words[k] = 1
    }
}
function plain(text) { gsub(/_/, "\\\\_", text); return text }
function x_of(row) { return words[along] ? seen[along, cell[row, along]] : cell[row, along] }

END {
    # Along: the first key that varies and is no seed; the others but seeds make groups.
    for (k = 1; k <= keys; k++) {
        seed[k] = name[k] ~ /(^|\.)seed$/ && different[k] > 1
        if (!along && different[k] > 1 && !seed[k]) along = k
    }
    if (!along) for (k = 1; k <= keys && !along; k++) if (different[k] > 1) { along = k; seed[k] = 0 }
    if (!along) along = 1
    # Along it, numbers in their order.
    if (!words[along]) for (k = 2; k <= different[along]; k++)
        for (j = k; j > 1 && value[along, j - 1] + 0 > value[along, j] + 0; j--) { x = value[along, j]; value[along, j] = value[along, j - 1]; value[along, j - 1] = x }
    for (row = 1; row <= rows; row++) {
        g = ""
        for (k = 1; k <= keys; k++) if (k != along && !seed[k] && different[k] > 1) g = g (g == "" ? "" : ", ") name[k] " = " cell[row, k]
        if (!(g in number)) { number[g] = ++groups; group[groups] = g }
        of[row] = number[g]
    }
    least = 1e300; most = -1e300
    for (row = 1; row <= rows; row++) { x = x_of(row) + 0; if (x < least) least = x; if (x > most) most = x }
    # Values that grow in proportion want a logarithmic axis.
    logarithmic = !words[along] && least > 0 && most > 8 * least
    for (i = keys + 1; i <= columns; i += 4) {
        varies = 0
        for (row = 1; row <= rows; row++) if (cell[row, i] != "-" && cell[row, i] + 0 != cell[1, i] + 0) varies = 1
        if (varies || cell[1, i + 2] + 0 == cell[1, i + 2]) panel[++panels] = i
    }
    if (panels > 12) panels = 12
    if (!panels) panel[++panels] = keys + 1
    title = FILENAME
    sub(/\/results.dat$/, "", title)
    printf "heading = '%s'; panels = %d; load 'common/figures/panels.gp'; set xlabel '%s'; set key maxrows 6; set format y '%%g'\n", title, panels, plain(name[along])
    if (logarithmic) printf "set logscale x; set xrange [%.6g:%.6g]\n", least / 1.3, most * 1.3
    else printf "set xrange [%.9g:%.9g]\n", least - 0.08 * (most - least) - (most == least), most + 0.08 * (most - least) + (most == least)
    if (words[along] || (different[along] < 9 && logarithmic)) {
        printf "set xtics ("
        for (k = 1; k <= different[along]; k++) printf("%s'%s' %s", k > 1 ? ", " : "", value[along, k], words[along] ? k : value[along, k])
        print ")"
    }
    for (p = 1; p <= panels; p++) {
        i = panel[p]
        low = 1e300; high = -1e300; passed = judged = 0
        for (row = 1; row <= rows; row++) { judged += cell[row, i + 3] != "-"; passed += cell[row, i + 3] == "PASS" }
        for (g = 1; g <= groups; g++) {
            # Mean and spread of the runs that differ in their seeds only; of one run its own error.
            printf "$r%dg%d << EOD\n", p, g
            for (k = 1; k <= different[along]; k++) {
                n = sum = squares = error = short = 0
                expected = "NaN"
                for (row = 1; row <= rows; row++) {
                    if (of[row] != g || cell[row, along] != value[along, k] || cell[row, i] + 0 != cell[row, i]) continue
                    n++; sum += cell[row, i]; squares += cell[row, i] ^ 2
                    x = x_of(row)
                    short += cell[row, i + 3] !~ /^(PASS|-)$/
                    if (cell[row, i + 1] != "-") error = cell[row, i + 1]
                    if (cell[row, i + 2] != "-") { expected = cell[row, i + 2]; sub(/^[<>]/, "", expected) }
                }
                if (!n) continue
                filled[p, g] = 1
                if (short) has_short[p, g] = 1
                mean = sum / n
                if (n > 1) { error = squares / n - mean ^ 2; error = error > 0 ? sqrt(error * n / (n - 1)) : 0 }
                printf "%s %.9g %.9g %s %s\n", x, mean, error, expected, short ? mean : "NaN"
                if (mean - error < low) low = mean - error
                if (mean + error > high) high = mean + error
                if (expected != "NaN" && expected + 0 < low) low = expected + 0
                if (expected != "NaN" && expected + 0 > high) high = expected + 0
                if (expected != "NaN") has_expected[p, g] = 1
            }
            print "EOD"
        }
        if (low > high) { low = 0; high = 1 }
        margin = 0.1 * (high - low)
        if (margin <= 1e-9 * (high < 0 ? -high : high)) margin = high != 0 ? 0.1 * (high < 0 ? -high : high) : 1
        printf "set title '%s'; set yrange [%.9g:%.9g]\n", plain(name[i]) (judged ? ", " passed " of " judged " PASS" : ""), low - margin, high + (groups > 1 && p == 1 ? 4 : 1) * margin
        print (p == 1 && groups > 1 ? "set key on" : "unset key")
        # Only what has points: of an empty block gnuplot complains.
        printf "plot -1e300 notitle"
        for (g = 1; g <= groups; g++) {
            if (!filled[p, g]) printf ", -1e300 with lines lt %d title '%s'", g, plain(group[g])
            else printf ", $r%dg%d using 1:2:3 with yerrorlines lt %d ps 1.3 title '%s'", p, g, g, plain(group[g])
            if (has_short[p, g]) printf ", $r%dg%d using 1:5 with points pt 6 ps 3 lw 3 lc rgb orange notitle", p, g
            if (has_expected[p, g]) printf ", $r%dg%d using 1:4 with lines dt 2 lw 2 lc rgb ink notitle", p, g
        }
        print ""
    }
    print "unset multiplot"
}
