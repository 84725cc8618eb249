# Density behind shocks that run off a wall, against the distance from the wall over time. Above: a cold stream is stopped, exactly sixfold. Below: a piston moves into warm gas with its speed of sound.
# Artificial viscosity gives both methods a clean plateau, with hot thin gas at the wall. Without it nothing slows particles where the wall stops the fluid: they pile up (mind the scale above), and the shock is late.
wide = 1500; high = 1060
load 'common/style.gp'
folder(k, n) = run.'/'.word('wall_shock piston', k).'_'.word('pic flip', n)
file(k, n, q) = folder(k, n).(q ? '' : '_without_q').'/profile.dat'
duration(path) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { t = $1 } END { print t }' '%s/history.dat'", path)))
set multiplot title 'Shocks at a wall, with artificial viscosity and without' font ',24'
speeds = '0.2 0.76619'
do for [k = 1:2] {
    do for [n = 1:2] {
        left = n == 1 ? 0.075 : 0.565
        bottom = k == 1 ? 0.545 : 0.085
        set lmargin at screen left; set rmargin at screen left + 0.415
        set bmargin at screen bottom; set tmargin at screen bottom + 0.355
        set title sprintf('%s, %s', word('pic flip', n), word('"a cold stream" "a piston"', k)) offset 0, -0.6
        if (k == 1) { set logscale y; set yrange [0.3:300]; set ytics 10; set format y '%g'; set xrange [0:0.4]; set xtics 0.1; unset xlabel; set key top right } \
        else { unset logscale y; set yrange [0.8:3.5]; set ytics 0.5; set xrange [0:1.2]; set xtics 0.2; set xlabel 'distance from the wall / time' offset 0, 0.4; unset key }
        if (n == 1) { set ylabel 'density' offset 0.8, 0 } else { unset ylabel }
        t = duration(folder(k, n)); t_without = duration(folder(k, n).'_without_q')
        plot file(k, n, 0) using ($1 / t_without):2 with points pt 7 ps 0.8 lc rgb orange title 'without viscosity', \
             file(k, n, 1) using ($1 / t):2 with points pt 7 ps 0.8 lc rgb blue title 'with viscosity', \
             file(k, n, 1) using ($1 / t):3 with steps lw 2 lc rgb ink title 'exact'
    }
}
unset multiplot
