# Between a source (left) and a floating wall (right), means of the second half of the run. Electrons are faster than ions, so the wall charges up until it turns most of
# them back: none comes back faster than those that just did not reach it (dashed). Ions are only accelerated. Dashed in all panels: the theory of Schwager and Birdsall.
# fits: cic theory.compare=sheath file:fields_*.dat file:phase_*.dat file:particles_*.dat result:plasma_potential
wide = 1500; high = 1080
load 'common/style.gp'
M = real(given('species.ions.mass')) / real(given('species.electrons.mass'))
second_half = sprintf('LC_ALL=C awk -v first=%d -f cic/figures/mean_of_files.awk ', int(0.5 * parameter('end') / parameter('dt')))
$fields << EOD
EOD
set print $fields; print system(second_half.'"'.run.'"/fields_*.dat'); unset print
$f << EOD
EOD
set print $f; print system(second_half.'"'.run.'"/phase_*.dat'); unset print
fields = run.'/fields_000000.dat'
phi = col(fields, 'phi'); n_e = col(fields, 'particles_electrons'); n_i = col(fields, 'particles_ions')
history = run.'/history.dat'
t = col(history, 'time'); wall = col(history, 'potential_x_high'); middle = col(history, 'potential_middle')
L = parameter('length_x')
weight = parameter('density') * L / parameter('cells_x') / parameter('particles_per_cell')
# The theory of sheath_theory.hpp for T_i = T_e: potentials in T_e/e, lengths in Debye lengths of the plasma.
P = real(entry('results.plasma_potential.expected')); C = real(entry('results.collector_potential.expected'))
g(y) = exp(y) * erfc(sqrt(y))
one_plus_erf(h) = 1 + erf(sqrt(h > 0 ? h : 0))
electrons(p) = exp(p - P) * one_plus_erf(p - C) / one_plus_erf(P - C)
ions(p) = g(-p) / g(-P)
momentum(p) = electrons(p) - 2 / sqrt(pi) * exp(C - P) * sqrt(p > C ? p - C : 0) / one_plus_erf(P - C) + (g(-p) + 2 * sqrt(-p / pi)) / g(-P)
field(p) = sqrt(2 * abs(momentum(p) - momentum(P)))
# From an edge into the plasma, p - P = (edge - P) / cosh^2 u, and the distance is the integral of dp / field.
du = acosh(100.0) / 100
p_of(edge, u) = P + (edge - P) / cosh(u)**2
slope(edge, u) = 2 * abs(edge - P) * tanh(u) / cosh(u)**2 / field(p_of(edge, u))
distance(edge, n) = n < 1 ? 0 : sum [i = 0:n - 1] du * slope(edge, (i + 0.5) * du)
set table $source; plot sample [n = 0:100:1] '+' using (distance(0, int(n))):(p_of(0, n * du)); unset table
set table $wall; plot sample [n = 0:100:1] '+' using (L - distance(C, int(n))):(p_of(C, n * du)); unset table
by_theory = "with lines dashtype 2 linewidth 2.4 linecolor rgb ink"
set multiplot title sprintf('A floating wall in front of a plasma, m_i = %g m_e, T_i = T_e', M) font ',24'
set bmargin at screen 0.61; set tmargin at screen 0.9
set xrange [0:L]; set xtics 6; set xlabel 'x / λ_D'
set lmargin at screen 0.085; set rmargin at screen 0.325
set ylabel 'φ / (T_e/e)' offset 1, 0
set yrange [-1.6:0]; set ytics 0.4
set key bottom left
plot $fields using 1:(column(phi)) with lines lt 1 title 'mean', $source using 1:2 @by_theory title 'theory', $wall using 1:2 @by_theory notitle
set lmargin at screen 0.415; set rmargin at screen 0.655
set ylabel 'density / n_0'
set yrange [0:1.8]; set ytics 0.4
plot $fields using 1:(weight * column(n_e)) with lines lt 1 title 'electrons', $fields using 1:(weight * column(n_i)) with lines lt 2 title 'ions', \
     $source using 1:(electrons($2)) @by_theory notitle, $wall using 1:(electrons($2)) @by_theory notitle, \
     $source using 1:(ions($2)) @by_theory notitle, $wall using 1:(ions($2)) @by_theory notitle
set lmargin at screen 0.74; set rmargin at screen 0.965
set xrange [0:parameter('end')]; set xtics 1000; set xlabel 't ω_p'
set ylabel 'φ / (T_e/e)'
set yrange [-2:0]; set ytics 0.5
unset key
set label 1 'middle' at graph 0.97, first -0.62 right; set label 2 'wall' at graph 0.97, first -1.78 right
plot history using t:(column(middle)) every 10 with lines lt 6 lw 1, history using t:(column(wall)) every 10 with lines lt 1 lw 1, P @by_theory notitle, C @by_theory notitle
unset label 1; unset label 2
set bmargin at screen 0.1; set tmargin at screen 0.44
set border 15; set tics front; unset grid; unset key
set xrange [0:L]; set xtics 6; set xlabel 'x / λ_D'
set lmargin at screen 0.09; set rmargin at screen 0.425
set title 'electrons' offset 0, -0.6
set ylabel 'v_x / (T_e/m_e)^{1/2}' offset -0.4, 0
set yrange [-3:4]; set ytics 1
eval colors(inferno); set cbrange [0:0.6]; set cbtics 0.2
set colorbox user origin 0.435, 0.1 size 0.012, 0.34
set label 1 'f v_{th}/n_0' at screen 0.435, 0.467 left
plot $f using 1:2:3 with image, \
     $source using 1:(-sqrt(2 * ($2 - C))) with lines dt 2 lw 2.4 lc rgb 'white', $wall using 1:(-sqrt(2 * ($2 - C))) with lines dt 2 lw 2.4 lc rgb 'white'
unset label 1; set grid
set lmargin at screen 0.58; set rmargin at screen 0.965
set title 'ions'
set ylabel 'v_x / (T_e/m_i)^{1/2}'
set yrange [0:5]; set ytics 1
plot file_at('particles', parameter('end')) using ($1 == 1 ? $2 : NaN):(sqrt(M) * column("v_x")) with points pt 7 ps 0.1 lc rgb orange, \
     $source using 1:(sqrt(-2 * $2)) @by_theory, $wall using 1:(sqrt(-2 * $2)) @by_theory
unset multiplot
