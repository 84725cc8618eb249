# What one time step does to a sound wave, measured on particles (points) and by theory (lines). Left, implicit pressure: for theta >= 1/2 no step, however long, makes it grow;
# beyond a = 1 theta decides how fast it dies. Right, the explicit step: the wave grows by (gamma - 1)/(4 gamma) a^2, and is lost where particles forget their velocities.
wide = 1500; high = 720
load 'common/style.gp'
folder = run
thetas = '0.5 0.55 0.6 1'; long_steps = '0.1 0.3 1 3 10 30 100'
transfers = 'flip apic pic'; short_steps = '0.005 0.01 0.02 0.04 0.08'
# Per step; the wave is as much in the velocity as in the pressure.
growth(name, a) = (run = folder.'/'.name.'-'.a, 0.5 * log(result('amplitude_per_period') * result('pressure_amplitude_per_period')) * real(a) / (2 * pi))
set multiplot title 'A sound wave: factor per time step' font ',24'
set bmargin at screen 0.14; set tmargin at screen 0.82
set logscale x; set format x '10^{%T}'; set xlabel 'c k Δt'
set lmargin at screen 0.09; set rmargin at screen 0.47
set xrange [0.05:200]; set yrange [0:1.1]; set ytics 0.2
set title 'implicit pressure' offset 0, -0.5; set ylabel 'amplitude after / before' offset 0.5, 0
set key bottom left
plot for [n = 1:4] sqrt((1 + (1 - word(thetas, n))**2 * x**2) / (1 + word(thetas, n)**2 * x**2)) with lines lt n notitle, \
     for [n = 1:4] '+' using (real(word(long_steps, int($0) + 1))):(exp(growth(word(thetas, n), word(long_steps, int($0) + 1)))) every ::0::6 with points lt n pt 7 ps 1.4 notitle, \
     for [n = 1:4] NaN with linespoints lt n pt 7 ps 1.4 title 'θ = '.word(thetas, n)
set lmargin at screen 0.58; set rmargin at screen 0.97
set xrange [0.004:0.12]; set yrange [5e-7:0.3]; set logscale y; set format y '10^{%T}'; set ytics 10
set title 'explicit' offset 0, -0.5; set ylabel '|growth| of the amplitude' offset 0.5, 0
set key top left
tint = blue.' '.green.' '.orange
h = 2 * pi / 64; gamma = 1.4
plot (gamma - 1) / (4 * gamma) * x**2 with lines dt 2 lw 2 lc rgb ink title '(γ - 1)/(4γ) (c k Δt)^2', \
     h**2 / 12 - (gamma - 1) / (4 * gamma) * x**2 with lines dt 3 lw 2 lc rgb orange title 'decay, (kΔx)^2/12 - growth', \
     for [n = 1:3] '+' using (real(word(short_steps, int($0) + 1))):(abs(growth(word(transfers, n), word(short_steps, int($0) + 1)))) every ::0::4 with points pt (n == 2 ? 6 : 7) ps (n == 2 ? 2.2 : 1.4) lw 2 lc rgb word(tint, n) title word(transfers, n)
unset multiplot
