# The two streams in the plane, seeded with a mode across the corner of the box. Only the part of k along the beams counts, so the oblique wave grows at
# the rate of the straight one; along k the electrons roll up as in one dimension.
# fits: cic grid.dimensions=2 theory.compare=wave file:fields_*.dat file:particles_*.dat result:growth
wide = 1500; high = 1020
load 'common/style.gp'
times = near('fields', '25 30 35 50'); marks = times
x_label = 'x ω_p / v_0'; z_label = 'z ω_p / v_0'; plane_step = 4
E_x = col(file_at('fields', 0), 'E_x'); field_of = 'column(E_x)'; field_title = 'E_x'
eval signed(0.8); set cbtics 0.4
set multiplot title 'Two streams in the plane: E_x / (m v_0 ω_p/e)' font ',24'
row_top = 0.865
load 'cic/figures/field_row.gp'
set bmargin at screen 0.11; set tmargin at screen 0.44
set lmargin at screen 0.085; set rmargin at screen 0.53
growth_floor = 1e-6; growth_top = 10
load 'cic/figures/growth.gp'
set lmargin at screen 0.62; set rmargin at screen 0.97
# Particles along the wave vector, at the time nearest to the third picture.
k_x = result('mode_x') / parameter('length_x'); k_z = parameter('mode_z') / parameter('length_z'); k = sqrt(k_x**2 + k_z**2)
along(x, z) = k_x * x + k_z * z - floor(k_x * x + k_z * z)
picture = file_at('particles', real(word(times, words(times) > 2 ? 3 : words(times)))); v_x = col(picture, 'v_x'); v_z = col(picture, 'v_z')
set border 15; unset key
set xrange [0:1]; set yrange [-2:2]; set xtics 0.25; set ytics 1
set xlabel 'k · x / 2π, modulo 1'; set ylabel 'v along k / v_0' offset 0.3, 0
set label 1 sprintf('t ω_p = %.4g', time_of(picture)) at graph 0.97, 0.93 right
plot for [turn = 0:3] for [s = 0:1] picture every 4::turn using ($1 == s ? along($2, $3) : NaN):((k_x * column(v_x) + k_z * column(v_z)) / k) \
    with points pt 7 ps 0.2 lc rgb (s == 0 ? blue : orange)
unset multiplot
