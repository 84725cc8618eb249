# Kelvin-Helmholtz: a stream to the right (orange) above a stream to the left (blue), at Mach 0.2 with a layer of shear between them. Top left: the velocity across the layer in flip grows at the rate of
# Rayleigh's theory. Then the layer winds up into a billow, and the sharp interface with it. Below left: in pic, which begins with twenty times the wave, sound that particles make as they cross cells stirs the layer.
wide = 1500; high = 1040
load 'common/style.gp'
folder = run; run = folder.'/flip'
set multiplot title 'Kelvin-Helmholtz: a layer of shear winds up' font ',24'
history = run.'/history.dat'
t = col(history, 'time'); re = col(history, 'mode_re'); im = col(history, 'mode_im')
rate = result('theory_growth')
# The line of theory has the height of the run in the middle of the fit.
fitted = system(sprintf("echo '%s' | sed 's/.*up to t = \\([0-9.]*\\).*/\\1/'", entry('results.growth.source')))
height = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && $1 > 0.5 * ".fitted." { print sqrt($%d^2 + $%d^2) * exp(-%.10g * $1); exit }' '%s'", re, im, rate, history)))
set bmargin at screen 0.64; set tmargin at screen 0.865
set lmargin at screen 0.095; set rmargin at screen 0.325
set logscale y; set format y '10^{%T}'
set xrange [0:given('time.end')]; set yrange [0.001:10]; set xtics 0.5
set xlabel 'time' offset 0, 0.3; set ylabel 'v_z of the wave' offset 0.8, 0
set key bottom right samplen 1.5 width -4 font ',18'
plot history using t:(sqrt(column(re)**2 + column(im)**2)) @measured title sprintf('flip: γ = %.3f', result('growth')), \
     height * exp(rate * x) @theory title sprintf('theory: γ = %.3f', rate)
unset logscale; set format y '%g'
set xrange [0:1]; set yrange [-0.5:0.5]; unset grid; set border 15; set size ratio -1
unset key; set ytics 0.5
# Four files of flip, from the middle of the run, and the last of pic.
do for [n = 1:5] {
    p = n == 3 ? 'pic' : 'flip'; run = folder.'/'.p; all = times_of('particles', 1000); last = words(all)
    time = real(word(all, last - int(word('5 3 0 2 0', n))))
    left = word('0.4 0.715 0.085 0.4 0.715', n); bottom = n < 3 ? 0.535 : 0.085
    set lmargin at screen left; set rmargin at screen left + 0.255
    set bmargin at screen bottom; set tmargin at screen bottom + 0.255 * wide / high
    set title sprintf('%s, t = %.3g', p, time) offset 0, -0.7
    if (n > 2) { set xtics 0.5 format '%g'; set xlabel 'x' offset 0, 0.5 } else { set xtics 0.5 format ''; unset xlabel }
    if (n == 1 || n == 3) { set ylabel 'z' offset 3.2, 0; set format y '%g' } else { unset ylabel; set format y '' }
    plot file_at('particles', time) using 1:2:($3 == 0 ? 0x56b4e9 : 0xd55e00) with points pt 7 ps 0.5 lc rgb variable
}
unset multiplot
