# The two streams in the plane, seeded with a mode across the corner of the box. Only the part of k along the beams counts, so the oblique wave grows at
# the rate of the straight one; along k the electrons roll up as in one dimension.
# fits: cic grid.dimensions=2 theory.compare=wave file:fields_*.dat file:particles_*.dat result:growth
wide = 1500; high = 1020
load 'common/style.gp'
times = near('fields', '25 30 35 50'); marks = times
x_label = 'x ω_p / v_0'; z_label = 'z ω_p / v_0'; plane_step = 4
E_x = col(run.'/fields_000000.dat', 'E_x'); field_of = 'column(E_x)'; field_title = 'E_x'
eval signed(0.8); set cbtics 0.4
set multiplot title 'Two streams in the plane: E_x / (m v_0 ω_p/e)' font ',24'
row_top = 0.865
load 'cic/figures/field_row.gp'
set bmargin at screen 0.11; set tmargin at screen 0.44
set lmargin at screen 0.085; set rmargin at screen 0.53
growth_floor = 1e-6; growth_top = 10
load 'cic/figures/growth.gp'
set lmargin at screen 0.62; set rmargin at screen 0.97
L = parameter('length_x')
set border 15; unset key
set xrange [0:L]; set yrange [-2:2]; set xtics 2; set ytics 1
set xlabel '(x + z) ω_p / v_0, modulo L'; set ylabel 'v along k / v_0' offset 0.3, 0
set label 1 't ω_p = 35' at graph 0.97, 0.93 right
plot for [turn = 0:3] for [s = 0:1] run.'/particles_000350.dat' every 4::turn using ($1 == s ? $2 + $3 - ($2 + $3 > L ? L : 0) : NaN):(($4 + $6) / sqrt(2)) \
    with points pt 7 ps 0.2 lc rgb (s == 0 ? blue : orange)
unset multiplot
