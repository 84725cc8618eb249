# Figure 8 of the talk: magnetic field lines (contours of A_y) and out-of-plane current density (color) of the GEM challenge at four times. The sheet thins at
# the X-line in the middle and is drawn out into the separatrices, while the island at the ends of the periodic box swallows the flux.
# fits: implicit_moment|explicit_em file:fields_*.dat result:peak_reconnection_rate
wide = 1400; high = 880
load 'common/style.gp'
B0 = 1 / parameter('light_over_alfven')
times = near('fields', sprintf('0 %g %g %g', 12 / B0, 18 / B0, 24 / B0))
file(k) = file_at('fields', real(word(times, k)))
A = col(file(1), 'A_y'); J = col(file(1), 'J_y')
J0 = B0 / parameter('thickness')   # in the middle of the initial sheet, c B0/(4 pi lambda), in the e n0 c of the files
eval field_frame
eval colors(oranges)
unset key
length_x = parameter('length_x'); length_z = parameter('length_z')
set xrange [-0.5 * length_x:0.5 * length_x]; set yrange [-0.5 * length_z:0.5 * length_z]
set xtics 4; set ytics 3
set cbrange [0:1.4]
set multiplot title 'GEM challenge: field lines and out-of-plane current' font ',22'
do for [k = 1:words(times)] {
    # 16 lines to the side in steps of 0.4 B0 d_i
    eval contours_of(file(k), sprintf('1:2:%d', A), sprintf('levels incremental %g, %g, %g', -8 * B0, 0.4 * B0, 8 * B0), '$lines')
    left = k % 2 == 1 ? 0.07 : 0.48
    bottom = k <= 2 ? 0.545 : 0.12
    set lmargin at screen left; set rmargin at screen left + 0.39
    set bmargin at screen bottom; set tmargin at screen bottom + 0.33
    set title sprintf('t Ω_{ci} = %.3g', B0 * real(word(times, k))) offset 0, -0.6
    if (k > words(times) - 2) { set xlabel 'x / d_i'; set format x '%g' } else { set xlabel ''; set format x '' }
    if (k % 2 == 1) { set ylabel 'z / d_i' offset 1, 0; set format y '%g' } else { set ylabel ''; set format y '' }
    if (k == 2 || words(times) == 1) { set colorbox user origin 0.895, 0.25 size 0.014, 0.48; set cblabel 'J_y / J_0' offset -0.5, 0 } else { unset colorbox }
    plot file(k) using 1:2:(column(J) / J0) with image notitle, $lines using 1:2 @contours notitle
}
unset multiplot
