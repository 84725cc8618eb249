# An empty cavity in a liquid that a gas presses on, particles of the liquid drawn on both sides of the axis in the color of their speed. Left: the radius of a sphere in the middle of a drop, against
# Rayleigh's solution. Right, above: that sphere, which stays one. Below: a cavity that touches a wall, from which no liquid comes: the far side falls in and runs through the cavity as a jet.
wide = 1500; high = 760
load 'common/style.gp'
folder = run; run = folder.'/drop'
set multiplot title 'An empty cavity closes: Rayleigh''s sphere, and a jet towards a wall' font ',24'
set bmargin at screen 0.165; set tmargin at screen 0.83
set lmargin at screen 0.09; set rmargin at screen 0.355
profile = run.'/profile.dat'
set xrange [0:0.85]; set yrange [0:1.05]; set xtics 0.2; set ytics 0.2
set xlabel 't (p / ρ)^{1/2} / R_0'; set ylabel 'R / R_0' offset 0.8, 0
set key at graph 0, 0.06 bottom left Left reverse samplen 2
plot profile using (column('time')):(column('radius')) every 10 @measured title sprintf('flip: closed at %.3f', result('collapse_time')), \
     '' using (column('time')):(column('radius_exact')) @theory title 'Rayleigh, in a drop'
eval colors(viridis); set cbrange [0:4]; set cbtics 1
unset grid; unset key; set border 15; set tics front; set size ratio -1
set xrange [-2:2]; set yrange [0:2.6]; set xtics -1, 1, 1; set ytics 1
width = 0.155; tall = width * wide / high * 2.6 / 4
do for [n = 1:6] {
    run = folder.(n < 4 ? '/drop' : '/wall')
    times = n < 4 ? near('particles', '0 0.65 0.75') : near('particles', '0 0.9 1')
    k = (n - 1) % 3; time = word(times, k + 1)
    left = 0.43 + 0.17 * k; bottom = n < 4 ? 0.575 : 0.165
    set lmargin at screen left; set rmargin at screen left + width
    set bmargin at screen bottom; set tmargin at screen bottom + tall
    set title sprintf('t = %.2f', real(time)) offset 0, -0.6
    if (k == 0) { set ylabel 'z / R_0' offset -0.5, 0; set ytics format '%g' } else { unset ylabel; set ytics format '' }
    if (n > 3) { set xlabel 'r / R_0' offset 0, 0.4; set xtics format '%g' } else { unset xlabel; set xtics format '' }
    if (n == 6) { set colorbox user origin 0.94, 0.165 size 0.012, 0.41 + tall; set label 9 '|v| (ρ / p)^{1/2}' at screen 0.99, 0.88 right } else { unset colorbox }
    plot for [side = -1:1:2] file_at('particles', real(time)) using ($3 == 1 ? side * $1 : NaN):2:(sqrt($4**2 + $5**2)) with points pt 7 ps (n < 4 ? 0.2 : 0.28) lc palette
}
unset multiplot
