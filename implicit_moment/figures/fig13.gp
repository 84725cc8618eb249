# Figure 13 of the talk: B_x(y, z) at the end of the run, t Ω_{ci} = 110, for T_i/T_e = 2; only |z| < 2 L of 9 L is shown. The line where B_x
# changes sign, the middle of the sheet, is bent into one wave: the kink, m_y = 1. It began as a straight line, with contours of B_0 tanh(z/L).
# from: implicit_moment/data/thin_sheet_field.dat
wide = 1300; high = 820
load 'common/style.gp'
if (!exists('kept')) kept = 'implicit_moment/data'
data = kept.'/thin_sheet_field.dat'
t = real(system(sprintf("awk '/^# t / { print $NF }' %s", data)))
stats data using 1 nooutput name 'y'
eval field_frame
eval signed(1)
unset key
set size noratio
set title sprintf('Kinked current sheet: B_x at t Ω_{ci} = %.0f, T_i/T_e = 2', t)
set xrange [0:y_max - y_min]; set yrange [-2:2]; set xtics 0.5; set ytics 1
set xlabel 'y / L'; set ylabel 'z / L'; set cblabel 'B_x / B_0'
place = '($1 - y_min):2:3'
eval contours_of(data, place, 'levels incremental -0.8, 0.2, 0.8', '$lines')
eval contours_of(data, place, 'levels discrete 0', '$middle')
plot data using ($1 - y_min):2:3 with image notitle, \
     $lines using 1:2 with lines lw 1 lc rgb '#80333333', $middle using 1:2 with lines lw 2.6 lc rgb 'black'
