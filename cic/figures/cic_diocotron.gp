# Diocotron instability: a layer of electrons (their density is shown) between grounded walls, in a magnetic field out of the plane. The layer shears itself, its edges
# ripple at the rate of theory and wind up into a vortex, drawing filaments around it, like a shear layer of an ideal fluid. Below right, which ripples grow.
# fits: cic theory.compare=diocotron file:fields_*.dat result:growth
wide = 1500; high = 1020
load 'common/style.gp'
times = near('fields', '450 600 750 900'); marks = times
x_label = 'x / d'; z_label = 'z / d'; plane_step = 4
rho = col(run.'/fields_000000.dat', 'rho'); field_of = '-column(rho)'; field_title = 'n / n_0'
eval colors(inferno); set cbrange [0:1.2]; set cbtics 0.4
set multiplot title 'Diocotron instability of a layer of electrons' font ',24'
row_top = 0.865
load 'cic/figures/field_row.gp'
set bmargin at screen 0.11; set tmargin at screen 0.44
set lmargin at screen 0.085; set rmargin at screen 0.53
field_label = '|E_k| / (n_0 e d)'
growth_floor = 1e-3; growth_top = 10
load 'cic/figures/growth.gp'
set lmargin at screen 0.62; set rmargin at screen 0.97
shear = 1 / parameter('B_y')
b = 0.5 * parameter('length_z')
even(k) = sinh(k * (b - 1)) * cosh(k) / cosh(k * b)
odd(k) = sinh(k * (b - 1)) * sinh(k) / sinh(k * b)
square(k) = (even(k) - k) * (k - odd(k))
set xrange [0:0.8]; set yrange [0:0.25]; set xtics 0.2; set ytics 0.05
set xlabel 'k d'; set ylabel 'γ / (n_0 e/B_y)' offset 0.5, 0
set key center bottom; set samples 1000
k_of_run = 2 * pi / parameter('length_x')
set label 1 sprintf('this run, %+.1f %%', 100 * (result('growth_over_theory') - 1)) at k_of_run, result('growth') / shear offset 0, 1.1 center
plot [0.001:0.8] (square(x) > 0 ? sqrt(square(x)) : 0) with lines lt 2 title 'theory', \
     '+' using (k_of_run):(result('growth') / shear) every ::0::0 with points pt 7 ps 2 lc rgb blue notitle
unset multiplot
