# A wave on water under air, a thousand times lighter. Left, the water after a period, in the color of its speed. Right, the height of its crest: it keeps its height where the pressure is that
# of the end of the step, and grows, as theory of the step says, where it is the mean of both ends; another transfer damps it.
wide = 1500; high = 640
load 'common/style.gp'
folder = run
run = folder.'/flip'
omega = result('theory_frequency'); V = parameter('amplitude')
set multiplot title 'A wave on water' font ',24'
eval colors(viridis); set cbrange [0:0.05]; set cbtics 0.01
set bmargin at screen 0.16; set tmargin at screen 0.82
set lmargin at screen 0.07; set rmargin at screen 0.36
set xrange [0:1]; set yrange [-0.5:0.1]; set xtics 0.5; set ytics 0.1
set xlabel 'x / H'; set ylabel 'z / H' offset 0.5, 0
set colorbox user origin 0.375, 0.16 size 0.012, 0.66; set label 9 '|v| / (g H)^{1/2}' at screen 0.46, 0.86 right
t = real(word(near('particles', '2.5'), 1))
set title sprintf('t (g/H)^{1/2} = %.1f', t) offset -6, -0.5
set border 15; set tics front; unset grid; unset key
plot file_at('particles', t) using ($3 == 1 ? $1 : NaN):2 with dots lc rgb '#999999', \
     '' using ($3 == 0 ? $1 : NaN):2:(sqrt($4**2 + $5**2)) with points pt 7 ps 0.45 lc palette
unset colorbox; unset label 9; set border 3; set grid; set key
height(name) = col(folder.'/'.name.'/history.dat', 'mode_re')
set samples 600; set lmargin at screen 0.56; set rmargin at screen 0.975
set xrange [0:14]; set yrange [-0.045:0.07]; set xtics 2; set ytics 0.02
set title 'height of the crest' offset 0, -0.5
set xlabel 't (g/H)^{1/2}'; set ylabel 'η / H' offset 0.5, 0
set key at graph 1.0, 1.02 top right maxrows 3 width -3 samplen 1.2
run = folder.'/theta'; growth = 0.25 * omega**2 * parameter('dt')
plot (x < 6 ? V / omega * exp(growth * x) : NaN) with lines dt 3 lw 1.5 lc rgb ink title 'theory, θ = 1/2', \
     V / omega * sin(omega * x) with lines dt 2 lw 1.5 lc rgb ink title 'theory', \
     folder.'/flip/history.dat' using 1:(column(height('flip'))) with lines lt 1 title 'flip, θ = 1', \
     folder.'/theta/history.dat' using 1:(column(height('theta'))) with lines lt 2 title 'flip, θ = 1/2', \
     folder.'/xpic/history.dat' using 1:(column(height('xpic'))) with lines lt 3 title 'xpic'
unset multiplot
