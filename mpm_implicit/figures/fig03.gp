# Figure 3 of the talk: total energy, elastic energy and x-momentum of the rebounding disks, implicit (solid) and explicit (dashed). Both keep momentum. Implicit, the energy is the initial one to round-off with
# CFL numbers of 1 and 5 alike; explicit, it errs by a per cent with 0.25 and bursts with 1.00. Shaded: the time in contact, 0.974 of a contact always in equilibrium.
wide = 1500; high = 1120
load 'common/style.gp'
folder = run; other = 'out/mpm_explicit/rebounds'
files = folder.'/alpha_1/history.dat '.folder.'/alpha_5/history.dat '.other.'/alpha_0.25/history.dat '.other.'/alpha_1/history.dat'
array name[4] = ['implicit, α = 1', 'implicit, α = 5', 'explicit, α = 0.25', 'explicit, α = 1']
tint = blue.' '.green.' '.amber.' '.orange
array dash[4] = [1, 1, 2, 4]
array width[4] = [2.6, 2.6, 2.6, 2.2]
file(n) = word(files, n)
number(n, what) = col(file(n), what)
first(n, what) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", number(n, what), file(n))))
E_0 = first(1, 'energy'); p_0 = first(1, 'momentum_x_left')
run = folder.'/alpha_1'
touch = real(entry('results.contact_begins.expected')); lasts = real(entry('results.contact_lasts.expected'))
array energy[4]; array elastic[4]; array left[4]; array all[4]
do for [n = 1:4] { energy[n] = number(n, 'energy'); elastic[n] = number(n, 'elastic'); left[n] = number(n, 'momentum_x_left'); all[n] = number(n, 'momentum_x') }
set multiplot title 'Elastic rebound: implicit and explicit' font ',24'
set object 1 rectangle from first touch, graph 0 to first touch + lasts, graph 1 behind fillcolor rgb '#f2f2f2' fillstyle solid noborder
set xrange [0:2]; set xtics 0.5
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.87; set bmargin at screen 0.57
set title 'total energy / initial' offset 0, -0.6
set yrange [0.9:1.3]; set ytics 0.1
set key at graph 1.02, 1 right top samplen 1.5
plot for [n = 1:4] file(n) using 1:(column(energy[n]) / E_0) with lines lc rgb word(tint, n) dt dash[n] lw width[n] title name[n]
unset key
set lmargin at screen 0.585; set rmargin at screen 0.98
set title 'elastic energy / initial total'
set yrange [0:1.2]; set ytics 0.2
plot for [n = 1:4] file(n) using 1:(column(elastic[n]) / E_0) with lines lc rgb word(tint, n) dt dash[n] lw width[n]
set xlabel 't'
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.42; set bmargin at screen 0.12
set title 'x-momentum / initial, of the left grain'
set yrange [-1.25:1.5]; set ytics 0.5
set label 1 'left grain' at 0.25, 1.2 center textcolor rgb ink; set label 3 'both' at 0.25, 0.2 center textcolor rgb ink
plot for [n = 1:4] file(n) using 1:(column(left[n]) / p_0) with lines lc rgb word(tint, n) dt dash[n] lw width[n], \
     for [n = 1:4] file(n) using 1:(column(all[n]) / p_0) with lines lc rgb word(tint, n) dt dash[n] lw width[n]
unset label 1; unset label 3
set lmargin at screen 0.585; set rmargin at screen 0.98
set title '|change of total energy| / initial'
set logscale y; set yrange [1e-17:100]; set format y '10^{%T}'; set ytics 1e-16, 1e4, 1; set mytics 1
plot for [n = 1:4] file(n) using 1:(abs(column(energy[n]) / E_0 - 1) + 1e-17) with lines lc rgb word(tint, n) dt dash[n] lw width[n]
unset multiplot
