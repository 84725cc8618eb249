# Figure 8 of the talk: magnetic field lines (contours of A_y) and out-of-plane current density (color) of the GEM challenge at four times. The sheet thins at
# the X-line in the middle and is drawn out into the separatrices, while the island at the ends of the periodic box swallows the flux.
# fits: implicit_moment|explicit_em file:fields_*.dat result:peak_reconnection_rate
wide = 1500; high = 940
load 'common/style.gp'
B0 = 1 / parameter('light_over_alfven')
file(t) = sprintf('%s/fields_%06d.dat', run, int(t / (B0 * parameter('dt')) + 0.5))   # t in 1/Omega_ci
A = col(file(0), 'A_y'); J = col(file(0), 'J_y')
J0 = B0 / parameter('thickness')   # in the middle of the initial sheet, c B0/(4 pi lambda), in the e n0 c of the files
times = '0 12 18 24'
eval field_frame
eval colors(inferno)
unset key
set xrange [-12.8:12.8]; set yrange [-6.4:6.4]
set xtics -12, 4; set ytics -6, 3
set cbrange [0:1.4]
set multiplot title 'GEM challenge: field lines and out-of-plane current' font ',22'
do for [k = 1:4] {
    t = int(word(times, k))
    left = k % 2 == 1 ? 0.07 : 0.48
    bottom = k <= 2 ? 0.545 : 0.12
    set lmargin at screen left; set rmargin at screen left + 0.39
    set bmargin at screen bottom; set tmargin at screen bottom + 0.33
    set title sprintf('t Ω_{ci} = %d', t) offset 0, -0.6
    if (k > 2) { set xlabel 'x / d_i' } else { set xlabel '' }
    if (k % 2 == 1) { set ylabel 'z / d_i' offset 1, 0; set ytics -6, 3 } else { set ylabel ''; set ytics ('' -6, '' -3, '' 0, '' 3, '' 6) }
    if (k == 2) { set colorbox user origin 0.895, 0.25 size 0.014, 0.48; set cblabel 'J_y / J_0' offset -0.5, 0 } else { unset colorbox }
    # 16 lines to the side in steps of 0.4 B0 d_i
    eval contours_of(file(t), sprintf('1:2:%d', A), sprintf('levels incremental %g, %g, %g', -8 * B0, 0.4 * B0, 8 * B0), '$lines')
    plot file(t) using 1:2:(column(J) / J0) with image notitle, $lines using 1:2 @contours notitle
}
unset multiplot
