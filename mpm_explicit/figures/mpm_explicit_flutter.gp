# A block slides down an incline of 30 degrees. Left and middle: the kinetic energy of its vibration. Without viscosity it grows as finite elements say (dotted: the first mode that grows,
# 2 x 23.1/s and 2 x 40.2/s; tests/support/sliding_modes.hpp) until contacts open; the lumped mass of the explicit program slows it by a quarter on this mesh. With viscosity it stays where the load and
# the crossing of cells put it. Right: what that does to friction.
wide = 1500; high = 640
load 'common/style.gp'
g = 10; angle = 30 * pi / 180
folder = run
file(scheme, viscosity, friction) = folder.'/'.scheme.'_'.viscosity.'_'.friction.'.dat'
set multiplot title 'Sliding with friction flutters; viscosity ends it' font ',24'
set bmargin at screen 0.16; set tmargin at screen 0.82
array left[2] = [0.085, 0.39]
set logscale y; set format y '10^{%L}'
set xrange [0:0.5]; set yrange [1e-8:1e3]; set xtics 0.1; set ytics 100; set mytics 1
set xlabel 't [s]'
unset key
set label 1 'μ = 0.55' at 0.495, 30 right textcolor rgb orange; set label 2 'μ = 0.3' at 0.495, 0.006 right textcolor rgb blue
set label 3 'β = 3 ms' at 0.495, 3e-8 right textcolor rgb ink; set label 4 'finite elements' at 0.015, 30 left textcolor rgb ink
do for [k = 1:2] {
    scheme = word('explicit implicit', k)
    set lmargin at screen left[k]; set rmargin at screen left[k] + 0.245
    set title (k == 1 ? 'explicit, α = 1/4' : 'implicit, θ = 1/2, α = 1/2') offset 0, -0.3
    set ylabel (k == 1 ? 'energy of vibration [J/m]' : '') offset 1, 0
    plot file(scheme, '0', '0.55') using 1:2 with lines lc rgb orange, \
         file(scheme, '0', '0.3') using 1:2 with lines lc rgb blue, \
         file(scheme, '3e-3', '0.55') using 1:2 with lines lc rgb orange dt 2, \
         file(scheme, '3e-3', '0.3') using 1:2 with lines lc rgb blue dt 2, \
         (x > 0.12 && x < 0.23 ? 3e-3 * exp(2 * 40.2 * (x - 0.15)) : NaN) with lines lw 2 dt 3 lc rgb ink, \
         (x > 0.12 && x < 0.33 ? 3e-4 * exp(2 * 23.1 * (x - 0.15)) : NaN) with lines lw 2 dt 3 lc rgb ink
}
unset logscale y; set format y '%g'; set mytics default
unset label 1; unset label 2; unset label 3; unset label 4
set lmargin at screen 0.725; set rmargin at screen 0.985
set title 'acceleration' offset 0, -0.3
set xlabel 'μ'; set ylabel 'acceleration / g' offset 0.5, 0
set xrange [0:0.65]; set yrange [0:0.8]; set xtics 0.2; set ytics 0.2
set key on inside vertical top right reverse Left samplen 1.5 font ',17'
plot folder.'/explicit_0.dat' using 1:($2 / g) with points pt 5 ps 1.6 lc rgb amber title 'explicit', folder.'/implicit_0.dat' using 1:($2 / g) with points pt 9 ps 1.6 lc rgb sky title 'implicit', \
     folder.'/explicit_3e-3.dat' using 1:($2 / g) with points pt 4 ps 1.8 lc rgb orange title 'explicit, β = 3 ms', folder.'/implicit_3e-3.dat' using 1:($2 / g) with points pt 2 ps 1.2 lc rgb blue title 'implicit, β = 3 ms', \
     sin(angle) - x * cos(angle) with lines lw 2 dt 2 lc rgb ink title 'theory'
unset multiplot
