# A disk of dust turns once, rigidly, in a harmonic trap on 64 x 64 cells. Left: the angular momentum that is left, in 483 steps (lines) and 2413 (dashes). Right: what one turn has lost, against the number of steps.
# Velocities that go to the mesh and come back are smoothed each time, so that the transfer of pic and its blends get worse with shorter steps. Harlow's pic loses as much with any step; flip and apic next to nothing.
wide = 1500; high = 820
load 'common/style.gp'
names = 'pic harlow blend xpic2 xpic5 flip apic'
titles = '"transfer of pic" "the program pic" "0.95 flip + 0.05 pic" "xpic of order 2" "xpic of order 5" "flip" "apic"'
tint = orange.' '.gray.' '.amber.' '.green.' '.sky.' '.blue.' '.pink
history(n, steps) = sprintf('%s/%s.%d/history.dat', run, word(names, n), steps)
L = col(history(1, 483), 'angular_momentum')
array start[7]
do for [n = 1:7] { start[n] = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", L, history(n, 483)))) }
set multiplot title 'A disk of dust that should turn for ever' font ',24'
set bmargin at screen 0.13; set tmargin at screen 0.89
set lmargin at screen 0.085; set rmargin at screen 0.47
set xrange [0:1]; set yrange [0:1.05]; set xtics 0.2; set ytics 0.2
set xlabel 'turns'; set ylabel 'angular momentum / its start' offset 0.8, 0
unset key
set label 1 "483 steps: lines\n2413 steps: dashes" at graph 0.97, 0.3 right textcolor rgb ink font ',17'
plot for [n = 1:7] history(n, 483) using ($1 / (2 * pi)):(column(L) / start[n]) with lines lw 3 lc rgb word(tint, n), \
     for [n = 1:7] history(n, 2413) using ($1 / (2 * pi)):(column(L) / start[n]) with lines lw 2 dt 2 lc rgb word(tint, n)
unset label 1
set lmargin at screen 0.58; set rmargin at screen 0.97
set logscale xy
set xrange [200:3000]; set xtics (241, 483, 1081, 2413)
set yrange [1e-6:1e3]; set ytics ('10^{-6}' 1e-6, '10^{-5}' 1e-5, '10^{-4}' 1e-4, '10^{-3}' 1e-3, '10^{-2}' 0.01, '10^{-1}' 0.1, '1' 1)
set xlabel 'steps per turn'; set ylabel 'lost in one turn'
set key at graph 1.02, 1.0 top right maxrows 4 width -3 samplen 1.2 font ',17'
plot for [n = 1:7] run.'/'.word(names, n).'.dat' using 1:(abs(1 - $2)) with linespoints lw 2.4 pt 7 ps 1.3 lc rgb word(tint, n) title word(titles, n)
unset multiplot
