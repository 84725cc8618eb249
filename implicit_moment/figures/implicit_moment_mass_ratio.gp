# The GEM challenge with three electron masses: reconnected flux, seed 1 (left); peak rate and time of unit flux of every seed (right). A factor of 73 in mass
# makes a third in the rate, and reconnection starts earlier: a weak dependence, as Ricci et al. (2004) say. An explicit code pays (1836/25)^{3/2} = 630 times for it.
wide = 1500; high = 700
load 'common/style.gp'
history(ratio) = sprintf('%s/%s_1/history.dat', run, ratio)
t = col(history('25'), 'time_Omega_ci'); psi = col(history('25'), 'flux')
rates = run.'/rates.dat'
set multiplot title 'GEM challenge: the mass ratio' font ',22'
set tmargin at screen 0.89
set lmargin at screen 0.085; set rmargin at screen 0.50; set bmargin at screen 0.17
set xlabel 'time  t Ω_{ci}'; set ylabel 'ΔΨ / (B_0 d_i)' offset 0.8, 0
set xrange [0:22]; set yrange [0:*]
set key top left
plot for [k = 1:3] history(word('1836 180 25', k)) using t:psi with lines linetype k title 'm_i/m_e = '.word('1836 180 25', k)
set lmargin at screen 0.60; set rmargin at screen 0.985
unset key
set logscale x; set xrange [15:3000]; set xtics ('25' 25, '180' 180, '1836' 1836)
set tmargin at screen 0.49
set xlabel 'm_i / m_e'; set ylabel 'peak rate / (B_0 v_A)' offset 0.5, 0
set yrange [0:0.4]; set ytics 0.1
plot rates using 1:4 with points pointtype 7 pointsize 1.5 linecolor rgb blue
set tmargin at screen 0.89; set bmargin at screen 0.56
unset xlabel; set xtics ('' 25, '' 180, '' 1836)
set ylabel 'unit flux at t Ω_{ci}'
set yrange [0:20]; set ytics 5
plot rates using 1:3 with points pointtype 7 pointsize 1.5 linecolor rgb blue
unset multiplot
