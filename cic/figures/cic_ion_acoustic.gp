# An ion-acoustic wave of small amplitude, the field of one mode; dashed: the frequency and the damping of the kinetic dispersion relation with the phase and the height of
# the run at its first maximum after one period.
wide = 1200; high = 640
load 'common/style.gp'
history = run.'/history.dat'
im = col(history, 'mode_im')
omega = result('theory_omega'); rate = result('theory_growth')
period = 2 * pi / omega
top = system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && $1 > %g && $1 < %g { if ($%d > m) { m = $%d; t = $1 } } END { print t, m }' '%s'", 0.9 * period, 1.9 * period, im, im, history))
t_1 = real(word(top, 1)); E_1 = real(word(top, 2))
phase = atan2(rate, omega)
set title "ion-acoustic wave, m_i/m_e = 25, T_e/T_i = 10, k λ_{De} = 0.5"
set xlabel 't ω_p'; set ylabel 'E_k / (m v_{th} ω_p/e)'
set xrange [0:parameter('end')]; set yrange [-1.5 * E_1:2 * E_1]
set samples 900
set key top right
plot history using 1:(column(im)) @measured title 'run', \
     '+' using 1:(E_1 * exp(rate * ($1 - t_1)) * cos(omega * ($1 - t_1) - phase) / cos(phase)) @theory title sprintf('theory, ω = %.4f ω_p, γ = %.5f ω_p', omega, rate)
