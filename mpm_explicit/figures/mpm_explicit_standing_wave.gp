# A compression wave that stands between rollers: root mean square error of the particles' velocities after a fixed time, over the wave's own, against the size of a cell. The slope is two for all shape
# functions. No particle leaves its cell here: the quadratic ones, which are wide, then only lose accuracy, and linear ones and gimp agree.
wide = 1100; high = 820
load 'common/style.gp'
set title 'Standing wave: error of the velocity' font ',24'
set logscale xy
set xrange [0.006:0.17]; set yrange [1e-4:0.3]
set xlabel 'h / L'; set ylabel 'rms error / rms velocity' offset 0.5, 0
set xtics ('1/8' 1./8, '1/16' 1./16, '1/32' 1./32, '1/64' 1./64, '1/128' 1./128); set format y '10^{%T}'
set key bottom right
file(shape) = run.'/'.shape.'.dat'
first = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $2; exit }' '%s'", file('linear'))))
plot 0.5 * first * (8 * x)**2 with lines lt 8 lw 2 dt 2 title 'slope 2', \
     file('quadratic') using (1 / $1):2 with linespoints lt 3 ps 2 title 'quadratic', \
     file('gimp') using (1 / $1):2 with linespoints lt 2 pt 6 ps 3 lw 2.4 title 'gimp', \
     file('linear') using (1 / $1):2 with linespoints lt 1 ps 1.6 title 'linear'
