# Figure 1 of the talk: grain positions through the elastic rebound, implicit, with a CFL number of 1.00, where the explicit program bursts. Particles are colored by the stress along the line of
# centers over E, tension red and compression blue: there is none until the grains meet, it spreads from the contact and comes to rest with them, and what remains when they part is vibration. (Their velocities
# alternate from step to step while they press, which says nothing.) The share in each panel is that of the elastic energy in all there is.
# fits: mpm_explicit|mpm_implicit theory.compare=rebound file:particles_*.dat file:summary.json
wide = 1500; high = 1000
load 'common/style.gp'
R = real(given('grain.*.radius'))
file = run.'/history.dat'
energy = col(file, 'energy'); elastic = col(file, 'elastic')
at(what, t) = real(system(sprintf("LC_ALL=C awk -v t=%g '$1 + 0 == $1 { if ($1 <= t + 1e-9) v = $%d } END { print v }' '%s'", t, what, file)))
E_0 = at(energy, 0)
set multiplot title sprintf('Elastic rebound, %s, α = %.2f: grain positions', entry('program') eq 'mpm_implicit' ? 'implicit' : 'explicit', parameter('alpha')) font ',24'
set border 15; unset grid; unset key; set tics front
set xrange [0:parameter('length_x') / R]; set yrange [0.35:2.95]; set xtics 1; set ytics 1, 1, 2
eval signed(5); set cbtics 5; E = real(given('material.*.E'))
# Before, when contact begins, in its middle, at its end, between that and the end, and the end.
begins = entry('results.contact_begins.value'); lasts = entry('results.contact_lasts.value'); end = parameter('end')
if (begins ne '' && lasts ne '') { b = real(begins); l = real(lasts) }
times = begins eq '' || lasts eq '' ? times_of('particles', 6) : near('particles', sprintf('0 %.1f %.1f %.1f %.1f %g', b, b + 0.5 * l, b + l, 0.5 * (b + l + end), end))
panel_width = 0.385; panel_height = panel_width * wide / high * 2.6 / 6.0
do for [panel = 0:words(times) - 1] {
    row = panel / 2 + 1; column = panel % 2 + 1; t = real(word(times, panel + 1))
    left = 0.075 + (column - 1) * (panel_width + 0.04); top = 0.905 - (row - 1) * (panel_height + 0.022)
    set lmargin at screen left; set rmargin at screen left + panel_width
    set tmargin at screen top; set bmargin at screen top - panel_height
    if (row == 3) { set format x '%g'; set xlabel 'x / R' } else { set format x ''; unset xlabel }
    if (column == 1) { set ylabel 'y / R' offset 0.3, 0; set format y '%g' } else { unset ylabel; set format y '' }
    set label 1 sprintf('t = %.3g', t) at graph 0.02, 0.92
    set label 2 sprintf('elastic %.0f %% of E_0', 100 * at(elastic, t) / E_0) at graph 0.98, 0.92 right
    if (row == 1 && column == 1) { set colorbox user origin 0.93, top - 3 * panel_height - 0.044 size 0.013, 3 * panel_height + 0.044; set label 3 'σ_{xx} / E [%]' at screen 0.985, top right offset 0, 1 } else { unset colorbox; unset label 3 }
    plot file_at('particles', t) using ($1 / R):($2 / R) with points pt 7 ps 0.75 lc rgb '#a0a0a0', \
         '' using ($1 / R):($2 / R):(100 * $6 / E) with points pt 7 ps 0.6 lc palette
}
unset multiplot
