# Nonlinear stability: one free node, leapfrog. Above: its orbit, and the curve on which [MPM-14] is what it was at the start; up to omega dt = 2 an ellipse, beyond a hyperbola, along which the orbit
# leaves, changing sides at every step. Below: both invariants stay what they are, and say nothing of the kinetic energy as soon as they are not positive.
wide = 1500; high = 1060
load 'common/style.gp'
folder = run
steps = '0.5 1.9 2.02'
file(n) = folder.'/omega_dt_'.word(steps, n).'/history.dat'
kinetic = col(file(1), 'kinetic'); energy_14 = col(file(1), 'energy_14'); energy_15 = col(file(1), 'energy_15'); p_x = col(file(1), 'momentum_x')
row(n, what, k) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && n++ == %d { print $%d; exit }' '%s'", k, what, file(n))))
K_0 = row(1, kinetic, 0)
set multiplot title 'One free node, leapfrog' font ',24'
set samples 2000
gap = 0.06; panel = (0.975 - 0.085 - 2 * gap) / 3
# v before, now and after: omega (mean x) = -(v_after - v_before) / (2 omega dt)
before = 0; now = 0
orbit(v, w) = (before = now, now = after, after = v, (before - after) / (2 * w))
do for [n = 1:3] {
    w = real(word(steps, n)); q = 1 - w**2 / 4
    set lmargin at screen 0.085 + (n - 1) * (panel + gap); set rmargin at screen 0.085 + (n - 1) * (panel + gap) + panel
    set tmargin at screen 0.86; set bmargin at screen 0.86 - panel * wide / high
    set title sprintf('ω Δt = %s', word(steps, n)) offset 0, -0.3
    set xlabel 'v / v_0'
    if (n == 1) { set ylabel 'ω x / v_0' offset 0.5, 0 } else { unset ylabel }
    span = n == 3 ? 4 : 1.3; tall = n == 1 ? 1.3 : n == 2 ? 0.4 : 0.6
    set xrange [-span:span]; set yrange [-tall:tall]
    eval (n == 3 ? 'set xtics 2; set ytics 0.2' : n == 2 ? 'set xtics 0.5; set ytics 0.1' : 'set xtics 0.5; set ytics 0.5')
    unset key
    before = 0; now = 0; after = 0
    # The momentum of nodes on the walls never changes; it is what keeps  p_after - 2p + p_before = -(omega dt)^2 (p - p_walls)  from being exact with p_walls = 0.
    p_walls = (row(n, p_x, 0) + row(n, p_x, 2) - (2 - w**2) * row(n, p_x, 1)) / w**2
    p_0 = row(n, p_x, 0) - p_walls
    plot (q * (1 - x**2) >= 0 ? sqrt(q * (1 - x**2)) : NaN) with lines lt 2, (q * (1 - x**2) >= 0 ? -sqrt(q * (1 - x**2)) : NaN) with lines lt 2, \
         file(n) every ::0::41 using (X = orbit((column("momentum_x") - p_walls) / p_0, w), $0 > 1 ? now : NaN):(X) with points pt 7 ps 0.9 lc rgb blue
}
do for [n = 1:3] {
    w = real(word(steps, n)); q = 1 - w**2 / 4
    set lmargin at screen 0.085 + (n - 1) * (panel + gap); set rmargin at screen 0.085 + (n - 1) * (panel + gap) + panel
    set tmargin at screen 0.37; set bmargin at screen 0.1
    unset title; dt = row(n, 1, 1)
    set xlabel 'steps'; set xrange [0:40]; set xtics 10
    if (n == 1) { set ylabel 'energy / initial kinetic' offset 0.5, 0 } else { unset ylabel }
    if (n < 3) {
        set yrange [-0.1:2.4]; set ytics 0.5
        set key top left
        plot file(n) using ($1 / dt):(column(kinetic) / K_0) with linespoints lt 1 lw 1.5 ps 0.7 title 'kinetic', file(n) using ($1 / dt):(column(energy_14) / K_0) with lines lt 2 title '[MPM-14]', \
             file(n) using ($1 / dt):(column(energy_15) / K_0) every 4 with points pt 6 ps 1.4 lw 2 lc rgb green title '[MPM-15]'
    } else {
        set logscale y; set yrange [1e-3:1e18]; set ytics 1e-2, 1e4; set format y '10^{%T}'
        rate = 2 * acosh(w / 2)
        plot file(n) using ($1 / dt):(column(kinetic) / K_0) with linespoints lt 1 lw 1.5 ps 0.7 title 'kinetic', (1 + cosh(2 * rate * x)) / 2 with lines lt 8 dt 2 lw 2 title 'theory', \
             file(n) using ($1 / dt):(-column(energy_14) / K_0) with lines lt 2 title '−[MPM-14]', \
             file(n) using ($1 / dt):(-column(energy_15) / K_0) every 4 with points pt 6 ps 1.4 lw 2 lc rgb green title '−[MPM-15]'
    }
}
unset multiplot
