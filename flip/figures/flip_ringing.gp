# "Ringing": growth of the noise in a uniform flow over a row of cells. It grows between Mach 0.07 and 0.19 as the mesh mistakes particles within its cells for waves; apic rings
# harder, viscosity and blends only damp it, and filtered velocities (xpic) or volumes that particles carry cure it. Right, the noise in time at Mach 0.14.
wide = 1500; high = 720
load 'common/style.gp'
folder = run
cures = 'flip apic blend viscosity xpic particles'
titles = "flip apic 'blend, 3 % pic' 'viscosity, linear 0.5' 'xpic of order 2' 'volumes of particles'"
machs = '0 0.03 0.06 0.08 0.1 0.12 0.14 0.16 0.18 0.2 0.25 0.3 0.4'
tint = blue.' '.orange.' '.green.' '.pink.' '.amber.' '.ink
growth(n, m) = (run = folder.'/'.word(cures, n).'-'.word(machs, m), result('growth'))
set multiplot title 'Ringing of a uniform flow' font ',24'
set bmargin at screen 0.14; set tmargin at screen 0.87
set lmargin at screen 0.105; set rmargin at screen 0.51
set xrange [0:0.4]; set xtics 0.1; set xlabel 'Mach number'
set yrange [-0.005:0.2]; set ytics 0.05; set ylabel 'growth / (c/Δx)' offset 0.5, 0
set key top right
plot for [n = 1:6] '+' using (real(word(machs, int($0) + 1))):(growth(n, int($0) + 1)) every ::0::12 with linespoints lc rgb word(tint, n) pt (n == 6 ? 6 : 7) ps (n == 6 ? 1.8 : 1.1) title word(titles, n)
set lmargin at screen 0.62; set rmargin at screen 0.97
file(n) = folder.'/'.word(cures, n).'-0.14/history.dat'
noise = col(file(1), 'noise')
set xrange [0:600]; set xtics 200; set xlabel 't c / Δx'
set logscale y; set yrange [1e-11:1]; set ytics 100; set mytics 1; set format y '10^{%T}'; set ylabel 'rms noise / c' offset 0.5, 0
unset key
plot for [n = 1:6] file(n) using 1:(column(noise)) every 20 with lines lc rgb word(tint, n)
unset multiplot
