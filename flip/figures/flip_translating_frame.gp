# Sod's shock tube in frames that move over the mesh with the velocity V: 400 cells on twice the length, equal steps. Left: the error of the density against V. flip does not notice, nor do most other
# transfers, good or bad; xpic of order 2 does a little. In Harlow's pic the cells mix what flows through them: it is another, more viscous fluid at every V. Right: velocity at rest (dots) and at V = 4 (lines).
wide = 1500; high = 760
load 'common/style.gp'
names = 'harlow pic xpic2 blend flip xpic5 apic'
titles = '"the program pic" "transfer of pic" "xpic of order 2" "0.95 flip + 0.05 pic" "flip" "xpic of order 5" "apic"'
tint = gray.' '.orange.' '.green.' '.amber.' '.blue.' '.sky.' '.pink
set multiplot title "Sod's shock tube on the move" font ',24'
set bmargin at screen 0.14; set tmargin at screen 0.88
set lmargin at screen 0.12; set rmargin at screen 0.47
set xrange [0:4]; set yrange [0:0.0175]; set xtics 1; set ytics 0.0025
set xlabel 'V'; set ylabel 'L_1(density)' offset 0.8, 0
set key top left maxrows 4 width -7 samplen 1.5 font ',17'
plot for [n = 1:7] run.'/'.word(names, n).'.dat' using 1:2 with linespoints lw 2.4 pt 7 ps 1 lc rgb word(tint, n) title word(titles, n)
set lmargin at screen 0.57; set rmargin at screen 0.97
set xrange [0.2:0.95]; set yrange [-0.05:1.1]; set xtics 0.1; set ytics 0.2
set xlabel 'x - V t'; set ylabel 'velocity - V'
set key font ',20' samplen 2 at graph 0.45, 0.4 center top maxrows 10 width 0
file(n, V) = sprintf('%s/%s.%d.dat', run, word(names, n), V)
plot file(5, 0) using 1:7 with lines lw 2 lc rgb ink title 'exact', \
     file(1, 4) using 1:3 with lines lw 2.4 lc rgb gray title 'pic, V = 4', \
     file(1, 0) using 1:3 with points pt 7 ps 0.6 lc rgb gray title 'pic at rest', \
     file(5, 4) using 1:3 with lines lw 2.4 lc rgb blue title 'flip, V = 4', \
     file(5, 0) using 1:3 with points pt 7 ps 0.6 lc rgb blue title 'flip at rest'
unset multiplot
