# Waves of a warm plasma across a magnetic field. Left: its noise rings at the roots of Bernstein's dispersion relation, one between each two harmonics of the gyrofrequency.
# Right: a seeded wave is several of them at once, and a part that stays; dashed: theory, the field that the seed gives to each mode, nothing fitted.
wide = 1500; high = 780
load 'common/style.gp'
spectrum = run.'/noise/spectrum.dat'
folder = run; run = folder.'/seeded'; Omega = real(given('plasma.B_y')); run = folder
largest = real(system("LC_ALL=C awk '$1 + 0 == $1 && $1 > 0.3 && $2^2 * $3 > m { m = $2^2 * $3 } END { print m }' '".spectrum."'"))
set multiplot
set bmargin at screen 0.145; set tmargin at screen 0.89
set lmargin at screen 0.08; set rmargin at screen 0.49
set title 'noise'
set xlabel 'k v_{th} / Ω_c'; set ylabel 'ω / Ω_c' offset 1.2, 0
set xrange [0.05:4.05]; set yrange [0:6]; set xtics 1; set ytics 1
set border 15; unset grid; set tics front
eval colors(inferno)
set logscale cb; set cbrange [1e-4:1]; set format cb '10^{%T}'
set colorbox user origin 0.505, 0.145 size 0.013, 0.745
set label 1 '|ρ|^2 / largest' at screen 0.575, 0.935 right
set key at graph 0.98, 0.97 top right textcolor rgb 'white'
plot spectrum skip 1 using 2:($1 / Omega):($2**2 * $3 / largest) with image notitle, \
     for [n = 2:6] run.'/modes.dat' using 1:(column(n) / Omega) with lines lc rgb sky lw 1.8 dt 2 title (n == 2 ? 'Bernstein modes' : '')
unset label 1; unset colorbox; unset logscale cb; set border 3; set grid
set lmargin at screen 0.66; set rmargin at screen 0.98
history = run.'/seeded/history.dat'
im = col(history, 'mode_im')
E_0 = first(history, 'mode_im')
seeds = system(sprintf("sed 1d '%s/seeds.dat'", run))
count = words(seeds) / 2
omega(n) = real(word(seeds, 2 * n - 1)); E(n) = real(word(seeds, 2 * n))
rest = E_0 - 2 * (sum [n = 1:count] E(n))
set title 'seeded wave, k v_{th} / Ω_c = 1'
set xlabel 't ω_p'; set ylabel 'E_k / E_k(0)' offset 1, 0
set xrange [0:60]; set yrange [-0.8:1.4]; set xtics 20; set ytics 0.5
set samples 900
set key top right textcolor rgb ink
plot history using 1:(column(im) / E_0) @measured title 'run', \
     '+' using 1:((rest + 2 * (sum [n = 1:count] E(n) * cos(omega(n) * $1))) / E_0) @theory title 'sum of the modes'
unset multiplot
