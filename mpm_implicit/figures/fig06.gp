# Figure 6 of the talk: energy of the compressed grains, implicit with a CFL number of 4 and explicit with 0.25, and beside each the work of its plate (dashed). Below, the part of the work that the energy lacks or
# has too much: implicit, theorem [MPM-13] says none, and round-off is what is left; explicit, some tenths of a per cent, made and lost where contacts open, particles cross from cell to cell and change their volume.
wide = 1500; high = 1120
load 'common/style.gp'
E = 1e5; unit = 1e-4 * E   # E L^2, L = 1
one = run.'/linear/history.dat'; other = 'out/mpm_explicit/compressions/linear/history.dat'
file(n) = n == 1 ? one : other
array energy[2] = [col(one, 'energy'), col(other, 'energy')]
array elastic[2] = [col(one, 'elastic'), col(other, 'elastic')]
array kinetic[2] = [col(one, 'kinetic'), col(other, 'kinetic')]
array work[2] = [col(one, 'external'), col(other, 'external')]
array travel[2] = [col(one, 'travel_y_plate'), col(other, 'travel_y_plate')]
set multiplot title 'Compressed grains: energy and work' font ',24'
set xrange [0:3]; set xtics 0.5
set yrange [0:2]; set ytics 0.5
do for [n = 1:2] {
    set lmargin at screen (n == 1 ? 0.085 : 0.585); set rmargin at screen (n == 1 ? 0.48 : 0.98)
    set tmargin at screen 0.87; set bmargin at screen 0.53
    set title (n == 1 ? 'implicit, α = 4: energy / (10^{−4} E L^2)' : 'explicit, α = 0.25: energy / (10^{−4} E L^2)') offset 0, -0.6
    set key top left
    plot file(n) using (-100 * column(travel[n])):(column(energy[n]) / unit) with lines lt 1 lw 3.5 title 'total', '' using (-100 * column(travel[n])):(column(work[n]) / unit) with lines lt 2 dt 2 title 'work of the plate', \
         '' using (-100 * column(travel[n])):(column(elastic[n]) / unit) with lines lt 3 title 'elastic', '' using (-100 * column(travel[n])):(column(kinetic[n]) / unit) with lines lt 6 title 'kinetic'
}
unset key
set xlabel 'travel of the plate / (L/100)'
set tmargin at screen 0.4; set bmargin at screen 0.115
last(n, what) = real(system(sprintf("LC_ALL=C awk 'END { print $%d }' '%s'", what, file(n))))
set lmargin at screen 0.085; set rmargin at screen 0.48
set title 'energy less work / final work'
set yrange [-0.01:0.01]; set ytics 0.005
set label 1 'explicit' at 2.05, -0.0045 center textcolor rgb orange; set label 2 'implicit' at 2.05, 0.0013 center textcolor rgb blue
plot for [n = 1:2] file(n) using (-100 * column(travel[n])):((column(energy[n]) - column(work[n])) / last(n, work[n])) with lines lt n
unset label 1; unset label 2
set lmargin at screen 0.585; set rmargin at screen 0.98
set title '|energy less work| / final work'
set logscale y; set yrange [1e-17:1]; set format y '10^{%T}'; set ytics 1e-16, 1e4, 1; set mytics 1
plot for [n = 1:2] file(n) using (-100 * column(travel[n])):(abs(column(energy[n]) - column(work[n])) / last(n, work[n]) + 1e-17) with lines lt n
unset multiplot
