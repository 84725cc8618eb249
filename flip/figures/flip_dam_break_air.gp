# The same column of water in a closed box with the air that it had, 830 times lighter: particles of water in the color of their speed, of air as gray dots. The air gives way, is drawn along and
# winds up behind the crest; a free surface is where volume ends, and here it ends nowhere.
wide = 1500; high = 430
load 'common/style.gp'
times = near('particles', '0.8 1.6 2.4')   # of T = 2^{1/2} t
set multiplot title 'A broken dam and its air' font ',24'
eval colors(viridis); set cbrange [0:2.5]; set cbtics 0.5
set border 15; set tics front; unset grid; unset key; set size ratio -1
set xrange [0:5]; set yrange [0:2.5]; set xtics 0, 1, 4.5; set ytics 1; set xlabel 'x / a' offset 0, 0.4
width = 0.265
do for [n = 1:words(times)] {
    left = 0.075 + (n - 1) * 0.285
    set lmargin at screen left; set rmargin at screen left + width
    set tmargin at screen 0.73; set bmargin at screen 0.73 - width * wide / high * 2.5 / 5
    if (n == 1) { set ylabel 'z / a' offset 0.5, 0 } else { unset ylabel; set ytics format '' }
    if (n == words(times)) { set colorbox user origin 0.922, 0.73 - width * wide / high * 2.5 / 5 size 0.012, width * wide / high * 2.5 / 5; set label 9 '|v| / (g a)^{1/2}' at screen 0.995, 0.73 right offset 0, 1.1 } else { unset colorbox }
    set title sprintf('T = %.2f', sqrt(2) * real(word(times, n))) offset 0, -0.6
    plot file_at('particles', real(word(times, n))) using ($3 == 0 ? $1 : NaN):2 with dots lc rgb '#999999', \
         '' using ($3 == 1 ? $1 : NaN):2:(sqrt($4**2 + $5**2)) with points pt 7 ps 0.3 lc palette
}
unset multiplot
