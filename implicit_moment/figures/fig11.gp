# Figure 11 of the talk: current density along the sheet, averaged along it, T_i/T_e = 1, in units of its value in the middle at the start. While the
# lower-hybrid drift instability grows at the edges (z = ±L), current leaves them and the middle carries more; later the maximum splits in two.
wide = 1500; high = 720
load 'common/style.gp'
load 'implicit_moment/figures/thin_sheet.gp'
folder = run.'/ratio_1'
set multiplot title 'Thin current sheet, T_i / T_e = 1: J_y(z, t)' font ',22'
eval field_frame
set size noratio
eval colors(inferno)
unset key
set xrange [0:12]; set yrange [-3:3]; set cbrange [0:*]
set xtics 2; set ytics 1
set xlabel 't Ω_{ci}'; set ylabel 'z / L' offset 1, 0
set lmargin at screen 0.06; set rmargin at screen 0.46; set bmargin at screen 0.15; set tmargin at screen 0.86
set colorbox user origin 0.47, 0.15 size 0.013, 0.71; set cblabel 'J_y / J_0' offset -0.5, 0
plot profiles(folder) using 1:2:4 with image notitle

unset colorbox; set border 3; set grid
set lmargin at screen 0.655; set rmargin at screen 0.985
set xrange [-3:3]; set yrange [-0.1:*]; set xtics 1; set ytics 0.2
set xlabel 'z / L'; set ylabel 'J_y / J_0' offset 1, 0
set key top right samplen 1.2 title 't Ω_{ci}'
plot [-3:3] 1 / cosh(x)**2 with lines lt 7 dt 2 title '0', \
     for [t = 3:12:3] profile(folder, 4, t - 0.5, t + (t < 12 ? 0.5 : 0)) using 1:2 with lines lt (t / 3) title sprintf('%d', t)
unset multiplot
