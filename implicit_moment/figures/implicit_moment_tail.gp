# A field across the sheet: what of the flux through the middle row closes on itself in a thin tail (above left); how far the flux of a thick one at rest moves
# between ends that mirror the plasma, and between ends whose image charges hide its current (below left). Field lines over the out-of-plane current: the thick tail at
# the end of its run, dark, and at the start, light (above right); the thin one while it reconnects (below right).
wide = 1400; high = 790
load 'common/style.gp'
folder = run
rest = folder.'/rest/reflecting'; walls = folder.'/rest/wall'; thin = folder.'/thin/1'
run = rest
noise = real(entry('results.flux_shift.at_most'))
B0 = 1 / parameter('light_over_alfven')
lines = sprintf('levels incremental %g, %g, %g', -8 * B0, 0.5 * B0, 8 * B0)
late = file_at('fields', 1e9); first = file_at('fields', 0)
A = col(late, 'A_y'); J = col(late, 'J_y')
run = thin
tearing = file_at('fields', 18 / B0)
eval contours_of(first, sprintf('1:2:%d', A), lines, '$before')
eval contours_of(late, sprintf('1:2:%d', A), lines, '$after')
eval contours_of(tearing, sprintf('1:2:%d', A), lines, '$torn')
set multiplot title 'A tail: a current sheet with a field across it' font ',22'
set lmargin at screen 0.105; set rmargin at screen 0.42
set bmargin at screen 0.575; set tmargin at screen 0.88
set ylabel 'closed flux / (B_0 d_i)' offset 0.8, 0; set ytics 1
set xrange [0:26]; set yrange [0:*]; set key top left; set format x ''
plot thin.'/history.dat' using (column('time_Omega_ci')):(column('flux')) with lines linetype 2 title 'thin'
set bmargin at screen 0.14; set tmargin at screen 0.51
set format x '%g'; set xlabel 'time  t Ω_{ci}'; set ylabel 'shift of flux / (B_0 d_i)' offset 0.8, 0
set yrange [0:0.07]; set ytics 0.02
plot walls.'/history.dat' using (column('time_Omega_ci')):(column('flux_shift')) with lines linetype 4 title 'thick, image charges', \
     noise with lines linewidth 1.5 linecolor rgb gray dashtype 2 title 'thermal noise', \
     rest.'/history.dat' using (column('time_Omega_ci')):(column('flux_shift')) with lines linetype 1 title 'thick, mirrors'
unset key
eval field_frame
set xrange [-12.8:12.8]; set yrange [-6.4:6.4]
set xtics -12, 4; set ytics -6, 3
eval colors(oranges)
set lmargin at screen 0.51; set rmargin at screen 0.88
run = rest
J0 = B0 / parameter('thickness')
set bmargin at screen 0.54; set tmargin at screen 0.86
set cbrange [0:3]
set colorbox user origin 0.895, 0.56 size 0.012, 0.28; set cblabel 'J_y / J_0' offset 0.5, 0; set cbtics 1
unset xlabel; set format x ''; set ylabel 'z / d_i' offset 0.5, 0
set title sprintf('thick, 1 d_i, B_z = %g B_0, t Ω_{ci} = %.3g', parameter('normal_field'), B0 * time_of(late)) offset 0, -0.6 font ',20'
plot late using 1:2:(column(J) / J0) with image notitle, $before using 1:2 with lines linewidth 4 linecolor rgb '#a8cfe6' notitle, $after using 1:2 @contours notitle
run = thin
J0 = B0 / parameter('thickness')
set bmargin at screen 0.14; set tmargin at screen 0.46
set colorbox user origin 0.895, 0.15 size 0.012, 0.28
set xlabel 'x / d_i'; set format x '%g'
set title sprintf('thin, 0.5 d_i, B_z = %g B_0, t Ω_{ci} = %.3g', parameter('normal_field'), B0 * time_of(tearing)) offset 0, -0.6 font ',20'
plot tearing using 1:2:(column(J) / J0) with image notitle, $torn using 1:2 @contours notitle
unset multiplot
