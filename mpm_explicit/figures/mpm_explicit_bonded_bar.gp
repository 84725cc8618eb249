# Two halves of a bar, bonded, the left one held at its left end. A bond that holds makes one bar of them, which swings as theory says (dashed). A weaker one breaks when the stress at the joint
# reaches its strength: the outer half flies off with what momentum it has, and the inner one swings twice as fast.
wide = 1500; high = 1000
load 'common/style.gp'
folder = run; run = folder.'/breaks'
bar(key) = real(given('grain.left.'.key))
E = real(given('material.default.E')); rho = real(given('material.default.density')); L = 2 * bar('width'); H = bar('height'); v_0 = bar('amplitude')
k = pi / (2 * L); omega = k * sqrt(E / rho); T = 2 * pi / omega; unit = v_0 * sqrt(E * rho); mass = rho * L * H / 2
holds = folder.'/holds/history.dat'; breaks = folder.'/breaks/history.dat'
stress = col(holds, 'bond_normal_1'); left = col(holds, 'momentum_x_left'); right = col(holds, 'momentum_x_right')
strength = real(system(sprintf("LC_ALL=C awk '$1 == \"tension\" && $3 < 1e20 { s = $3 } END { print s }' '%s'/case.toml", run)))
breaks_at = real(entry('results.bond_breaks.expected')); measured_at = result('bond_breaks')
set multiplot title 'Two bonded halves of a bar' font ',24'
set xrange [0:2]; set xtics 0.5
set samples 1000
set lmargin at screen 0.1; set rmargin at screen 0.98
set tmargin at screen 0.86; set bmargin at screen 0.57
set title 'stress of the bond / (v_0 (E ρ)^{1/2})' offset 0, -0.5
set yrange [-0.9:1.9]; set ytics 0.5; set format x ''
set key at graph 0.98, 0.98 top right vertical samplen 1.5 font ',18'
plot holds using ($1 / T):(column(stress) / unit) with lines lt 1 title 'holds', breaks using ($1 / T):($1 <= measured_at + 0.02 ? column(stress) / unit : NaN) with lines lt 2 lw 4 title sprintf('breaks at %.3f T (theory %.3f T)', measured_at / T, breaks_at / T), \
     cos(k * L / 2) * sin(2 * pi * x) with lines lw 2 dt 2 lc rgb ink title 'theory of one bar', \
     '+' using (breaks_at / T):(strength / unit) every ::0::0 with points pt 7 ps 2 lc rgb orange notitle
set tmargin at screen 0.43; set bmargin at screen 0.12
set title 'momentum of the halves / (m v_0)'
set xlabel 't / T'; set format x '%g'
set yrange [-1.1:1.9]
# Of one bar: the integrals of sin over its halves.
inner = (1 - cos(k * L / 2)) / (k * L / 2); outer = cos(k * L / 2) / (k * L / 2)
set key at graph 0.5, 0.98 top center horizontal maxrows 2 samplen 2 font ',20'
plot holds using ($1 / T):(column(left) / (mass * v_0)) with lines lt 6 title 'inner', holds using ($1 / T):(column(right) / (mass * v_0)) with lines lt 1 title 'outer', \
     breaks using ($1 / T):(column(left) / (mass * v_0)) with lines lt 5 title 'inner, broken off', breaks using ($1 / T):(column(right) / (mass * v_0)) with lines lt 2 title 'outer, broken off', \
     inner * cos(2 * pi * x) with lines lw 2 dt 2 lc rgb ink notitle, outer * cos(2 * pi * x) with lines lw 2 dt 2 lc rgb ink notitle
unset multiplot
