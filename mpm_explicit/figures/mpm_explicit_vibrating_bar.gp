# A bar held at its left end swings in its lowest mode. Above: velocity of its center of mass, and energies. Below: velocity and stress of the particles over half a period, and theory (lines). The scheme
# swings a little too slowly, as its mesh is coarse, and keeps the energy.
# fits: mpm_explicit|mpm_implicit theory.compare=bar file:particles_*.dat result:frequency
wide = 1500; high = 1080
load 'common/style.gp'
E = real(given('material.*.E')); rho = real(given('material.*.density')); v_0 = real(given('grain.*.amplitude'))
L = real(given('grain.*.width')); H = real(given('grain.*.height')); k = (real(given('grain.*.mode')) - 0.5) * pi / L; omega = k * sqrt(E / rho); T = 2 * pi / omega; mass = rho * L * H
file = run.'/history.dat'
p_x = col(file, 'momentum_x'); kinetic = col(file, 'kinetic'); elastic = col(file, 'elastic'); energy = col(file, 'energy')
unit = mass * v_0**2 / 4
dt = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && n++ == 1 { print $1; exit }' '%s'", file)))
set multiplot title 'A bar held at one end' font ',24'
set xrange [0:5]; set xtics 1
set xlabel 't / period'
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.87; set bmargin at screen 0.605
set yrange [-0.8:1.6]; set ytics 0.4
set title 'velocity of the center of mass / v_0' offset 0, -0.5
set key top right horizontal
set samples 1000
plot file using ($1 / T):(column(p_x) / mass / v_0) with lines lt 1 title sprintf('frequency %+.2f %%', 100 * (result('frequency') / omega - 1)), 2 / pi * cos(2 * pi * x) with lines lt 2 dt 2 title 'theory'
set lmargin at screen 0.585; set rmargin at screen 0.98
set title 'energy / initial'
set yrange [0:1.5]; set ytics 0.5
plot file using ($1 / T):(column(energy) / unit) with lines lt 8 lw 2 title 'total', file using ($1 / T):(column(kinetic) / unit) with lines lt 1 title 'kinetic', \
     file using ($1 / T):(column(elastic) / unit) with lines lt 2 title 'elastic'
times = near('particles', sprintf('0 %g %g %g %g', T / 8, T / 4, 3 * T / 8, T / 2))
count = words(times)
t_of(n) = real(word(times, n))
file_of(n) = file_at('particles', t_of(n))
tint = blue.' '.sky.' '.green.' '.amber.' '.orange
set xrange [0:1.2]; set xtics 0.2
set xlabel 'x / L'
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.43; set bmargin at screen 0.12
set title 'v_x / v_0'
set yrange [-1.1:1.1]; set ytics 0.5
unset key
mark = 'with points pt 7 ps 0.7'
do for [n = 1:count] { set label n sprintf('%s%.3g T', n == 1 ? 't = ' : '', t_of(n) / T) at 1.03, cos(omega * t_of(n)) textcolor rgb word(tint, n) }
plot for [n = 1:count] file_of(n) using ($1 / L):($3 / v_0) @mark lc rgb word(tint, n), for [n = 1:count] (x < 1 ? sin(k * L * x) * cos(omega * t_of(n)) : NaN) with lines lw 1.5 lc rgb word(tint, n)
do for [n = 1:count] { unset label n }
set lmargin at screen 0.585; set rmargin at screen 0.98
set title 'σ_{xx} / (v_0 (E ρ)^{1/2})'
set yrange [-0.1:1.1]
# Stresses of leapfrog are half a step older.
older = entry('program') eq 'mpm_explicit' ? 0.5 * dt : 0
plot for [n = 1:count] file_of(n) using ($1 / L):($6 / (v_0 * sqrt(E * rho))) @mark lc rgb word(tint, n), \
     for [n = 1:count] (x < 1 ? cos(k * L * x) * sin(omega * (t_of(n) - older)) : NaN) with lines lw 1.5 lc rgb word(tint, n)
unset multiplot
