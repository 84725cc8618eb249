# Down an incline of 30 degrees, for several coefficients of friction. Left: velocity along the plate, and theory (dashed) from the time when gravity has risen to its full size. Right: acceleration.
# A block slides with g (sin - mu cos) or stays; a cylinder slides, or, from mu = tan / 3 on, rolls with (2/3) g sin.
wide = 1500; high = 700
load 'common/style.gp'
g = 10; angle = 30 * pi / 180; rise = 0.1
folder = run
block(mu) = sin(angle) > mu * cos(angle) ? sin(angle) - mu * cos(angle) : 0
cylinder(mu) = sin(angle) <= 3 * mu * cos(angle) ? sin(angle) / 1.5 : block(mu)
theory_of(body, mu) = body eq 'block' ? block(mu) : cylinder(mu)
frictions = '0 0.2 0.4 0.6'
tint = blue.' '.green.' '.amber.' '.orange
set multiplot title 'Down an incline of 30 degrees' font ',24'
set bmargin at screen 0.16; set tmargin at screen 0.82
set samples 1000
array left[2] = [0.095, 0.425]
array size[2] = [0.4, 0.1]   # width of the block, radius of the cylinder
array ending[2] = [0.5, 0.6]
do for [k = 1:2] {
    body = word('block cylinder', k)
    time = sqrt(size[k] / g); speed = sqrt(size[k] * g)
    set lmargin at screen left[k]; set rmargin at screen left[k] + 0.23
    set title (k == 1 ? 'block of width d' : 'cylinder of radius R') offset 0, -0.3
    set xlabel (k == 1 ? 't (g/d)^{1/2}' : 't (g/R)^{1/2}'); set ylabel (k == 1 ? 'v_x / (g d)^{1/2}' : 'v_x / (g R)^{1/2}') offset 0.5, 0
    set xrange [0:ending[k] / time]; set yrange [-0.1 * ending[k] * g / speed * 0.5:0.65 * ending[k] * g / speed]
    eval (k == 1 ? 'set xtics 0.5; set ytics 0.5' : 'set xtics 2; set ytics 1')
    set key top left
    file(n) = folder.'/'.body.'_'.word(frictions, n).'/history.dat'
    p_x = col(file(1), 'momentum_x_'.body)
    run = folder.'/'.body.'_0'
    mass = real(system(sprintf("LC_ALL=C awk 'END { print $%d }' '%s'", p_x, file(1)))) / result('speed_at_end')
    plot for [n = 1:4] file(n) using ($1 / time):(column(p_x) / mass / speed) with lines lc rgb word(tint, n) title 'μ = '.word(frictions, n), \
         for [n = 1:4] (x * time > rise ? theory_of(body, real(word(frictions, n))) * g * (x * time - rise / 2) / speed : NaN) with lines lw 2 dt 2 lc rgb ink notitle
}
set lmargin at screen 0.755; set rmargin at screen 0.98
set title 'acceleration'
set xlabel 'μ'; set ylabel 'acceleration / g' offset 1, 0
set xrange [0:0.75]; set yrange [-0.03:0.65]; set xtics 0.2; set ytics 0.1
plot folder.'/cylinder.dat' using 1:($2 / g) with points pt 7 ps 1.6 lc rgb orange title 'cylinder', folder.'/block.dat' using 1:($2 / g) with points pt 5 ps 1.6 lc rgb blue title 'block', \
     cylinder(x) with lines lw 2 dt 2 lc rgb ink title 'theory', block(x) with lines lw 2 dt 2 lc rgb ink notitle
unset multiplot
