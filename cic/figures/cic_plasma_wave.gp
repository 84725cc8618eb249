# Left: cold plasma waves should all have the frequency omega_p, and the mesh slows them; points are runs, curves the exact dispersion relations of the schemes.
# Right: the noise of a warm plasma rings at the root of the kinetic dispersion relation, more faintly the more that is damped, and faintly at 2 omega_p.
wide = 1500; high = 780
load 'common/style.gp'
dt = 0.2
leapfrog(w) = 2 / dt * asin(0.5 * dt * w)
c(x) = cos(0.5 * x)
spectrum = run.'/warm/spectrum.dat'
largest = real(system("LC_ALL=C awk '$1 + 0 == $1 && $2^2 * $3 > m { m = $2^2 * $3 } END { print m }' '".spectrum."'"))
set multiplot
set bmargin at screen 0.145; set tmargin at screen 0.89
set lmargin at screen 0.085; set rmargin at screen 0.475
set title 'cold plasma: runs and theory (lines)'
set xlabel 'k Δx'; set ylabel 'ω / ω_p' offset 1.2, 0
set xrange [0:pi]; set yrange [0:1.12]; set samples 400
set xtics ('0' 0, 'π/4' pi/4, 'π/2' pi/2, '3π/4' 3*pi/4, 'π' pi)
set key at graph 0.03, 0.03 bottom left
file(name) = run.'/'.name.'.dat'
K(m) = 2 * pi / 32 * m
plot leapfrog(1) with lines lt 3 notitle, leapfrog(sqrt((1 + 2 * c(x)**2) / 3)) with lines lt 4 notitle, \
     leapfrog(c(x)) with lines lt 1 notitle, leapfrog(c(x) * sqrt((2 + c(x)**2) / 3)) with lines lt 2 notitle, \
     file('cic_energy') using (K($1)):2 with points lt 3 ps 1.6 title 'cic, energy-conserving', \
     file('tsc_energy') using (K($1)):2 with points lt 4 ps 1.7 title 'tsc, energy-conserving', \
     file('cic_momentum') using (K($1)):2 with points lt 1 ps 1.6 title 'cic, momentum-conserving', \
     file('tsc_momentum') using (K($1)):2 with points lt 2 ps 1.4 title 'tsc, momentum-conserving'
set lmargin at screen 0.56; set rmargin at screen 0.905
set title 'noise of a warm plasma'
set xlabel 'k λ_D'
set xrange [0.00625:1.00625]; set yrange [0:2.5]; set xtics 0.2; set ytics 0.5
set border 15; unset grid; set tics front
eval colors(inferno)
set logscale cb; set cbrange [1e-4:1]; set format cb '10^{%T}'
set colorbox user origin 0.92, 0.145 size 0.013, 0.745
set label '|ρ|^2 / largest' at screen 0.99, 0.935 right
set key at graph 0.03, 0.78 top left textcolor rgb 'white'
plot spectrum using 2:1:($2**2 * $3 / largest) with image notitle, \
     sqrt(1 + 3 * x**2) with lines lc rgb 'white' lw 1.8 dt 3 title 'Bohm and Gross', \
     file('roots') using (0.0125 * $1):2 smooth csplines with lines lc rgb sky lw 1.8 dt 2 title 'kinetic root'
unspectrum = run.'/warm/spectrum.dat'
largest = real(system("LC_ALL=C awk '$1 + 0 == $1 && $2^2 * $3 > m { m = $2^2 * $3 } END { print m }' '".spectrum."'"))
set multiplot
