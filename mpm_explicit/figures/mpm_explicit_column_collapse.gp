# A column of frictional disks collapses on a rough floor; the grains are colored by the height at which they started. Below: how far the front (all mass but one percent) has run, and the run-out
# against height over width of the column, with published fits for disks in two dimensions (Staron and Hinch 2005) and for sand, rice and sugar between plates (Lube and others 2005).
# fits: mpm_explicit|mpm_implicit theory.compare=collapse file:grains_*.dat file:summary.json
wide = 1500; high = 1320
load 'common/style.gp'
file = run.'/history.dat'; front = col(file, 'front')
files = system('ls "'.run.'"/grains_*.dat')
dt = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && n++ == 1 { print $1; exit }' '%s'", file))) / parameter('history_steps')
# A one before the digits keeps zeros in front from making the number octal.
when(n) = (real('1'.system(sprintf("basename '%s' .dat | tr -dc 0-9", word(files, n)))) - 1e6) * dt
# Of the column at the start: left and right end and top, with the radii of disks of density 1.
ends = system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && !$10 { r = sqrt($6 / 3.14159265); if (!n++ || $2 - r < a) a = $2 - r; if ($2 + r > b) b = $2 + r; if ($3 + r > c) c = $3 + r } END { print a, b, c }' '%s'", word(files, 1)))
low = real(word(ends, 1)); right = real(word(ends, 2)); H = real(word(ends, 3)); L_0 = right - low; a = H / L_0
unit = sqrt(H / abs(parameter('gravity_y')))
disks(a) = a < 2 ? 2.5 * a : 3.25 * a**0.7
experiments(a) = a < 2.3 ? 1.2 * a : 1.9 * a**(2.0 / 3)
array shown_[4] = [1, int(words(files) * 0.2 + 1), int(words(files) * 0.45 + 1), words(files)]
length_x = parameter('length_x')
set multiplot title sprintf('Collapse of a column of %.0f frictional disks', real(entry('performance.grains'))) font ',24'
set border 15; unset grid; unset key
set xrange [0:length_x / L_0]; set yrange [0:1.05 * a]; set xtics 1; set ytics 1
eval colors(viridis); set cbrange [0:1]; set cbtics 0.5
panel = 0.41; gap = 0.02; panel_height = panel * wide / high * 1.05 * H / length_x
do for [k = 1:4] {
    column_ = (k - 1) % 2; row = (k - 1) / 2
    left = 0.075 + column_ * (panel + gap); top = 0.885 - row * (panel_height + 0.055)
    set lmargin at screen left; set rmargin at screen left + panel
    set tmargin at screen top; set bmargin at screen top - panel_height
    set title sprintf('t = %.2g (H/g)^{1/2}', when(shown_[k]) / unit) offset 0, -0.7 font ',18'
    if (row == 1) { set xlabel 'x / L_0'; set format x '%g' } else { unset xlabel; set format x '' }
    if (column_ == 0) { set ylabel 'y / L_0' offset 0, 0; set format y '%g' } else { unset ylabel; set format y '' }
    if (k == 2) { set colorbox user origin left + panel + 0.012, top - panel_height size 0.01, panel_height; set label 82 'y(0) / H' at screen 0.995, top right offset 0, 1 } else { unset colorbox; unset label 82 }
    plot sprintf('< paste %s %s', word(files, 1), word(files, shown_[k])) using ($12 / L_0):($13 / L_0):(sqrt($16 / pi) / L_0):($3 / H) with circles fillstyle solid noborder lc palette
}
unset title; unset label 82; set border 3; set grid; set format '%g'
set bmargin at screen 0.085; set tmargin at screen top - panel_height - 0.115
set lmargin at screen 0.075; set rmargin at screen 0.075 + panel
set xlabel 't / (H/g)^{1/2}'; set ylabel '(L − L_0) / L_0'
set xrange [0:parameter('end') / unit]; set yrange [0:2.4 * disks(a)]; set xtics 1; set ytics 2
set key top left
plot file using ($1 / unit):((column(front) - right) / L_0) with lines lt 1 title 'front', disks(a) with lines lw 2 dt 2 lc rgb orange title 'disks', experiments(a) with lines lw 2 dt 2 lc rgb green title 'experiments'
set lmargin at screen 0.075 + panel + 0.09; set rmargin at screen 0.975
set xlabel 'H / L_0'; set ylabel '(L_∞ − L_0) / L_0'
set logscale xy; set xrange [0.3:20]; set yrange [0.3:40]; set xtics (0.5, 1, 2, 5, 10, 20); set ytics (0.5, 1, 2, 5, 10, 20, 40)
last = real(system(sprintf("LC_ALL=C awk 'END { print $%d }' '%s'", front, file)))
plot disks(x) with lines lw 2 dt 2 lc rgb orange title 'disks', experiments(x) with lines lw 2 dt 2 lc rgb green title 'experiments', \
     '+' using (a):((last - right) / L_0) every ::0::0 with points pt 7 ps 2 lc rgb blue title 'this run'
unset multiplot
