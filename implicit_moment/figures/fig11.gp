# Figure 11 of the talk: current density along the sheet, averaged along it, T_i/T_e = 1, in units of its value in the middle at the start. While the
# lower-hybrid drift instability grows at the edges (z = ±L), current leaves them and the middle carries more; later the maximum splits in two, and in
# the end the kink smears it.
# from: implicit_moment/data/thin_sheet_current.csv
wide = 1900; high = 720
load 'common/style.gp'
if (!exists('kept')) kept = 'implicit_moment/data'
set datafile separator ','
data = kept.'/thin_sheet_current.csv'
stats data using 1 nooutput name 'time'
stats data using 3 nooutput name 'J'
every(step, end) = sprintf("< awk -F, '!/^#/ && $1 <= %g && $1 / %g - int($1 / %g + 0.01) < 0.02' %s", end + 0.01, step, step, data)
set multiplot title 'Thin current sheet, T_i / T_e = 1: J_y(z, t)' font ',22'
eval field_frame
set size noratio
eval colors(inferno)
unset key
set yrange [-3:3]; set cbrange [0:J_max]; set ytics 1
set xlabel 't Ω_{ci}'; set ylabel 'z / L' offset 1, 0
set bmargin at screen 0.15; set tmargin at screen 0.86
set lmargin at screen 0.05; set rmargin at screen 0.31; unset colorbox
set xrange [-0.25:12.25]; set xtics 0, 2, 12
set title 'the instability' offset 0, -0.6
plot every(0.5, 12) using 1:2:3 with image notitle
set lmargin at screen 0.345; set rmargin at screen 0.605
unset ylabel; set format y ''
set xrange [-1:time_max + 1]; set xtics 0, 20, 120
set title sprintf('the run, to t Ω_{ci} = %.0f', time_max) offset 0, -0.6
set colorbox user origin 0.613, 0.15 size 0.01, 0.71; set cblabel 'J_y / J_0' offset 0.3, 0
plot every(2, time_max) using 1:2:3 with image notitle

unset colorbox; set border 3; set grid; set format y '%g'
set lmargin at screen 0.745; set rmargin at screen 0.985
set xrange [-3:3]; set yrange [-0.1:*]; set xtics -3, 1, 3; set ytics 0.2
set xlabel 'z / L'; set title 'J_y / J_0'
set key top right samplen 1.2 title 't Ω_{ci}'
mean(t) = sprintf("< awk -F, '!/^#/ && $1 >= %g && $1 <= %g { sum[$2] += $3; ++count[$2] } END { for (z in sum) print z \",\" sum[z] / count[z] }' %s | sort -t, -k1g", t - 0.51, t + (t < 12 ? 0.51 : 0.01), data)
plot [-3:3] 1 / cosh(x)**2 with lines lt 7 dt 2 title '0', \
     for [t = 3:12:3] mean(t) using 1:2 with lines lt (t / 3) title sprintf('%d', t)
unset multiplot
