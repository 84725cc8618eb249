# Two clouds of opposite charge. Left: overlapping, they swing through each other harmonically, at the frequency of theory (dashed), where points would fall into each
# other; nearest grid points kick the pair. Right: the force between pairs that pass through each other in eight places of the mesh: Coulomb's outside,
# linear inside, and the smoother the wider the clouds; with ngp it is a staircase.
wide = 1500; high = 780
load 'common/style.gp'
folder = run
weightings = 'ngp cic tsc'
tint = amber.' '.blue.' '.orange
file(n, what) = folder.'/'.word(weightings, n).'_'.what.'/history.dat'
t = col(file(1, 'swinging'), 'time'); separation = col(file(1, 'swinging'), 'separation_x')
array omega[3]
do for [n = 1:3] { run = folder.'/'.word(weightings, n).'_swinging'; omega[n] = result('omega') / result('omega_over_theory') }
run = folder.'/cic_passing_0'
mass(name) = real(given('species.'.name.'.mass'))
q = real(given('species.a.charge')); m = mass('a') * mass('b') / (mass('a') + mass('b')); dt = parameter('dt'); L = parameter('length_x')   # m: the reduced mass
set multiplot title 'Two clouds pass through each other' font ',24'
set bmargin at screen 0.15; set tmargin at screen 0.87
set lmargin at screen 0.085; set rmargin at screen 0.475
set xlabel 't ω_p / 1000'; set ylabel 'separation / Δx' offset 0.5, 0
set xrange [0:3]; set yrange [-0.2:0.4]; set xtics 0.5; set ytics 0.1
set key top right
set samples 400
plot for [n = 1:3] file(n, 'swinging') using (column(t) / 1000):(column(separation)) with lines lc rgb word(tint, n) title word(weightings, n), \
     for [n = 1:3] first(file(1, 'swinging'), 'separation_x') * cos(1000 * omega[n] * x) with lines dt 2 lw 2 lc rgb ink title (n == 1 ? 'linear force' : '')
set lmargin at screen 0.58; set rmargin at screen 0.975
set xlabel 'separation r / Δx'; set ylabel 'attraction / (q^2/Δx)' offset 0.5, 0
set xrange [0:5]; set yrange [0:0.35]; set xtics 1; set ytics 0.05
older = 0; old = 0
# mu d^2r/dt^2 about the step before
force(r) = (step = (r - 2 * old + older) / dt**2, middle = old, older = old, old = r, -m * step * sgn(middle) / q**2)
array slope[3]
do for [n = 1:3] { slope[n] = omega[n]**2 * m / q**2 }
plot for [n = 1:3] for [place = 0:7] file(n, 'passing_'.place) using (F = force(column("separation_x")), $0 > 1 ? abs(middle) : NaN):(F) with points pt 7 ps 0.25 lc rgb word(tint, n) notitle, \
     for [n = 1:3] NaN with points pt 7 ps 1.2 lc rgb word(tint, n) title word(weightings, n), \
     1 / (2 * pi * x) - x / (2 * L**2) with lines lt 8 lw 2 title "Coulomb's law, 1/(2πr)", \
     (x < 1.2 ? slope[2] * x : NaN) with lines dt 2 lw 2 lc rgb ink title 'linear force, cic'
unset multiplot
