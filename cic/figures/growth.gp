# growth.gp: a panel with the growth of a wave against theory, to be loaded within a multiplot. The line of theory goes through the predicted onset: nothing is fitted. Where
# a run predicts none, the line has the predicted slope and the height of the run within the times of the fit, of a growing wave within their later half. A script sets growth_floor, growth_top and marks,
# times to mark above the frame, and may set field_label, growth_key, other, the folder of a run to compare with, and other_title, in its color.
if (!exists('field_label')) field_label = '|E_k| / (m v_0 ω_p/e)'
if (!exists('other')) { other = ''; other_title = '' }
if (!exists('growth_key')) growth_key = 'bottom right'
history = run.'/history.dat'
t = col(history, 'time'); re = col(history, 'mode_re'); im = col(history, 'mode_im')
abs_E(n) = sqrt(column(re)**2 + column(im)**2)
rate = result('theory_growth')
onset = entry('results.onset.expected')
if (onset ne '') {
    # A tenth of the field in which electrons bounce as fast as the wave grows.
    wave_number = 2 * pi * sqrt((result('mode_x') / parameter('length_x'))**2 + (parameter('dimensions') == 2 ? (parameter('mode_z') / parameter('length_z'))**2 : 0))
    height = log(0.1 * rate**2 / wave_number) - rate * real(onset)
    set arrow 91 from real(onset), exp(height + rate * real(onset)) to real(onset), graph 1 nohead dashtype 3 linewidth 2 linecolor rgb gray
    set label 91 "predicted\nonset" at real(onset), graph 0.95 offset -0.6, 0 right textcolor rgb gray font ',17'
} else {
    fitted = entry('results.growth.source')
    fitted = fitted[strstrt(fitted, 'from t = ') + 9 :]
    begin = real(word(fitted, 1)); end = real(word(fitted, 3)); if (rate > 0) { begin = 0.5 * (begin + end) }
    height = real(system(sprintf("LC_ALL=C awk '$%d >= %.9g && $%d <= %.9g { sum += 0.5 * log($%d^2 + $%d^2) - %.15g * $%d; n++ } END { print sum / n }' '%s'", \
        t, begin, t, end, re, im, rate, t, history)))
}
if (!exists('growth_floor')) {
    growth_top = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { E = $%d^2 + $%d^2; if (E > m) m = E } END { print 10 * sqrt(m) }' '%s'", re, im, history)))
    growth_floor = growth_top * (rate > 0 ? 1e-8 : 1e-6)
}
set yrange [1:2]; set logscale y; set format y '10^{%T}'
set xrange [0:parameter('end')]; set xtics auto
set yrange [growth_floor:growth_top]; set ytics auto
set xlabel 't ω_p'; set ylabel field_label offset 0.5, 0
set key @growth_key
set label 91 + words(marks) + 1 other_title at graph 0.98, 0.07 right textcolor rgb green
do for [k = 1:words(marks)] { set label 91 + k '▼' at real(word(marks, k)), graph 1.045 center textcolor rgb ink font ',13' }
plot (other eq '' ? run : other).'/history.dat' using t:(abs_E(0)) with lines lt 3 lw 1.8 notitle, \
     history using t:(abs_E(0)) @measured title sprintf('measured, γ = %.4g ω_p', result('growth')), \
     '+' using 1:(exp(height + rate * $1)) @theory title sprintf('theory, γ = %.4g ω_p', rate)
unset arrow 91
do for [k = 0:words(marks) + 1] { unset label 91 + k }
unset logscale y; set format y '%g'; set xrange [*:*]; set yrange [*:*]
