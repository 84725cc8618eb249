# Figure 13 of the talk: B_x(y, z) at the end of the run (in the talk t Ω_{ci} = 110) for T_i/T_e = 2; only |z| < 2 L of 9 L is shown. The line where B_x
# changes sign, the middle of the sheet, is bent into one wave: the kink, m_y = 1. It began as a straight line, with contours of B_0 tanh(z/L).
wide = 1300; high = 820
load 'common/style.gp'
load 'implicit_moment/figures/kink.gp'
ratio = '2'
file = last_fields(ratio)
B0 = 1 / input(ratio, 'light_over_alfven'); L = sqrt(input(ratio, 'temperature_ratio') / (1 + input(ratio, 'temperature_ratio')))
length = input(ratio, 'length_x')
t = (real('1'.file[strlen(file) - 9 : strlen(file) - 4]) - 1e6) * input(ratio, 'dt') * B0
B = col(file, 'B_y')
eval field_frame
eval signed(1)
unset key
set size noratio
set title sprintf('Kinked current sheet: B_x at t Ω_{ci} = %.0f, T_i/T_e = 2', t)
set xrange [0:length]; set yrange [-2:2]; set xtics 1; set ytics 1
set xlabel 'y / L'; set ylabel 'z / L'; set cblabel 'B_x / B_0'
place = sprintf('($1 / %g + %g):($2 / %g):(-$%d / %g)', L, 0.5 * length, L, B, B0)
eval contours_of(file, place, 'levels incremental -0.8, 0.2, 0.8', '$lines')
eval contours_of(file, place, 'levels discrete 0', '$middle')
plot file skip 1 using ($1 / L + 0.5 * length):($2 / L):(-column(B) / B0) with image notitle, \
     $lines using 1:2 with lines lw 1 lc rgb '#80333333', $middle using 1:2 with lines lw 2.6 lc rgb 'black'
