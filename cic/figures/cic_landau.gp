# Landau damping. Left: small waves fall at the rates of the kinetic dispersion relation. Right: a large one, k lambda_D = 0.5, does only at first. Below: why. Electrons
# near its phase velocity are trapped and bounce (v_x > 0 is shown; the standing wave does the same to v_x < 0); as they turn around, the wave comes back. The line of k lambda_D = 0.5 ends in noise.
wide = 1500; high = 1080
load 'common/style.gp'
folder = run
# Height of the line of theory: the first maximum of the wave after the transient, at t = 4 ... 7.
peak(file, rate) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && $1 > 4 && $1 < 7 { a = 0.5 * log($%d^2 + $%d^2) - %g * $1; if (n++ == 0 || a > m) m = a } END { print m }' '%s'", \
    col(file, 'mode_re'), col(file, 'mode_im'), rate, file)))
names = '0.3 0.4 0.5 trapping'
array start[4]; array rate[4]; array height[4]; array file[4]
do for [n = 1:4] {
    run = folder.'/'.word(names, n)
    file[n] = run.'/history.dat'
    rate[n] = result('theory_growth')
    height[n] = peak(file[n], rate[n])
    start[n] = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print sqrt($%d^2 + $%d^2); exit }' '%s'", col(file[n], 'mode_re'), col(file[n], 'mode_im'), file[n])))
}
re = col(file[1], 'mode_re'); im = col(file[1], 'mode_im')
set multiplot title 'Landau damping of Langmuir waves' font ',24'
set bmargin at screen 0.57; set tmargin at screen 0.87
set logscale y; set format y '10^{%T}'
set xlabel 't ω_p'; set ylabel '|E_k| / |E_k(0)|' offset 0.5, 0
set xrange [0:60]
set lmargin at screen 0.085; set rmargin at screen 0.52
set title 'small amplitude (dashes: theory)' offset 0, -0.6
set yrange [1e-4:300]
set key top right
plot for [n = 1:3] file[n] using 1:(sqrt(column(re)**2 + column(im)**2) / start[n]) with lines lt n notitle, \
     for [n = 1:3] NaN with lines lt n title sprintf('k λ_D = %s, γ = %.4f ω_p', word(names, n), rate[n]), \
     for [n = 1:3] exp(height[n] + rate[n] * x) / start[n] with lines lc rgb ink dt 2 lw 2 notitle
set lmargin at screen 0.6; set rmargin at screen 0.97
set title sprintf('k λ_D = 0.5, density amplitude 0.4 n_0')
set yrange [1e-3:30]
unset ylabel
plot file[4] using 1:(sqrt(column(re)**2 + column(im)**2) / start[4]) with lines lt 3 notitle, \
     exp(height[4] + rate[4] * x) / start[4] with lines lc rgb ink dt 2 lw 2 title 'theory of small amplitudes'
unset logscale y
run = folder.'/trapping'
times = '5 15 35 50'
x_label = 'x / λ_D'; v_label = 'v_x / v_{th}'; v_low = 1; v_high = 4.5; v_step = 1
density = '$3'; density_top = 0.06; density_step = 0.02
wave_speed = result('theory_omega') / (2 * pi / parameter('length_x'))
row_bottom = 0.105; row_top = 0.395
load 'cic/figures/phase_row.gp'
unset multiplot
