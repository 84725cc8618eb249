# history.awk: gnuplot commands for the panels of history.gp, from what columns.awk says of a history, and the history:
#   awk -f common/columns.awk HISTORY | awk -v theory="RATE BEGIN END" -f common/figures/history.awk - HISTORY
# Panels: the energies; what should be 0 and the amplitudes of modes, on a logarithmic scale; all else, one panel for each unit, at most nine. A column that is
# always 0 is not drawn, and of many in a panel the largest. theory: growth of the column mode by theory, and the times where it was measured.
# A second history after the first is drawn dashed, where it has the same columns.
# The start of a wave that grows may be above what grows: its line touches the later half.
BEGIN { split(theory, growth); if (growth[1] > 0) growth[2] = 0.5 * (growth[2] + growth[3]) }

FILENAME == "-" {
    name[$1] = $2
    columns = $1
    number[$2] = $1
    sub(/^[^ ]* [^ ]* /, "")
    unit[columns] = $0
    next
}
FNR == 1 {
    file[++files] = FILENAME
    for (i = 1; i <= NF; i++) place[files, $i] = i
    next
}
$1 + 0 == $1 {
    if (files == 2) {  # in the order of the first
        for (i = 2; i <= columns; i++) mine[i] = (2, name[i]) in place ? $place[2, name[i]] : ""
        for (i = 2; i <= columns; i++) $i = mine[i]
    }
    if (!rows++) begin = $1
    if ($1 > end) end = $1
    for (i = 2; i <= columns; i++) {
        if ($i + 0 != $i) continue
        if (!(i in low) || $i < low[i]) low[i] = $i
        if (!(i in high) || $i > high[i]) high[i] = $i
        if ($i < 0 ? -$i > size[i] : $i > size[i]) size[i] = $i < 0 ? -$i : $i
    }
    if (files == 1 && growth[3] != "" && $1 >= growth[2] && $1 <= growth[3]) {
        re = $number["mode_re"]; im = $number["mode_im"]
        if (re || im) {
            above = 0.5 * log(re ^ 2 + im ^ 2) - growth[1] * $1
            if (!heights++ || above > height) height = above
        }
    }
}

# The panel of column i.
function panel_of(i,    other) {
    other = name[i]
    if (other == "dt" || other ~ /^time_|_im$/) return ""
    if (sub(/_re$/, "_im", other) && other in number) {
        partner[i] = number[other]
        if (size[partner[i]] > size[i]) size[i] = size[partner[i]]
        return "modes"
    }
    # Walls that absorb and emit, and batteries that hold a wall at its potential, change the energy.
    if (name[i] == "energy_drift" && open_ended) return ""
    if (name[i] ~ /(_error|_drift|_residual|_change)$|^div_|^residual$|^budget$/) return "zero"
    return "energy" in number && unit[i] == unit[number["energy"]] ? "energy" : unit[i]
}

# A text with _ as it is, not as a subscript.
function plain(text) { gsub(/_/, "\\\\_", text); return text }

# The clause of a plot command for column i of history f.
function curve(f, i, p, style,    a, b) {
    a = "$" place[f, name[i]]
    if (partner[i]) b = "$" place[f, name[partner[i]]]
    return "'" file[f] "' every " 1 + int(rows / 6000) " using 1:(" (partner[i] ? "sqrt(" a "**2 + " b "**2)" : p == "zero" ? "abs(" a ")" : a) ") with lines " style
}

function draw(p,    of, n, i, k, hidden, top, bottom, long, least, title, label, y, commands) {
    n = split(members[p], of)
    for (k = 1; k <= n; k++) if (length(name[of[k]]) > 14) long = 1
    # Long names stand in one column of the key.
    for (; n > (long ? 4 : 8); n--) {
        k = 1
        for (i = 2; i <= n; i++) if (size[of[i]] < size[of[k]]) k = i
        for (i = k; i < n; i++) of[i] = of[i + 1]
        hidden++
    }
    top = -1e300; bottom = 1e300
    for (k = 1; k <= n; k++) {
        i = of[k]
        if (p == "modes" || p == "zero") {
            if (size[i] > top) top = size[i]
            if (!least || size[i] < least) least = size[i]
        } else if (high[i] > top) top = high[i]
        if (low[i] < bottom) bottom = low[i]
        label = name[i]
        if (partner[i]) sub(/_re$/, "", label)
        commands = commands (k == 1 ? "plot " : ", ") curve(1, i, p, "lt " k) " title '" plain(label) "'"
        if ((2, name[i]) in place) commands = commands ", " curve(2, i, p, "lt " k " lw 1.6 dt 2") " notitle"
    }
    # Below the key.
    if (p == "modes" && heights) commands = commands sprintf(", 1 / (exp(%.9g + %.9g * x) < %.9g) * exp(%.9g + %.9g * x) with lines lw 2 dt 2 lc rgb ink notitle", height, growth[1], 2 * top, height, growth[1])
    title = p == "energy" ? "energy" : p == "zero" ? "what should be 0" : p == "modes" ? "amplitudes of modes" : n == 1 ? name[of[1]] : p == 1 ? "numbers" : p
    if (p == "modes" && heights) title = "modes; dashed: theory, γ = " sprintf("%.4g", growth[1])
    if (hidden) title = title ", the largest " n " of " n + hidden
    print "set title '" plain(title) "' offset 0, -0.4"
    print "set ylabel '" (p == "zero" ? "absolute value" : p == 1 || title == p && p != "energy" ? "" : plain(unit[of[1]])) "' offset 1, 0"
    if (p == "modes" || p == "zero") {
        bottom = p == "modes" ? 1e-8 * top : 1e-4 * least
        if (bottom < 1e-300) bottom = 1e-300
        printf "set yrange [1:2]; set logscale y; set format y '10^{%%T}'; set yrange [%.3g:%.3g]\n", bottom, top * (top / bottom) ^ 0.4
    } else {
        y = top < 0 ? -bottom : top
        if (top - bottom <= 1e-6 * y) { y = y ? 0.1 * y : 1; top += y; bottom -= y }
        printf "unset logscale y; set format y '%%g'; set yrange [%.9g:%.9g]\n", bottom - 0.05 * (top - bottom), top + 0.5 * (top - bottom)
    }
    print commands
}

END {
    for (i = 2; i <= columns; i++) if (name[i] ~ /^count_/ && high[i] > low[i] || name[i] ~ /^potential_[xz]_/ && size[i]) open_ended = 1
    for (i = 2; i <= columns; i++) {
        if (!size[i] && name[i] != "energy" || (p = panel_of(i)) == "") continue
        if (!(p in members)) panel[++panels] = p
        members[p] = members[p] " " i
    }
    if (panels > 9) panels = 9
    if (end == begin) end = begin + 1
    printf "panels = %d; load 'common/figures/panels.gp'\n", panels
    printf "set xrange [%.9g:%.9g]; set xlabel '%s'\n", begin, end, plain("time [" unit[1] "]")
    for (k = 1; k <= panels; k++) draw(panel[k])
    print "if (exists('foot')) { load foot }; unset multiplot"
}
