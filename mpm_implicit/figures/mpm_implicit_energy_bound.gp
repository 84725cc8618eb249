# The energy theorem as one picture: energy of five disks that fly about in a closed box and hit each other and the walls. Implicit with a CFL number of 1, it stays for theta = 1/2 and the consistent mass matrix, and
# else falls, by what theorem [MPM-13] counts. Explicit, nothing bounds it: with 0.25 it wanders, with 0.9 and 1.0 it grows,
# in some runs until a grain bursts (cross).
wide = 1500; high = 900
load 'common/style.gp'
folder = run
theta(t, m) = folder.'/theta_'.t.'_'.m.'/history.dat'
leap(a) = folder.'/explicit_'.a.'/history.dat'
energy = col(theta('0.5', 'consistent'), 'energy'); energy_leap = col(leap('0.25'), 'energy')
E_0 = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", energy, theta('0.5', 'consistent'))))
last(file, what) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { v = $%d } END { print v }' '%s'", what, file)))
set multiplot title 'Energy of disks in a closed box / initial: implicit, α = 1, and explicit (cross: burst)' font ',24'
set lmargin at screen 0.075; set rmargin at screen 0.735
set tmargin at screen 0.9; set bmargin at screen 0.115
set logscale y; set yrange [0.05:50]; set ytics (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
set xrange [0:20]; set xtics 5; set xlabel 't'
set key at screen 0.745, 0.91 left top Left reverse
burst(a) = last(leap(a), 1) < 19.9 ? last(leap(a), 1) : NaN
set object 1 rectangle from 0, 0.05 to 20, 1 behind fillcolor rgb '#eef4f8' fillstyle solid noborder
set label 1 'allowed by the theorem' at 19.7, 0.84 right textcolor rgb blue
plot leap('1') using 1:(column(energy_leap) / E_0) with lines lc rgb orange dt 2 title 'explicit, α = 1.0', \
     '+' using (burst('1')):(last(leap('1'), energy_leap) / E_0) every ::0::0 with points pt 2 ps 2.2 lw 3 lc rgb orange notitle, \
     '+' using (burst('0.9')):(last(leap('0.9'), energy_leap) / E_0) every ::0::0 with points pt 2 ps 2.2 lw 3 lc rgb pink notitle, \
     leap('0.9') using 1:(column(energy_leap) / E_0) with lines lc rgb pink dt 2 title 'explicit, α = 0.9', \
     leap('0.25') using 1:(column(energy_leap) / E_0) with lines lc rgb amber dt 2 title 'explicit, α = 0.25', \
     theta('0.5', 'consistent') using 1:(column(energy) / E_0) with lines lc rgb blue lw 4 title 'θ = 1/2', \
     theta('0.5', 'lumped') using 1:(column(energy) / E_0) with lines lc rgb blue lw 1.6 dt 3 title 'θ = 1/2, lumped', \
     theta('0.6', 'consistent') using 1:(column(energy) / E_0) with lines lc rgb green title 'θ = 0.6', \
     theta('0.6', 'lumped') using 1:(column(energy) / E_0) with lines lc rgb green lw 1.6 dt 3 title 'θ = 0.6, lumped', \
     theta('1', 'consistent') using 1:(column(energy) / E_0) with lines lc rgb 'black' title 'θ = 1', \
     theta('1', 'lumped') using 1:(column(energy) / E_0) with lines lc rgb 'black' lw 1.6 dt 3 title 'θ = 1, lumped'
unset object 1; unset label 1; unset logscale y; unset xlabel; unset key
set lmargin at screen 0.805; set rmargin at screen 0.975
set tmargin at screen 0.39; set bmargin at screen 0.115
set title 'enlarged' offset 0, -0.7
set yrange [0.9:1.1]; set ytics 0.05 font ',17'; set xtics 10 font ',17'
plot leap('0.25') using 1:(column(energy_leap) / E_0) with lines lc rgb amber, theta('0.5', 'consistent') using 1:(column(energy) / E_0) with lines lc rgb blue lw 4
unset multiplot
