# A column of water whose dam vanishes, after Martin and Moyce (1952): a free surface in fluid at Mach 0.05 under implicit pressure. Above, the particles in the color of their speed. Below left,
# the front against the laboratory's: their dam took a time to vanish, and behind the same points with a later clock the speeds agree. Right, the height at the wall behind.
# fits: flip theory.compare=dam_break file:particles_*.dat result:front_ahead
wide = 1500; high = 940
load 'common/style.gp'
times = near('particles', '0.8 1.6 2.4')   # of T = 2^{1/2} t
history = run.'/history.dat'
set multiplot title 'A broken dam' font ',24'
eval colors(viridis); set cbrange [0:2.5]; set cbtics 0.5
set border 15; set tics front; unset grid; unset key; set size ratio -1
set xrange [0:parameter('length_x')]; set yrange [0:2.1]; set xtics 0, 1, parameter('length_x') - 0.5; set ytics 1; set xlabel 'x / a' offset 0, 0.4
width = 0.265
do for [n = 1:words(times)] {
    left = 0.075 + (n - 1) * 0.285
    set lmargin at screen left; set rmargin at screen left + width
    set tmargin at screen 0.84; set bmargin at screen 0.84 - width * wide / high * 2.1 / 5
    if (n == 1) { set ylabel 'z / a' offset 0.5, 0 } else { unset ylabel; set ytics format '' }
    if (n == words(times)) { set colorbox user origin 0.922, 0.84 - width * wide / high * 2.1 / 5 size 0.012, width * wide / high * 2.1 / 5; set label 9 '|v| / (g a)^{1/2}' at screen 0.995, 0.84 right offset 0, 1.1 } else { unset colorbox }
    set title sprintf('T = %.2f', sqrt(2) * real(word(times, n))) offset 0, -0.6
    plot file_at('particles', real(word(times, n))) using 1:2:(sqrt($4**2 + $5**2)) with points pt 7 ps 0.15 lc palette
}
unset colorbox; unset label 9; unset title; set border 3; set grid; set size noratio; set format y '%g'
set bmargin at screen 0.12; set tmargin at screen 0.5
T(t) = sqrt(2) * t
set xrange [0:3.5]; set xtics 1; set xlabel 'T = t (2 g / a)^{1/2}'
set lmargin at screen 0.075; set rmargin at screen 0.48
set yrange [1:6]; set ytics 1; set ylabel 'front x / a' offset -0.3, 0
set key top left font ',16' samplen 1.5
late = result('front_ahead')
set datafile separator whitespace
front = col(history, 'front_x'); height = col(history, 'wall_height')
data = sprintf("<tr ',' ' ' < flip/data/martin_moyce.csv | grep -v '[TZ]'")
plot history using (T($1)):(column(front)) with lines lt 1 title 'front', \
     data using 1:2 with points pt 6 ps 1.2 lw 1.4 lc rgb '#aaaaaa' title 'Martin and Moyce', \
     data using ($1 - late):2 @published title sprintf('with their clock set back by %.2f', late)
set lmargin at screen 0.58; set rmargin at screen 0.97
set yrange [0:2.1]; set ytics 0.5; set ylabel 'height at the wall / a' offset 0.5, 0
plot history using (T($1)):(column(height)) with lines lt 1 notitle
unset multiplot
