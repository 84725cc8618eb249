# The explicit half of figure 3 of the talk: energy and x-momentum of the rebounding disks. Nothing bounds the energy: up to a CFL number of 0.7 it ends 0.4 to 3 percent high, and with
# 1.00 it grows without end, thirteen times at t = 2; momentum is kept all the same. Grains that press wherever they approach and share nodes (dashed) meet too early, and what
# that takes in energy does not come back as it went. Shaded: the time in contact, 0.974 of a contact always in equilibrium.
wide = 1500; high = 1080
load 'common/style.gp'
folder = run
alphas = '0.25 0.5 0.7 0.9 1'
tint = blue.' '.sky.' '.green.' '.amber.' '.orange
file(n) = folder.'/alpha_'.word(alphas, n).'/history.dat'
kinetic = col(file(1), 'kinetic'); elastic = col(file(1), 'elastic'); energy = col(file(1), 'energy')
left = col(file(1), 'momentum_x_left'); right = col(file(1), 'momentum_x_right'); all = col(file(1), 'momentum_x')
first(what) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", what, file(1))))
E_0 = first(energy); p_0 = first(left)
run = folder.'/alpha_0.25'
touch = real(entry('results.contact_begins.expected')); lasts = real(entry('results.contact_lasts.expected'))
set multiplot title 'Elastic rebound, explicit: energy and momentum' font ',24'
set object 1 rectangle from first touch, graph 0 to first touch + lasts, graph 1 behind fillcolor rgb '#f2f2f2' fillstyle solid noborder
set xrange [0:2]; set xtics 0.5
set lmargin at screen 0.085; set rmargin at screen 0.49
set tmargin at screen 0.87; set bmargin at screen 0.57
set title 'total energy / initial' offset 0, -0.6
set logscale y; set yrange [0.8:5]; set ytics (1, 2, 3, 5)
set key top left
plot for [n = 5:1:-1] file(n) using 1:(column(energy) / E_0) with lines lc rgb word(tint, n) title sprintf('α = %.2f', real(word(alphas, n)))
unset key
set lmargin at screen 0.575; set rmargin at screen 0.98
set title 'elastic energy / initial total'
set yrange [0.02:3]; set ytics (0.1, 1)
plot for [n = 5:1:-1] file(n) using 1:(column(elastic) / E_0) with lines lc rgb word(tint, n)
unset logscale y
set xlabel 't'
set lmargin at screen 0.085; set rmargin at screen 0.49
set tmargin at screen 0.42; set bmargin at screen 0.12
set title 'x-momentum / initial momentum of a grain'
set yrange [-1.75:1.75]; set ytics 0.5
set label 1 'left' at 0.25, 1.2 center textcolor rgb ink; set label 2 'right' at 0.25, -1.2 center textcolor rgb ink; set label 3 'sum' at 0.25, 0.2 center textcolor rgb ink
plot for [n = 5:1:-1] file(n) using 1:(column(left) / p_0) with lines lc rgb word(tint, n), \
     for [n = 5:1:-1] file(n) using 1:(column(right) / p_0) with lines lc rgb word(tint, n), \
     for [n = 5:1:-1] file(n) using 1:(column(all) / p_0) with lines lc rgb word(tint, n)
unset label 1; unset label 2; unset label 3
set lmargin at screen 0.575; set rmargin at screen 0.98
set title 'total energy / initial, enlarged'
set yrange [0.96:1.04]; set ytics 0.02
set key top left
plot folder.'/on_approach/history.dat' using 1:(column(energy) / E_0) with lines lc rgb pink dt 2 title 'α = 0.25, pressed on approach', \
     for [n = 3:1:-1] file(n) using 1:(column(energy) / E_0) with lines lc rgb word(tint, n) notitle
unset multiplot
