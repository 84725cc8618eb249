# A block at rest on a plate: its kinetic energy over m g h. With contact on both velocities of the leapfrog it stays at the waves of the loading for a minute; with contact on the new velocity
# alone the strain does not know the plate, and the block bursts after a second.
wide = 1300; high = 700
load 'common/style.gp'
file(name) = run.'/'.name.'/history.dat'
kinetic = col(file('both'), 'kinetic')
weight = 80 * 10 * 0.2
set title 'A block at rest on a plate, explicit'
set xlabel 't'; set ylabel 'kinetic energy / m g h'
set logscale y; set format y '10^{%T}'; set yrange [1e-12:1e-1]
set logscale x; set xrange [0.05:60]; set xtics ('0.1' 0.1, '1' 1, '10' 10, '60' 60)
set key at graph 0.98, 0.9 right
set arrow from 0.05, 1e-6 to 60, 1e-6 nohead lc rgb ink lw 1.5 dt 2
set label 'at rest: below' at 10, 2.6e-6
plot file('both') using 1:(column(kinetic) / weight) with lines lt 1 lw 1 title 'contact on v^0 and v^1', file('new') using 1:(column(kinetic) / weight) with lines lt 2 title 'on v^1 alone'
