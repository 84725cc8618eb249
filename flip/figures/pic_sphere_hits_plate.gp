# The showpiece of 1955: a sphere of iron hits a plate of aluminum at 6 km/s. Particles of classical PIC about the axis, drawn on both sides of it, iron orange and aluminum blue. The sphere spreads and lines
# the crater, whose lip flies back, and the plate bulges. Such distortions, and two materials with free surfaces, are what a mesh that moves with the fluid cannot follow.
# fits: pic|flip theory.compare=impact grid.geometry=axisymmetric file:particles_*.dat file:summary.json
wide = 1500; high = 590
load 'common/style.gp'
times = times_of('particles', 4)
set multiplot title (entry('case') eq 'sphere_hits_plate' ? 'Iron hits aluminum at 6 km/s: Harlow''s particle-in-cell method' : 'Impact: '.run) font ',24'
set border 15; unset grid; unset key; set size ratio -1
set xrange [-5.6:5.6]; set yrange [-6.2:5]; set xtics 2; set ytics 2
set xlabel 'r [cm]' offset 0, 0.3; set format x '%g'
width = 0.215; panel_bottom = 0.17; panel_top = panel_bottom + width * wide / high
set bmargin at screen panel_bottom; set tmargin at screen panel_top
do for [n = 1:words(times)] {
    left = 0.065 + (n - 1) * 0.233
    set lmargin at screen left; set rmargin at screen left + width
    if (n == 1) { set ylabel 'z [cm]' offset 1, 0 } else { unset ylabel; set ytics format '' }
    file = file_at('particles', real(word(times, n)))
    set title sprintf('t = %.0f μs', time_of(file)) offset 0, -0.6
    plot for [side = -1:1:2] for [k = 0:1] file using (side * $1):($3 == k ? $2 : NaN) with points pt 7 ps 0.22 lc rgb word(sky.' '.orange, k + 1)
}
unset multiplot
