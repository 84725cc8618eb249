# What a larger time step costs: iterations of conjugate gradients for one solve of the compressed grains, against the CFL number. With the diagonal they grow about in proportion, until sound crosses a grain in a step; with every
# grain factorized only what passes from grain to grain is left to find, and they grow as the square root. Below 1 it is the consistent mass matrix that takes them. Right: solves until it is found who presses, the first ones rough.
wide = 1500; high = 720
load 'common/style.gp'
file = run.'/iterations.dat'
set multiplot title 'Iterations against the time step, compressed grains' font ',24'
set logscale xy; set xrange [0.2:80]; set xtics ('1/4' 0.25, '1/2' 0.5, '1' 1, '2' 2, '4' 4, '8' 8, '16' 16, '32' 32, '64' 64)
set xlabel 'α'
set lmargin at screen 0.095; set rmargin at screen 0.62
set tmargin at screen 0.88; set bmargin at screen 0.14
set ylabel 'iterations per solve' offset 0.8, 0
set samples 1000; set yrange [3:2000]; set ytics (3, 10, 30, 100, 300, 1000)
set key top left
taken(alpha, column) = real(system(sprintf("LC_ALL=C awk '$1 == %g { print $%d }' '%s'", alpha, column, file)))
with_diagonal = taken(8, 4) / 8; with_grains = taken(4, 2) / 2
plot file using 1:4 with linespoints lt 2 ps 1.6 title 'diagonal', file using 1:2 with linespoints lt 1 ps 1.6 title 'grains, factorized', (x >= 3 && x <= 24 ? with_diagonal * x : NaN) with lines lt 8 dt 3 lw 1.8 title '∝ α', (x >= 1 ? with_grains * sqrt(x) : NaN) with lines lt 8 dt 2 lw 1.8 title '∝ α^{1/2}'
set lmargin at screen 0.72; set rmargin at screen 0.98
set ylabel 'solves per step' offset 0.8, 0
unset logscale y; set yrange [0:6]; set ytics 1
set xtics ('1/4' 0.25, '1' 1, '4' 4, '16' 16, '64' 64)
unset key
plot file using 1:3 with linespoints lt 1 ps 1.6
unset multiplot
