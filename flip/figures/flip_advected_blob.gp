# A warm blob flows once around a periodic box of 256 cells with dust, which nothing pushes. Left: the growth of its variance over 2 u Δx t is the diffusivity. In pic the cells mix what enters them,
# and D = (1 - C) u Δx/2 at the Courant number C: shorter steps are worse. In flip particles carry the heat, and D is 0 to nine digits. Right: the blob before and after one turn.
wide = 1500; high = 760
load 'common/style.gp'
folder = run
names = '0.05 0.2 0.5 0.9'
tint = orange.' '.amber.' '.green.' '.pink
history(p, n) = folder.'/'.p.'_'.word(names, n).'/history.dat'
t = col(history('pic', 1), 'time'); variance = col(history('pic', 1), 'variance')
array start[4]
do for [n = 1:4] { start[n] = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", variance, history('pic', n)))) }
D(n) = (run = folder.'/pic_'.word(names, n), result('diffusivity'))
last(p, n) = system(sprintf('ls "%s"/%s_%s/fields_*.dat | tail -1', folder, p, word(names, n)))
first = folder.'/pic_0.05/fields_000000.dat'
e = col(first, 'e'); background = real(system(sprintf("LC_ALL=C awk 'NF && $1 + 0 == $1 { print $%d; exit }' '%s'", e, first)))
set multiplot title 'A blob of heat on its way around the box' font ',24'
set bmargin at screen 0.14; set tmargin at screen 0.88
set lmargin at screen 0.085; set rmargin at screen 0.47
dx = 1.0 / 256
set xrange [0:1]; set yrange [-0.03:0.75]; set xtics 0.2; set ytics 0.1
set xlabel 't / turn'; set ylabel 'growth of variance / (2 u Δx turn)' offset 0.8, 0
set key top left
plot for [n = 1:4] history('pic', n) using t:((column(variance) - start[n]) / (2 * dx)) with lines lw 3 lc rgb word(tint, n) title sprintf('pic, C = %s: D = %.4f u Δx', word(names, n), D(n)), \
     for [n = 1:4] (1 - real(word(names, n))) / 2 * x with lines dt 2 lw 2 lc rgb ink title (n == 1 ? '(1 - C)/2' : ''), \
     for [n = 1:4] history('flip', n) using t:((column(variance) - start[n]) / (2 * dx)) with lines lw 3 lc rgb blue title (n == 1 ? 'flip, all C' : '')
set lmargin at screen 0.575; set rmargin at screen 0.97
set xrange [0.2:0.8]; set yrange [-0.05:1.25]; set xtics 0.1; set ytics 0.2
set xlabel 'x'; set ylabel 'energy above the background'
set key top right
# The blob has come back to where it was.
plot for [n = 1:4] last('pic', n) using 1:(column(e) / background - 1) with lines lw 2.4 lc rgb word(tint, n) notitle, \
     last('flip', 2) using 1:(column(e) / background - 1) with points pt 7 ps 0.8 lc rgb blue title 'flip after one turn', \
     first using 1:(column(e) / background - 1) with lines dt 2 lw 2 lc rgb ink title 'at the start'
unset multiplot
