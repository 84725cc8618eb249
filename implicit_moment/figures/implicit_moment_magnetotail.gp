# Reconnection in the magnetotail, "even with a perpendicular field": reconnected flux for three guide fields B_g along the current (left); field lines over the
# out-of-plane current, and over B_y - B_g, for half of B0 (right). The guide field slows reconnection and does not stop it. It is swept into the
# islands with the plasma, and of the four lobes of the Hall current's quadrupole only two remain, which lie on one diagonal.
wide = 1500; high = 800
load 'common/style.gp'
case = run   # of the three runs
history(guide) = sprintf('%s/%s/history.dat', case, guide)
t = col(history('0.5'), 'time_Omega_ci'); psi = col(history('0.5'), 'flux')
run = case.'/0.5'
B0 = 1 / parameter('light_over_alfven')
guide = parameter('guide_field')
file = file_at('fields', real(near('fields', sprintf('%g', 15 / B0))))
A = col(file, 'A_y'); J = col(file, 'J_y'); B = col(file, 'B_y')
J0 = B0 / parameter('thickness')   # in the middle of the initial sheet
set multiplot title 'Reconnection with a guide field' font ',22'
set lmargin at screen 0.085; set rmargin at screen 0.42; set bmargin at screen 0.13; set tmargin at screen 0.88
set xlabel 'time  t Ω_{ci}'; set ylabel 'ΔΨ / (B_0 d_i)' offset 0.8, 0
set xrange [0:26]; set yrange [0:*]
set key top left
plot for [k = 1:3] history(word('0 0.5 1', k)) using t:psi with lines linetype k title 'B_g / B_0 = '.word('0 0.5 1', k)
unset key
eval field_frame
set xrange [-12.8:12.8]; set yrange [-6.4:6.4]
set xtics -12, 4; set ytics -6, 3
eval contours_of(file, sprintf('1:2:%d', A), sprintf('levels incremental %g, %g, %g', -8 * B0, 0.4 * B0, 8 * B0), '$lines')
set lmargin at screen 0.51; set rmargin at screen 0.88
set bmargin at screen 0.515; set tmargin at screen 0.86
eval colors(oranges); set cbrange [0:1.4]
set colorbox user origin 0.895, 0.54 size 0.012, 0.29; set cblabel 'J_y / J_0' offset -0.5, 0
unset xlabel; set format x ''; set ylabel 'z / d_i' offset 0.5, 0
set title sprintf('B_g = %g B_0, t Ω_{ci} = %.3g', guide, B0 * time_of(file)) offset 0, -0.6 font ',20'
plot file using 1:2:(column(J) / J0) with image notitle, $lines using 1:2 @contours notitle
unset title
set bmargin at screen 0.13; set tmargin at screen 0.475
eval signed(0.2)
set colorbox user origin 0.895, 0.16 size 0.012, 0.29; set cblabel '(B_y - B_g) / B_0' offset -0.5, 0; set cbtics 0.1
set xlabel 'x / d_i'; set format x '%g'
plot file using 1:2:(column(B) / B0 - guide) with image notitle, $lines using 1:2 with lines linewidth 1.2 linecolor rgb '#60333333' notitle
unset multiplot
