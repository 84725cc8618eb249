# Figure 14 of the talk: the kink (a, m_y = 1 of B_x) and the lower-hybrid drift instability (b, m_y = 4 of B_x) against time for three temperature ratios.
# Straight lines are fits of the second phase by the program; in brackets is what the talk says of that run.
wide = 1500; high = 760
load 'common/style.gp'
load 'implicit_moment/figures/kink.gp'
history(ratio) = folder(ratio).'/history.dat'
t = col(history('4'), 'time_Omega_ci'); B1 = col(history('4'), 'B_1'); B4 = col(history('4'), 'B_4')
talk_growth = '0.1 0.07 0.04'; talk_level = '6.5 3.5 1.5'
# Rates and windows are the program's; the height of a line is the mean of ln B_x - rate t over the window.
array rate[3]; array begin[3]; array end[3]; array height[3]
do for [k = 1:3] {
    ratio = word(ratios, k)
    rate[k] = found(ratio, 'kink_growth'); begin[k] = found(ratio, 'kink_growth_begin'); end[k] = found(ratio, 'kink_growth_end')
    height[k] = NaN
    if (rate[k] != rate[k]) { begin[k] = 0; end[k] = 1; continue }   # no growth was found
    stats history(ratio) using ((column(t) >= begin[k] && column(t) <= end[k]) ? log(column(B1)) - rate[k] * column(t) : NaN) nooutput name 'line'
    height[k] = exp(line_mean)
}
last = input('4', 'end') / input('4', 'light_over_alfven')

set multiplot title 'Thin current sheet: the kink, and the instability before it' font ',22'
set logscale y; set format y '10^{%L}'
set xrange [0:last]; set xtics 10 * ceil(last / 60)
set xlabel 't Ω_{ci}'
set tmargin at screen 0.82; set bmargin at screen 0.15
set key top left font ',17'

set lmargin at screen 0.085; set rmargin at screen 0.485
set title '(a) kink, m_y = 1: γ / Ω_{ci} (talk)' offset 0, -0.4
set ylabel 'rms over z of B_x(m_y = 1) / B_0' offset 0.5, 0
set yrange [1e-3:3]
plot for [k = 1:3] history(word(ratios, k)) using t:B1 with lines linetype k linewidth 1.6 \
         title sprintf('T_i/T_e = %s: %.2f (%s)', word(ratios, k), rate[k], word(talk_growth, k)), \
     for [k = 1:3] [begin[k]:end[k]] 1.5 * height[k] * exp(rate[k] * x) with lines linetype k linewidth 3 notitle

set lmargin at screen 0.585; set rmargin at screen 0.985
set title '(b) m_y = 4: level later × 1000 (talk)' offset 0, -0.4
set ylabel 'rms over z of B_x(m_y = 4) / B_0' offset 0.5, 0
set yrange [1e-4:1]
plot for [k = 1:3] history(word(ratios, k)) using t:B4 with lines linetype k linewidth 1.6 \
         title sprintf('T_i/T_e = %s: %.1f (%s)', word(ratios, k), 1e3 * found(word(ratios, k), 'lhdi_level'), word(talk_level, k))
unset multiplot
