# "FLIP is an all flow speeds method": the Gresho vortex after one turn, with implicit pressure. Above, speed at Mach 1/1000: flip and apic keep it, pic smears it out. Below, its
# profile; its kinetic energy, which at this Mach number only survives where particles carry volumes; and what one turn leaves of it at three Mach numbers: the same.
wide = 1500; high = 1060
load 'common/style.gp'
folder = run
transfers = 'flip apic pic'
tint = blue.' '.green.' '.orange
last(name) = system(sprintf("ls '%s'/%s/fields_*.dat | tail -n 1", folder, name))
first_file = folder.'/flip-0.001/fields_000000.dat'
vx = col(first_file, 'v_x'); vz = col(first_file, 'v_z')
set multiplot title 'Gresho vortex, implicit pressure' font ',24'
eval colors(viridis); set cbrange [0:1]; set cbtics 0.5
set border 15; set tics front; unset grid; unset key; set size ratio -1
set xrange [0:1]; set yrange [0:1]; set xtics 0, 0.5, 0.9; set ytics 0.5; set xlabel 'x / L' offset 0, 0.4
do for [n = 1:4] {
    left = 0.085 + (n - 1) * 0.21
    set lmargin at screen left; set rmargin at screen left + 0.195
    set tmargin at screen 0.86; set bmargin at screen 0.86 - 0.195 * wide / high
    set title (n == 1 ? 'start, M = 0.001' : word(transfers, n - 1).', after one turn') offset 0, -0.6
    if (n == 1) { set ylabel 'z / L' offset 0.5, 0 } else { unset ylabel; set ytics format '' }
    if (n == 4) { set colorbox user origin 0.925, 0.86 - 0.195 * wide / high size 0.012, 0.195 * wide / high; set label 9 '|v| / v_0' at screen 0.985, 0.86 right offset 0, 1.1 } else { unset colorbox }
    plot (n == 1 ? first_file : last(word(transfers, n - 1).'-0.001')) using 1:2:(sqrt(column(vx)**2 + column(vz)**2)) with image
}
unset colorbox; unset title; unset label 9; set border 3; set grid; set size noratio; set format y '%g'; set ytics auto; set xtics auto
set bmargin at screen 0.1; set tmargin at screen 0.455
set lmargin at screen 0.085; set rmargin at screen 0.345
set xrange [0:0.45]; set yrange [-0.05:1.12]; set xtics 0, 0.2; set ytics 0, 0.5
set xlabel 'r / L'; set ylabel 'v_φ / v_0'
set key at graph 1.08, graph 1.02 samplen 1
plot folder.'/flip-0.001/profile.dat' using 1:5 with lines lw 2 dt 2 lc rgb ink title 'exact', \
     for [n = 1:3] folder.'/'.word(transfers, n).'-0.001/profile.dat' using 1:2 with linespoints lc rgb word(tint, n) pt 7 ps 0.6 title word(transfers, n)
set lmargin at screen 0.42; set rmargin at screen 0.66
turn = 0.4 * pi
set xrange [0:1]; set yrange [0:1.3]; set xtics 0.5
set xlabel 'turns, M = 0.001'; set ylabel 'kinetic energy / initial' offset 1, 0
set key bottom left
K = col(folder.'/cells/history.dat', 'kinetic')
K_0 = first(folder.'/cells/history.dat', 'kinetic')
set label 1 'density of cells' at 0.09, 1.19 textcolor rgb pink
plot for [n = 1:3] folder.'/'.word(transfers, n).'-0.001/history.dat' using ($1 / turn):(column(K) / K_0) with lines lc rgb word(tint, n) notitle, \
     folder.'/cells/history.dat' using ($1 / turn):(column(K) / K_0) with lines lc rgb pink notitle
unset label 1
set lmargin at screen 0.735; set rmargin at screen 0.975
set logscale x; set xrange [5e-4:0.2]; set format x '10^{%T}'; set xtics 10
set xlabel 'Mach number'; set ylabel 'kept after one turn' offset 1, 0
machs = '0.001 0.01 0.1'
kept(n, m) = (run = folder.'/'.word(transfers, n).'-'.word(machs, m), result('kinetic_energy_kept'))
iterations(m) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { s += $%d; n++ } END { printf \"%%.0f\", s / (n - 1) }' '%s'/flip-%s/history.dat", col(folder.'/flip-0.1/history.dat', 'iterations'), folder, word(machs, m))))
do for [m = 1:3] { set label 10 + m sprintf('%.0f', iterations(m)) at real(word(machs, m)), 1.1 center font ',17' }
set label 20 'iterations per step' at graph 0.5, 0.95 center font ',17'
plot for [n = 1:3] '+' using (real(word(machs, int($0) + 1))):(kept(n, int($0) + 1)) every ::0::2 with linespoints lc rgb word(tint, n) pt 7 ps 1.4 notitle
unset multiplot
