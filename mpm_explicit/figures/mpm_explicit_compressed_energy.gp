# The explicit half of figure 6 of the talk: energy of the compressed grains. It should be the work of the plate, and nearly is: contacts that open take some, moving particles from cell to cell and
# their change of volume do work of their own; with larger CFL numbers the grains hold more than the plate gave, in the end without bound. The ledger that says where the difference comes from closes to round-off.
wide = 1500; high = 1080
load 'common/style.gp'
folder = run
E = 1e5; unit = 1e-4 * E   # E L^2, L = 1
file(name) = folder.'/'.name.'/history.dat'
one = file('linear')
kinetic = col(one, 'kinetic'); elastic = col(one, 'elastic'); energy = col(one, 'energy'); work = col(one, 'external'); energy_14 = col(one, 'energy_14')
release = col(one, 'release'); remap = col(one, 'remap'); squeeze = col(one, 'volume'); budget = col(one, 'budget')
travel = sprintf('(-100 * $%d)', col(one, 'travel_y_plate'))
set multiplot title 'Compressed grains, explicit: energy' font ',24'
set xrange [0:3]; set xtics 0.5
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.87; set bmargin at screen 0.57
set title 'energy / (10^{−4} E L^2)' offset 0, -0.6
set yrange [0:2]; set ytics 0.5
set key top left
plot one using @travel:(column(energy) / unit) with lines lt 1 title 'total', one using @travel:(column(elastic) / unit) with lines lt 3 title 'elastic', \
     one using @travel:(column(kinetic) / unit) with lines lt 6 title 'kinetic', one using @travel:(column(work) / unit) with lines lt 8 dt 2 lw 2 title 'work of the plate'
set lmargin at screen 0.585; set rmargin at screen 0.98
set title 'energy less work of the plate / (10^{−4} E L^2)'
set yrange [-0.05:0.025]; set ytics 0.025
set key bottom left
plot one using @travel:((column(energy_14) - column(work)) / unit) with lines lt 8 title 'all', one using @travel:(column(release) / unit) with lines lt 2 title 'contacts that open', \
     one using @travel:(column(remap) / unit) with lines lt 4 title 'from cell to cell', one using @travel:(column(squeeze) / unit) with lines lt 5 title 'change of volume'
set xlabel 'travel of the plate / (L/100)'
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.42; set bmargin at screen 0.12
set title 'energy / work of the plate'
set yrange [0.8:1.8]; set ytics 0.2
set key top left maxrows 4
# The ratio of two small numbers at the start is left out.
ratio = '($'.col(one, 'travel_y_plate').' < -1e-3 ? column(energy) / column(work) : NaN)'
plot file('alpha_0.7') using @travel:@ratio with lines lt 5 title 'α = 0.70', file('alpha_0.5') using @travel:@ratio with lines lt 3 title 'α = 0.50', \
     one using @travel:@ratio with lines lt 1 title 'α = 0.25', file('gimp') using @travel:@ratio with lines lt 1 dt 2 title '0.25, gimp'
set lmargin at screen 0.585; set rmargin at screen 0.98
set title 'rest of the ledger / (10^{−14} of the final work)'
set yrange [-2:2]; set ytics 1
end = real(system(sprintf("LC_ALL=C awk 'END { print $%d }' '%s'", work, one)))
unset key
plot one using @travel:(1e14 * column(budget) / end) with lines lt 8 lw 1.5
unset multiplot
