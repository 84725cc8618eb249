# Figure 2 of the talk: grain positions at t = 2.00, explicit. With a CFL number of 0.25 the disks part as they came. With 1.00 the strains of
# the contact do not die out but grow, and the grains run away with energy from nowhere: thirteen times the energy at t = 2. Dashed: disks that were 0.405 in contact, 0.974 of a contact always in equilibrium, and lost nothing.
wide = 1500; high = 1000
load 'common/style.gp'
folder = run; R = 0.2
set multiplot title 'Elastic rebound, explicit: grain positions' font ',24'
set border 15; unset grid; unset key; set tics front
set xrange [-0.15:6.15]; set yrange [-0.1:3.1]; set xtics 1; set ytics 1
panel_width = 0.43; panel_height = panel_width * wide / high * 3.2 / 6.3
do for [row = 1:2] { do for [column = 1:2] {
    end = word('0.7 2', row); alpha = word('0.25 1', column)
    run = folder.'/alpha_'.alpha.'_to_'.end
    rows = sprintf("LC_ALL=C awk '$1 + 0 == $1 { e = $%d; if (n++ == 0) f = e } END { print e / f }' '%s'", col(run.'/history.dat', 'energy'), run.'/history.dat')
    energy = real(system(rows))
    if (row == 2 && column == 1) {
        lasts = real(entry('results.contact_lasts.expected')); apart = 0.1 * (2 - lasts - 0.5)
    }
    left = 0.075 + (column - 1) * (panel_width + 0.045); top = 0.85 - (row - 1) * (panel_height + 0.085)
    set lmargin at screen left; set rmargin at screen left + panel_width
    set tmargin at screen top; set bmargin at screen top - panel_height
    if (row == 1) { set title sprintf('α = %.2f', real(alpha)) offset 0, -0.3; set format x ''; unset xlabel } else { unset title; set format x '%g'; set xlabel 'x / R' }
    if (column == 1) { set ylabel 'y / R' offset 0.3, 0; set format y '%g' } else { unset ylabel; set format y '' }
    set label 1 sprintf('t = %.2f', real(end)) at graph 0.02, 0.92
    set label 2 sprintf(energy < 10 ? 'energy %.2f E_0' : 'energy %.0f E_0', energy) at graph 0.98, 0.92 right
    if (row == 2) {
        set object 1 circle at (0.4 - apart) / R, 1.5 size 1 front fillstyle empty border lc rgb ink lw 2 dt 2
        set object 2 circle at (0.8 + apart) / R, 1.5 size 1 front fillstyle empty border lc rgb ink lw 2 dt 2
    }
    plot for [g = 0:1] system('ls "'.run.'"/particles_*.dat | tail -n 1') using ($5 == g ? $1 / R : NaN):($2 / R) with points pt 7 ps 0.62 lc rgb (g == 0 ? blue : orange)
} }
unset multiplot
