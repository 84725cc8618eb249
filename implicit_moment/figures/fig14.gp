# Figure 14 of the talk: the kink (a, m_y = 1 of B_x) and the lower-hybrid drift instability (b, m_y = 4 of B_x) against time for three temperature ratios and
# three seeds each (thin lines: seeds 2 and 3). Straight lines are the program's fits of the second phase, an exponential between two levels. In the
# legends are the means of the seeds, what the talk says, and by what factor they differ; levels are root mean squares over z and time, from
# t Ω_{ci} = 10 to the end.
# from: implicit_moment/data/thin_sheet_modes.csv, thin_sheet_runs.csv
wide = 1700; high = 800
load 'common/style.gp'
if (!exists('kept')) kept = 'implicit_moment/data'
set datafile separator ','
modes = kept.'/thin_sheet_modes.csv'; runs = kept.'/thin_sheet_runs.csv'
ratios = '4 2 1'; talk_growth = '0.1 0.07 0.04'; talk_level = '6.5e-3 3.5e-3 1.5e-3'
# Means of the seeds, and their errors: twice the standard error of their scatter, or their own, whichever is larger.
mean(ratio, c) = system(sprintf("awk -F, '$1 == %s && $%d != \"nan\" { n++; s += $%d; ss += $%d^2; e += $%d^2 } END { if (!n) { print \"nan nan 0\"; exit } m = s / n; v = n > 1 ? (ss / n - m^2) / (n - 1) : 0; v = v > 0 ? v : 0; a = 2 * sqrt(v); b = sqrt(e) / n; print m, (a > b ? a : b), n }' %s", ratio, c, c, c, c + 1, runs))
mean_of(k, c) = real(word(mean(word(ratios, k), c), 1))
error_of(k, c) = real(word(mean(word(ratios, k), c), 2))
seeds_of(k, c) = word(mean(word(ratios, k), c), 3)
of_run(k, seed, c) = real(system(sprintf("awk -F, '$1 == %s && $2 == %d { print $%d }' %s", word(ratios, k), seed, c, runs)))
series(k, seed) = sprintf("< awk -F, '$1 == %s && $2 == %d' %s", word(ratios, k), seed, modes)
stats modes using 3 nooutput name 'time'

# The height of a straight line: the mean of ln B_x - rate t over the window of the fit.
array height[3]
begin(k) = height[k] == height[k] ? of_run(k, 1, 6) : 0
end(k) = height[k] == height[k] ? of_run(k, 1, 7) : 1
do for [k = 1:3] {
    height[k] = NaN
    if (of_run(k, 1, 4) != of_run(k, 1, 4)) { continue }   # no growth was found
    stats series(k, 1) using ($3 >= of_run(k, 1, 6) && $3 <= of_run(k, 1, 7) ? log($4) - of_run(k, 1, 4) * $3 : NaN) nooutput name 'line'
    height[k] = exp(line_mean)
}

ends = system(sprintf("awk -F, '!/^#/ { print $3 }' %s | sort -gu | paste -sd, - | sed 's/,/, /g'", runs))
set multiplot title 'Thin current sheet: the kink, and the instability before it' font ',22'
if (real(system(sprintf("echo '%s' | cut -d, -f1", ends))) < time_max) { set label 9 sprintf('runs end at t Ω_{ci} = %s; the talk''s at 110', ends) at screen 0.53, screen 0.027 center font ',15' textcolor rgb orange }
set logscale y; set format y '10^{%L}'
set xrange [0:time_max]; set xtics 20
set xlabel 't Ω_{ci}'
set tmargin at screen 0.82; set bmargin at screen 0.13
set key top left font ',16' samplen 1.5

set lmargin at screen 0.075; set rmargin at screen 0.485
set title '(a) kink, m_y = 1: γ / Ω_{ci} (talk; ratio)' offset 0, -0.4
set ylabel 'rms over z of B_x(m_y = 1) / B_0' offset 0.5, 0
set yrange [1e-3:4]
plot for [k = 1:3] for [seed = 2:3] series(k, seed) using 3:4 with lines lc k lw 0.8 notitle, \
     for [k = 1:3] series(k, 1) using 3:4 with lines lc k lw 1.8 \
         title sprintf('T_i/T_e = %s: %.3f ± %.3f (%s; %.2f), %s of 3 seeds', word(ratios, k), mean_of(k, 4), error_of(k, 4), word(talk_growth, k), mean_of(k, 4) / real(word(talk_growth, k)), seeds_of(k, 4)), \
     for [k = 1:3] [begin(k):end(k)] 1.6 * height[k] * exp(of_run(k, 1, 4) * x) with lines lc k lw 3 notitle

set lmargin at screen 0.575; set rmargin at screen 0.985
set title '(b) m_y = 4: level × 1000 (talk; ratio)' offset 0, -0.4
set ylabel 'rms over z of B_x(m_y = 4) / B_0' offset 0.5, 0
set yrange [1e-4:1]
plot for [k = 1:3] for [seed = 2:3] series(k, seed) using 3:5 with lines lc k lw 0.8 notitle, \
     for [k = 1:3] series(k, 1) using 3:5 with lines lc k lw 1.8 \
         title sprintf('T_i/T_e = %s: %.1f ± %.1f (%.1f; %.2f)', word(ratios, k), 1e3 * mean_of(k, 10), 1e3 * error_of(k, 10), 1e3 * real(word(talk_level, k)), mean_of(k, 10) / real(word(talk_level, k)))
unset multiplot
