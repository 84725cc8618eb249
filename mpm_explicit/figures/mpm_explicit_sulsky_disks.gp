# The colliding disks of Sulsky, Chen and Schreyer. Above: their particles. Below: energies and the force of contact. Disks that press where they touch meet when their surfaces do (vertical line); disks
# that press wherever they approach and share nodes (dashed) meet too early, and gain energy.
wide = 1500; high = 1060
load 'common/style.gp'
folder = run
run = folder.'/when_near'
near = run.'/history.dat'; early = folder.'/on_approach/history.dat'
kinetic = col(near, 'kinetic'); elastic = col(near, 'elastic'); energy = col(near, 'energy'); force = col(near, 'contact_force')
E_0 = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", energy, near)))
touch = real(entry('results.contact_begins.expected'))
interval = parameter('particles_interval')
picture(t) = word(system('ls "'.run.'"/particles_*.dat'), int(t / interval + 1.5))
times = '1 1.5 2 3'
set multiplot title 'Colliding disks' font ',24'
set border 15; unset grid; unset key
set xrange [0:1]; set yrange [0:1]; set xtics 0, 0.2, 0.9; set ytics 0.2
set xlabel 'x / L'
panel = 0.21; gap = 0.02; top = 0.865
do for [k = 1:4] {
    left = 0.085 + (k - 1) * (panel + gap)
    set lmargin at screen left; set rmargin at screen left + panel
    set tmargin at screen top; set bmargin at screen top - panel * wide / high
    set title sprintf('t = %.1f', real(word(times, k))) offset 0, -0.5
    if (k == 1) { set ylabel 'y / L' offset 0.5, 0 } else { unset ylabel; set format y '' }
    plot for [g = 0:1] picture(real(word(times, k))) using ($5 == g ? $1 : NaN):2 with points pt 7 ps 0.62 lc rgb (g == 0 ? blue : orange)
}
set border 3; set grid; set format y '%g'
end = parameter('end')
set xrange [0:end]; set xtics 0.5; set xlabel 't'
set arrow 1 from touch, graph 0 to touch, graph 0.7 nohead lc rgb ink lw 1.2
set tmargin at screen 0.41; set bmargin at screen 0.11
set lmargin at screen 0.085; set rmargin at screen 0.49
set title 'energy / initial'
set yrange [0:1.7]; set ytics 0.5
set key top left horizontal
plot near using 1:(column(energy) / E_0) with lines lt 8 lw 2 title 'total', near using 1:(column(kinetic) / E_0) with lines lt 1 title 'kinetic', \
     near using 1:(column(elastic) / E_0) with lines lt 2 title 'elastic', \
     early using 1:(column(energy) / E_0) with lines lt 8 lw 2 dt 2 notitle, early using 1:(column(kinetic) / E_0) with lines lt 1 dt 2 notitle, \
     early using 1:(column(elastic) / E_0) with lines lt 2 dt 2 notitle
set lmargin at screen 0.575; set rmargin at screen 0.98
set title 'force of contact / (E L/100)'
set yrange [0:8]; set ytics 2
set key top left horizontal maxrows 2
unit = 1000.0 / 100
plot near using 1:(column(force) / unit) with lines lt 4 title 'where surfaces touch', early using 1:(column(force) / unit) with lines lt 4 lw 1.5 dt 2 title 'on approach'
unset multiplot
