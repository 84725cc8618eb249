# Plates that move as they are told. Left: stress of a plate that goes down and up against the strain of the block below it; dashed: elastic, and perfectly plastic without widening, which keeps (4/3) Y (range - Y/G)
# per cycle and volume. Right: a plate that stops, smoothly, at t = 3: the kinetic energy of the block over its elastic energy. With contact on both velocities of the leapfrog it is at rest; with contact on the new one alone it bursts.
wide = 1500; high = 720
load 'common/style.gp'
file(name) = run.'/'.name.'/history.dat'
E = 1e5; nu = 0.3; Y = 100; height = 0.4; low = 0.002; high_e = 0.007
G = E / (2 * (1 + nu)); K = E / (3 * (1 - 2 * nu)); M = K + 4 * G / 3
force = col(file('yields'), 'force_y_top'); way = col(file('yields'), 'travel_y_top')
set multiplot title 'A block below a plate, explicit' font ',24'
set tmargin at screen 0.87; set bmargin at screen 0.15
set lmargin at screen 0.085; set rmargin at screen 0.465
set key top left
set xlabel 'strain [%]'; set ylabel 'stress / Y'
set xrange [0:0.75]; set yrange [0:10]
up = high_e - Y / G; down = low + Y / G
set samples 1000
plot file('elastic') using (-100 * column(way) / height):(column(force) / Y) with lines lt 2 title 'elastic', \
     file('yields') using (-100 * column(way) / height):(column(force) / Y) with lines lt 1 title 'yields at Y', \
     M * x / 100 / Y with lines lc rgb ink lw 1.5 dt 2 title 'theory', \
     (x >= 100 * down && x <= 100 * high_e ? (K * x / 100 + 2 * Y / 3) / Y : NaN) with lines lc rgb ink lw 1.5 dt 2 notitle, \
     (x >= 100 * up && x <= 100 * high_e ? (K * high_e + 2 * Y / 3 - M * (high_e - x / 100)) / Y : NaN) with lines lc rgb ink lw 1.5 dt 2 notitle, \
     (x >= 100 * low && x <= 100 * up ? (K * x / 100 - 2 * Y / 3) / Y : NaN) with lines lc rgb ink lw 1.5 dt 2 notitle, \
     (x >= 100 * low && x <= 100 * down ? (K * low - 2 * Y / 3 + M * (x / 100 - low)) / Y : NaN) with lines lc rgb ink lw 1.5 dt 2 notitle
kinetic = col(file('both'), 'kinetic'); elastic = col(file('both'), 'elastic')
set lmargin at screen 0.6; set rmargin at screen 0.97
set xlabel 't'; set ylabel 'kinetic / elastic energy'
set xrange [0:15]; set logscale y; set format y '10^{%T}'; set yrange [1e-9:10]; set ytics 100; set mytics 1
set key at graph 1.04, 0.98 right top samplen 1.5
set arrow from 0, 1e-6 to 15, 1e-6 nohead lc rgb ink lw 1.5 dt 2
set label 'at rest: below' at 10, 2.6e-6
plot file('both') using 1:(column(kinetic) / column(elastic)) with lines lt 1 title 'contact on v^0 and v^1', file('new') using 1:(column(kinetic) / column(elastic)) with lines lt 2 title 'on v^1 alone'
unset multiplot
