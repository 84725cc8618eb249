# Viscous flow in a square cavity under a lid that slides, Reynolds number 100, Mach 0.05. Left, speed and direction of the flow after twelve passages of the lid, and the center
# of the vortex by Ghia, Ghia and Shin (1982). Right, velocities of the run's cells on both middle lines, and their points.
# fits: flip theory.compare=cavity file:fields_*.dat file:profile.dat file:summary.json
wide = 1500; high = 720
load 'common/style.gp'
last = system(sprintf("ls '%s'/fields_*.dat | tail -n 1", run))
vx = col(last, 'v_x'); vz = col(last, 'v_z'); n = parameter('cells_x')
speed(u, v) = sqrt(u**2 + v**2)
set multiplot title 'Cavity under a sliding lid, Re = 100' font ',24'
eval colors(viridis); set cbrange [0:1]; set cbtics 1
set border 15; set tics front; unset grid; unset key; set size ratio -1
set xrange [0:1]; set yrange [0:1]; set xtics 0.5; set ytics 0.5; set xlabel 'x / L'; set ylabel 'z / L' offset 0.5, 0
side = 0.33
set lmargin at screen 0.085; set rmargin at screen 0.085 + side; set bmargin at screen 0.15; set tmargin at screen 0.15 + side * wide / high
set colorbox user origin 0.428, 0.15 size 0.012, side * wide / high
set label 10 'circle: center of the vortex by Ghia et al.' at 0.5, 0.1 center front textcolor rgb orange font ',17'
set label 9 '|v| / U' at screen 0.48, 0.15 + side * wide / high right offset 0, 1
even(x) = int(x * n) % 2 == 0
reach = 0.045
plot last using 1:2:(speed(column(vx), column(vz))) with image, \
     last skip 1 using (even($1) && even($2) ? $1 : NaN):2:(reach * column(vx) / speed(column(vx), column(vz))**0.5):(reach * column(vz) / speed(column(vx), column(vz))**0.5) with vectors head size 0.01, 20 lw 1.2 lc rgb '#40ffffff', \
     '+' using (0.6172):(0.7344) every ::0::0 with points pt 6 ps 2.2 lw 2.5 lc rgb orange
unset label 9; unset label 10; unset colorbox; set border 3; set grid; set size noratio
set tmargin at screen 0.84
profile = run.'/profile.dat'
# The mean of the two columns, and of the two rows, of cells beside the middle.
line(across, along, c) = sprintf("< LC_ALL=C awk '$1 + 0 == $1 && ($%d - 0.5)^2 * %d < 0.6 { sum[$%d] += $%d; count[$%d]++ } END { for (s in sum) print s, sum[s] / count[s] }' '%s' | LC_ALL=C sort -g", across, n * n, along, c, along, last)
set lmargin at screen 0.58; set rmargin at screen 0.745
set xrange [-0.3:1]; set yrange [0:1]; set xtics 0.5; set ytics 0.25
set xlabel 'v_x / U on x = L/2'; set ylabel 'z / L' offset 1, 0
plot line(1, 2, vx) using 2:1 with lines lt 1, profile using 2:1 @published
set lmargin at screen 0.835; set rmargin at screen 0.98
set xrange [0:1]; set yrange [-0.3:0.25]; set ytics 0.1
set xlabel 'x / L'; set ylabel 'v_z / U on z = L/2' offset 1, 0
set key at graph 1.06, 1 samplen 1 width -2 font ',17'
plot line(2, 1, vz) using 1:2 with lines lt 1 title 'flip', profile using 4:5 @published title 'Ghia et al.'
unset multiplot
