# Figure 9 of the talk: reconnected flux of the GEM challenge. The flux grows slowly until t = 9, fast from t = 11, and reaches unit flux at the
# time of the published curves; the initial value 0.2 is exact, and the straight line has the slope of Pritchett's reconnection field, 0.24. Dashed: the same by
# this project's explicit program at the numbers of the cost slide. The published points are digitized by hand: the bar is their error.
# fits: implicit_moment|explicit_em result:time_at_unit_flux harris.guide_field=0
load 'common/style.gp'
history = run.'/history.dat'
data = 'implicit_moment/data/birn2001_fig1.csv'
explicit = 'implicit_moment/data/explicit_gem_flux.csv'
t = col(history, 'time_Omega_ci'); psi = col(history, 'flux')
set title 'GEM challenge: reconnected flux'
set xlabel 'time  t Ω_{ci}'; set ylabel 'ΔΨ / (B_0 d_i)'
set xrange [0:40]; set yrange [0:5]
set key top left
t1 = result('time_at_unit_flux')
set arrow from t1, 0 to t1, 1 nohead dt 3 lc rgb gray
set label sprintf('ΔΨ = 1 at t Ω_{ci} = %.1f', t1) at t1 + 0.6, 0.12 textcolor rgb ink font ',16'
set datafile separator ' ,'   # history.dat has blanks, the published data commas
plot sample [15:28] '+' using 1:(1 + 0.24 * ($1 - t1)) with lines lt 7 dt 3 title 'slope 0.24 (Pritchett 2001)', \
     history using t:psi @measured title 'implicit moment, this run', \
     explicit using 1:2 @theory title 'explicit, our run', \
     data using 1:($1 == 24 ? $2 : NaN):(0.25) skip 5 with yerrorbars pt 0 lw 2 lc rgb gray notitle, \
     data using 1:2 skip 5 @published title 'full particle (Birn et al. 2001)', \
     data using 1:3 skip 5 with points pt 4 ps 1 lw 1.6 lc rgb green title 'hybrid', \
     data using 1:4 skip 5 with points pt 8 ps 1 lw 1.6 lc rgb amber title 'Hall MHD'
