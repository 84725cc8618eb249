# Gas that turns about an axis, its rings keeping their angular momentum. Left, an inertial wave in rigid rotation: it goes on for ever, and is gone in one period where particles take the velocity
# of the mesh. Middle, frequencies of columns of five heights, beside Kelvin's. Right, Rayleigh's criterion: where the angular momentum falls outward, the same wave grows.
wide = 1500; high = 640
load 'common/style.gp'
folder = run
highs = '0.5 0.75 1 1.5 2'
mode_of(name) = col(folder.'/'.name.'/history.dat', 'mode')
set multiplot title 'A column of gas that turns: inertial waves, and Rayleigh''s criterion' font ',24'
set bmargin at screen 0.16; set tmargin at screen 0.82
set lmargin at screen 0.07; set rmargin at screen 0.325
run = folder.'/high-1'; omega = result('theory_frequency')
m = mode_of('high-1'); first = real(system(sprintf("awk 'NR == 3 { print $%d }' '%s/history.dat'", m, run)))
set title 'rigid rotation' offset 0, -0.5
set xrange [0:15]; set yrange [-1.3:2.9]; set xtics 5; set ytics 1
set xlabel 't Ω'; set ylabel 'v_r / start' offset 1, 0
set key at graph 1.09, 1.03 top right samplen 1.5
plot folder.'/high-1/history.dat' using 1:(column(m) / first) every 10 with lines lt 1 title 'flip', \
     folder.'/pic/history.dat' using 1:(column(m) / first) every 10 with lines lt 3 title 'pic transfer', \
     [0:15] cos(omega * x) with lines lt 2 dt 2 title sprintf('theory, ω = %.3f Ω', omega)
set lmargin at screen 0.415; set rmargin at screen 0.645
set title 'columns of height H' offset 0, -0.5
set xrange [0:7]; set yrange [0:2]; set xtics 2; set ytics 0.5
set xlabel 'k R = π R / H'; set ylabel 'ω / Ω' offset 1, 0
set key at graph 0.98, 0.05 bottom right samplen 1.5
measured_frequency(n) = (run = folder.'/high-'.word(highs, n), result('theory_frequency') * result('frequency_over_theory'))
plot 2 * x / sqrt(x**2 + 3.8317**2) with lines lt 2 dt 2 title 'Kelvin 1880', \
     '+' using (pi / real(word(highs, int($0) + 1))):(measured_frequency(int($0) + 1)) every ::0::4 with points lt 1 pt 7 ps 1.5 title 'flip'
set lmargin at screen 0.745; set rmargin at screen 0.975
run = folder.'/falling'; rate = result('theory_growth'); m = mode_of('falling')
set title 'r v_θ falls outward' offset 0, -0.5
last = real(system(sprintf("awk 'END { print $%d * exp(-%.17g * $1) }' '%s/history.dat'", m, rate, run)))
set xrange [0:48]; set yrange [1e-5:1e-2]; set logscale y; set format y '10^{%T}'; set xtics 20; set ytics 10
set xlabel 't Ω_0'; set ylabel 'v_r / R Ω_0' offset 1, 0
set key at graph 0.03, 0.99 top left samplen 1.5
plot folder.'/falling/history.dat' using (2 * $1):(abs(column(m)) / 2) every 10 with lines lt 1 title 'flip', \
     [8:48] 0.5 * abs(last) * exp(0.5 * rate * x) with lines lt 2 dt 2 title sprintf('exp %.3f t Ω_0', 0.5 * rate)
unset multiplot
