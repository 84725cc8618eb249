# velocities.gp: a panel with f(v_x) at some times, f_times, to be loaded within a multiplot. A script sets of_v, what to add up of velocities_*.dat, e.g. '$2 + $3',
# and f_low, f_high.
f_times = near('velocities', f_times)
set xrange [v_low:v_high]; set xtics auto
set yrange [f_low:f_high]; set ytics auto
set xlabel v_label; set ylabel 'f(v_x) v_{th} / n_0' offset 0.5, 0
set key top right
if (exists('wave_speed')) { set arrow 81 from wave_speed, graph 0 to wave_speed, graph 1 nohead dashtype 2 linewidth 1.6 linecolor rgb gray; set label 81 'ω/k' at wave_speed, graph 0.95 offset -0.5, 0 right textcolor rgb gray }
plot for [k = 1:words(f_times)] file_at('velocities', real(word(f_times, k))) using 1:(@of_v) \
    with lines lt int(word('7 1 2 3', k)) title sprintf('t ω_p = %.4g', real(word(f_times, k)))
