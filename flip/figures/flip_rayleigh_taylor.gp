# Rayleigh-Taylor: a fluid (orange) lies on one of half its density (blue). Left: the height of the interface in flip, against sinh(γt) of theory. Right: its particles, above in flip, below in pic, which
# begins ten times as fast because it does not feel what is slower, and makes noise of sound instead. Neither mixes materials: the interface is as sharp at the end as it was at the start.
wide = 1440; high = 1075
load 'common/style.gp'
folder = run; run = folder.'/flip'
set multiplot title 'Rayleigh-Taylor: heavy fluid falls through light fluid' font ',24'
set bmargin at screen 0.3; set tmargin at screen 0.78
set lmargin at screen 0.085; set rmargin at screen 0.33
history = run.'/history.dat'
t = col(history, 'time'); re = col(history, 'mode_re'); im = col(history, 'mode_im')
rate = result('theory_growth'); a0 = parameter('amplitude')
set logscale y; set format y '10^{%T}'
set xrange [0:given('time.end')]; set yrange [1e-4:3]; set xtics 1
set xlabel 'time'; set ylabel 'height of the interface' offset 0.8, 0
set key at graph 0, 1.28 top left
set samples 400
plot history using t:(sqrt(column(re)**2 + column(im)**2)) @measured title sprintf('flip: γ = %.3f', result('growth')), \
     a0 / rate * sinh(rate * x) @theory title sprintf('theory: γ = %.3f', rate)
unset logscale; set format y '%g'
set xrange [0:1]; set yrange [-1:1]; unset grid; set border 15; set size ratio -1
unset xtics; unset xlabel; unset ylabel; unset key
# Four files of each, every second one up to the end.
do for [n = 1:8] {
    p = n < 5 ? 'flip' : 'pic'; run = folder.'/'.p; all = times_of('particles', 1000)
    k = (n - 1) % 4; time = word(all, words(all) - 2 * (3 - k))
    left = 0.405 + 0.152 * k; bottom = n < 5 ? 0.53 : 0.075
    set lmargin at screen left; set rmargin at screen left + 0.135
    set bmargin at screen bottom; set tmargin at screen bottom + 0.37
    set title sprintf('%s, t = %.3g', p, real(time)) offset 0, -0.7
    if (k == 0) { set ytics 0.5 format '%g'; set ylabel 'z' offset 2.2, 0 } else { set ytics 0.5 format ''; unset ylabel }
    if (n > 4) { set xtics ('0' 0, '0.5' 0.5); set xlabel 'x' offset 0, 0.6 }
    plot file_at('particles', real(time)) using 1:2:($3 == 0 ? 0x56b4e9 : 0xd55e00) with points pt 7 ps 0.26 lc rgb variable
}
unset multiplot
