# Results of a run against what is expected: how far each is from it, in tolerances, with its error bar; in the shaded strip it passes. Bounds, and results of which nothing is
# expected, stand with their numbers only.
# fits: any file:summary.json
table = sprintf("awk -f common/json_lines.awk '%s/summary.json' | awk -f common/figures/results.awk", run)
count = int(system(table." | wc -l")) - 1
nothing = count < 1
if (nothing) { count = 1 }
wide = 1500; high = 190 + 34 * count
heading = run.': results'
load 'common/style.gp'
set label 1 heading noenhanced at screen 0.5, screen 1 - 30.0 / high center font ',22'
set lmargin at screen 0.22; set rmargin at screen 0.48; set tmargin at screen 1 - 60.0 / high; set bmargin at screen 95.0 / high
set xrange [-2.5:2.5]; set yrange [count + 0.5:0.5]; unset ytics; set grid noytics; set border 1; unset key
set xlabel '(result − expected) / tolerance' font ',17' offset 0, 0.3; set xtics 1 font ',16'
set object 1 rectangle from -1, graph 0 to 1, graph 1 fillcolor rgb faint fillstyle solid noborder behind
set arrow 1 from 0, graph 0 to 0, graph 1 nohead lc rgb gray
# Names, numbers and verdicts beside the points.
load sprintf("< %s | awk -f common/figures/results_labels.awk", table)
within(d) = d > 2.4 ? 2.4 : d < -2.4 ? -2.4 : d
# What has no point stands outside of the frame; what lies beyond it is an arrowhead at its edge.
far(n) = strcol(5) eq '-' ? 99 : (column(2) - column(4)) / column(5)
off(n) = abs(far(0)) > 2.4 ? 99 : far(0)
edge(n) = strcol(5) ne '-' && abs(far(0)) > 2.4 ? within(far(0)) : 99
color(n) = strcol(6) eq 'PASS' ? 0x009E73 : 0xD55E00
bar(n) = strcol(3) eq '-' || strcol(5) eq '-' ? 0 : within(column(3) / column(5))
if (nothing) {
    set label 2 (entry('status') eq '0' ? 'the run is complete, and nothing of it is compared with theory' : 'no results yet') at screen 0.5, first 1 center
    unset object 1; unset arrow 1; unset border; unset xtics; unset xlabel
    plot NaN
} else {
    plot '< '.table skip 1 using (off(0)):($0 + 1):(bar(0)):(color(0)) with xerrorbars pt 7 ps 1.3 lw 2 lc rgb variable, \
         '' skip 1 using (edge(0)):($0 + 1):(far(0) < 0 ? '◀' : '▶'):(color(0)) with labels font ',17' tc rgb variable
}
