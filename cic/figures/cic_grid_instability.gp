# A cold beam, alone with a fixed background, v_0 = 0.1 omega_p dx: nothing physical can happen, but aliases of its own waves resonate with it. Above, phase space at
# saturation (color) and at the end (gray). Below, growth at the rate of the dispersion relation on the mesh; then schemes that conserve momentum heat, the one that
# conserves energy stops the beam.
wide = 1500; high = 1080
load 'common/style.gp'
folder = run
schemes = 'ngp_momentum cic_momentum tsc_momentum cic_energy'
titles = "ngp cic tsc 'cic, energy'"
tint = amber.' '.blue.' '.orange.' '.green
scheme(n) = folder.'/'.word(schemes, n)
file(n) = scheme(n).'/history.dat'
# The k-th file of particles after the start.
particles(n, k) = (run = scheme(n), files = times_of('particles', 1000), file_at('particles', real(word(files, k < 0 ? words(files) : k + 1))))
t = col(file(1), 'time'); energy = col(file(1), 'energy'); kinetic = col(file(1), 'kinetic'); momentum = col(file(1), 'momentum_x')
run = scheme(1); L = parameter('length_x'); end = real(given('time.end'))
v_th(K, P) = sqrt(abs(2 * K / L - (P / L)**2))
set multiplot title 'A cold beam heated by the mesh, v_0 = 0.1 ω_p Δx (gray: at the end)' font ',24'
set border 15; set tics front; unset key
set bmargin at screen 0.545; set tmargin at screen 0.865
set xrange [0:12]; set yrange [-0.6:0.7]
set xtics 0, 4, 8; set xlabel 'x / Δx'
do for [n = 1:4] {
    left = 0.085 + (n - 1) * 0.2275
    set lmargin at screen left; set rmargin at screen left + 0.21
    late = particles(n, -1); early = particles(n, 1)
    set title sprintf('%s, t ω_p = %.3g', word(titles, n), time_of(early)) offset 0, -0.6
    if (n == 1) { set ylabel 'v_x / (ω_p Δx)' offset 1, 0; set ytics 0.2 } else { unset ylabel; set ytics 0.2 format '' }
    set arrow 1 from 0, 0.1 to 12, 0.1 nohead dashtype 2 linewidth 1.6 linecolor rgb ink
    plot late using "x":"v_x" with points pt 7 ps 0.4 lc rgb '#c4c4c4', early using "x":"v_x" with points pt 7 ps 0.6 lc rgb word(tint, n)
}
unset title; unset arrow 1; set border 3
set bmargin at screen 0.1; set tmargin at screen 0.42
set xrange [0:end]; set xtics end / 4; set xlabel 't ω_p'
# Where v_th passes 1e-3, and the rate of theory there.
passes(n) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && sqrt((2 * $%d / %g - ($%d / %g)^2)^2) > 1e-6 { print $1; exit }' '%s'", kinetic, L, momentum, L, file(n))))
array since[4]; array rate[4]
at_end(n) = real(system(sprintf("LC_ALL=C awk 'END { print sqrt(2 * $%d / %g - ($%d / %g)^2) }' '%s'", kinetic, L, momentum, L, file(n))))
set label 5 'at the end' at graph 0.97, 0.42 right font ',17'
do for [n = 1:4] { set label 5 + n sprintf('%s %.2f', word(titles, n), at_end(n)) at graph 0.97, 0.42 - 0.085 * n right textcolor rgb word(tint, n) font ',17' }
do for [n = 2:4] { run = scheme(n); rate[n] = result('theory_growth'); since[n] = passes(n) }
set lmargin at screen 0.085; set rmargin at screen 0.325
set logscale y; set format y '10^{%T}'; set yrange [1e-7:10]; set ytics 100; set mytics 1
set ylabel 'v_{th} / (ω_p Δx)' offset 1, 0
plot for [n = 1:4] file(n) using t:(v_th(column(kinetic), column(momentum))) with lines lc rgb word(tint, n), \
     for [n = 2:4] 1e-3 * exp(rate[n] * (x - since[n])) with lines dt 2 lw 2 lc rgb ink
do for [n = 5:9] { unset label n }
set lmargin at screen 0.42; set rmargin at screen 0.65
set format y '%g'; set yrange [0.7:100]; set ytics (1, 2, 5, 10, 20, 50, 100)
set ylabel 'total energy / initial' offset 1, 0
plot for [n = 1:4] file(n) using t:(column(energy) / first(file(n), 'energy')) with lines lc rgb word(tint, n)
unset logscale y; set mytics default
set lmargin at screen 0.75; set rmargin at screen 0.975
set yrange [-0.4:1.2]; set ytics 0.4
set ylabel 'momentum / initial' offset 1, 0
set label 5 'ngp, cic, tsc' at 195, 1.07 right font ',17'; set label 6 'cic, energy' at 195, 0.06 right font ',17' textcolor rgb green
plot for [n = 1:4] file(n) using t:(column(momentum) / 6.4) with lines lc rgb word(tint, n)
unset multiplot
