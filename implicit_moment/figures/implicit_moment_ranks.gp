# What ranks are worth: particles of the GEM challenge are divided by strips of four rows, and one in the current sheet has six times as many as one outside. Left: the most
# particles of a rank over the mean, in a real run. Right: the model of implicit_moment_ranks.sh: as built (full), and with patches of equal work (dashed).
wide = 1500; high = 720
load 'common/style.gp'
set multiplot
set tmargin at screen 0.9; set bmargin at screen 0.37
set lmargin at screen 0.09; set rmargin at screen 0.46
set xlabel 'ranks'; set ylabel 'most of a rank / mean'
set logscale x 2; set xrange [1:64]; set yrange [0.9:*]
set key top left
set title 'GEM, 512 x 256 cells in 64 strips'
plot run.'/balance.dat' using 1:2 with lines title 't Ω_{ci} = 0', \
     '' using 1:3 with lines title '15', \
     '' using 1:4 with lines title '30', \
     '' using 1:6 with lines lt 3 dashtype 2 title '30, borders of t = 0'
set lmargin at screen 0.6; set rmargin at screen 0.965
set xlabel 'cores, one rank on each'; set ylabel 'efficiency'
set logscale x 10; set xrange [1:10000]; set yrange [0:1.05]; set format x '10^{%T}'
set key at screen 0.6, 0.12 left center maxrows 4
set title 'a step on one core / n steps on n'
set arrow from graph 0, first 0.5 to graph 1, first 0.5 nohead lc rgb gray dt 3
plot run.'/efficiency.dat' using 1:2 with lines lt 1 title 'slide: 9·10^6 particles', \
     '' using 1:3 with lines lt 1 dashtype 2 notitle, \
     '' using 1:4 with lines lt 2 title '4096 x 2048, 10^{10} particles', \
     '' using 1:5 with lines lt 2 dashtype 2 notitle, \
     '' using 1:6 with lines lt 3 title 'implicit, 64 x 64, 2·10^5 particles', \
     '' using 1:7 with lines lt 3 dashtype 2 notitle, \
     keyentry with lines lc rgb ink dashtype 2 title 'with patches of equal work'
unset multiplot
