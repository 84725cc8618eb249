# A cylinder rolls down an incline of 30 degrees, on three meshes, in both programs. Left: acceleration over (2/3) g sin; center: velocity of the center across the plate over that along it, largest in the second half of the run;
# right: velocity of the center over that of the rim. The shaded windows are those of the results: 3 % at R = 4 h and falling with h/R, and 1 %.
wide = 1500; high = 620
load 'common/style.gp'
file(name) = run.'/'.name.'.dat'
set multiplot layout 1, 3 title 'A cylinder rolls down 30 degrees: radius R in cells of width h' font ',24'
set logscale x 2; set xrange [3.2:20]; set xtics (4, 8, 16); set xlabel "R/h" offset 0, 0.3
set style fill solid 0.15 noborder
set samples 100
set bmargin at screen 0.2; set tmargin at screen 0.78
set key bottom right
set title 'acceleration / (⅔ g sin 30°)'; set yrange [0.86:1.06]
plot '+' using 1:(1 - 0.12 / $1):(1 + 0.12 / $1) with filledcurves lc rgb ink title 'window', \
     1 with lines lw 2 dt 2 lc rgb ink notitle, \
     file('mpm_explicit') using 1:($2 / $3) with linespoints pt 7 ps 1.6 lc rgb blue title 'explicit', \
     file('mpm_implicit') using 1:($2 / $3) with linespoints pt 5 ps 1.6 lc rgb orange title 'implicit'
unset key
set title 'largest |v_y| / v_x'; set logscale y; set yrange [1e-3:1]; set ytics format '10^{%L}'
plot '+' using 1:(1e-3):(0.01) with filledcurves lc rgb ink notitle, \
     file('mpm_explicit') using 1:4 with linespoints pt 7 ps 1.6 lc rgb blue notitle, \
     file('mpm_implicit') using 1:4 with linespoints pt 5 ps 1.6 lc rgb orange notitle
unset logscale y
set title 'v_x / {/Symbol w}R'; set yrange [0.9:1.15]; set ytics format '%g'
plot '+' using 1:(0.99):(1.01) with filledcurves lc rgb ink notitle, \
     1 with lines lw 2 dt 2 lc rgb ink notitle, \
     file('mpm_explicit') using 1:5 with linespoints pt 7 ps 1.6 lc rgb blue notitle, \
     file('mpm_implicit') using 1:5 with linespoints pt 5 ps 1.6 lc rgb orange notitle
unset multiplot
