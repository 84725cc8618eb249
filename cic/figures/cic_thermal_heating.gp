# A warm plasma at rest, 40 particles per cell. Left: kinetic energy after t = 1000/omega_p: where the mesh does not resolve the Debye length, schemes that conserve
# momentum heat. Right: they do until it is resolved, each in its own sense; the textbook's limit for cic is dashed.
wide = 1500; high = 780
load 'common/style.gp'
schemes = 'ngp_momentum cic_momentum tsc_momentum cic_energy'
titles = "ngp cic tsc 'cic, energy'"
tint = amber.' '.blue.' '.orange.' '.green
shapes = '13 7 5 9'
table(n) = run.'/'.word(schemes, n).'.dat'
history(n, ratio) = run.'/runs/'.word(schemes, n).'_'.ratio.'/history.dat'
t = col(history(1, '1'), 'time'); kinetic = col(history(1, '1'), 'kinetic')
# With T = 2 K/L and L = 64 dx, dx = lambda_D/ratio at the start.
debye_over_dx(K, ratio) = ratio * sqrt(2 * K * ratio / 64)
set multiplot title 'Heating of a plasma by its mesh' font ',24'
set bmargin at screen 0.15; set tmargin at screen 0.87
set lmargin at screen 0.085; set rmargin at screen 0.475
set logscale xy
set xrange [0.04:1.25]; set yrange [0.7:600]
set xtics ('0.05' 0.05, '0.1' 0.1, '0.2' 0.2, '1/π' 1/pi, '0.5' 0.5, '1' 1)
set ytics ('1' 1, '2' 2, '5' 5, '10' 10, '20' 20, '50' 50, '100' 100, '200' 200, '500' 500)
set xlabel 'λ_D / Δx at the start'; set ylabel 'kinetic energy at t ω_p = 1000 / initial' offset 0.5, 0
set key top right
plot for [n = 1:4] table(n) using 1:2 with linespoints pt int(word(shapes, n)) ps 1.8 lc rgb word(tint, n) title word(titles, n), \
     (x < 1 / pi ? (1 / (pi * x))**2 : NaN) with lines dt 2 lw 2 lc rgb ink title 'until λ_D = Δx/π'
set lmargin at screen 0.58; set rmargin at screen 0.965
unset logscale x
set xrange [0:1000]; set xtics 200; set xlabel 't ω_p'
set yrange [0.04:1.5]; set ytics ('0.05' 0.05, '0.1' 0.1, '0.2' 0.2, '1/π' 1/pi, '0.5' 0.5, '1' 1)
set ylabel 'λ_D / Δx' offset 0.5, 0
unset key
set arrow 1 from 0, 1/pi to 1000, 1/pi nohead dt 2 lw 2 lc rgb ink
plot for [ratio in '0.05 0.1 0.2 0.5'] for [n = 1:4] history(n, ratio) using t:(debye_over_dx(column(kinetic), real(ratio))) with lines lw 2 lc rgb word(tint, n)
unset multiplot
