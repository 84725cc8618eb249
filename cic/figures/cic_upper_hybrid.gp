# A cold plasma wave across a magnetic field. Left: its frequency, the upper hybrid one; points are runs. Middle: the field swings about a part that stays, because the
# magnetic field does not let go of the electrons. Right: the velocity of an electron runs around an ellipse, rounder in a stronger field. Dashed: theory.
wide = 1500; high = 700
load 'common/style.gp'
A = 1e-4   # displacement
fields = '0.5 1 2'
omega(B) = sqrt(1 + B**2)
file(B) = run.'/runs/'.B.'/history.dat'
re = col(file('1'), 'mode_re'); im = col(file('1'), 'mode_im')
E_0 = 1e-4
set multiplot title 'Upper hybrid oscillations of a cold plasma' font ',24'
set bmargin at screen 0.165; set tmargin at screen 0.81
set lmargin at screen 0.08; set rmargin at screen 0.32
set title 'frequency'
set xlabel 'Ω_c / ω_p'; set ylabel 'ω / ω_p' offset 1, 0
set xrange [0:2.2]; set yrange [0.4:2.4]; set xtics 0.5; set ytics 0.4
set key bottom right
plot omega(x) with lines lt 8 lw 2 dt 2 title '(ω_p^2 + Ω_c^2)^{1/2}', run.'/frequencies.dat' using 1:2 with points lt 1 ps 1.8 title 'runs'
set lmargin at screen 0.4; set rmargin at screen 0.645
set title 'field'
set xlabel 't ω_p'; set ylabel 'E_k / E_k(0)'
set xrange [0:15]; set yrange [-1:1.25]; set xtics 5; set ytics 0.5
unset key
set samples 400
plot for [n = 1:3] file(word(fields, n)) using 1:(column(im) / E_0) with lines lt n notitle, \
     for [n = 1:3] (real(word(fields, n))**2 + cos(omega(real(word(fields, n))) * x)) / omega(real(word(fields, n)))**2 with lines dt 2 lw 2 lc rgb ink notitle
set lmargin at screen 0.735; set rmargin at screen 0.98
set title 'velocity of an electron'
set xlabel 'v_x / (ω_p ξ_0)'; set ylabel 'v_z / (ω_p ξ_0)'
set xrange [-1:1]; set yrange [-1.4:1.06]; set xtics 0.5; set ytics 0.5
set key top center
set parametric; set trange [0:2 * pi]
plot for [n = 1:3] sin(t) / omega(real(word(fields, n))), real(word(fields, n)) / omega(real(word(fields, n)))**2 * (cos(t) - 1) with lines dt 2 lw 2 lc rgb ink notitle, \
     for [n = 1:3] run.'/orbit_'.word(fields, n).'.dat' using ($1 / A):($2 / A) with points lt n ps 1 title 'Ω_c = '.word(fields, n).' ω_p'
unset multiplot
