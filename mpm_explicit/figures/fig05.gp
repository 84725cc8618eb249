# Figure 5 of the talk: fringes of the principal stress difference in grains that a plate compresses, explicit, with a CFL number of 0.25. Above in one color, below in white light; s1 - s2
# grows by 0.02 E from one order to the next (the scale). With linear shape functions, the talk's, particles that cross from cell to cell crumple the fringes; with gimp they are smooth.
wide = 1500; high = 1220
load 'common/style.gp'
f_sigma = 2000.0
load 'mpm_explicit/figures/polariscope.gp'
folder = run
plate = 0.7196   # its lower side at the start
shapes = 'linear gimp'
run = folder.'/linear'
panel_width = 0.405; top_of_grains = 0.73
panel_height = panel_width * wide / high * top_of_grains
set multiplot title sprintf('Compressed grains in a polariscope, %s, α = %g', entry('program') eq 'mpm_implicit' ? 'implicit' : 'explicit', parameter('alpha')) font ',24'
set xrange [0:1]; set yrange [0:top_of_grains]; set xtics 0.2; set ytics 0.2
do for [row = 1:2] { do for [column = 1:2] {
    run = folder.'/'.word(shapes, column)
    if (row == 1) { eval in_one_color; unset colorbox } else { eval in_white_light }
    set size noratio
    travel = real(system(sprintf("LC_ALL=C awk 'END { print $%d }' '%s'", col(run.'/history.dat', 'travel_y_plate'), run.'/history.dat')))
    set object 1 rectangle from 0, plate + travel to 1, graph 1 front fillcolor rgb '#8a8a8a' fillstyle solid noborder
    left = 0.075 + (column - 1) * (panel_width + 0.04); top = 0.89 - (row - 1) * (panel_height + 0.045)
    set lmargin at screen left; set rmargin at screen left + panel_width
    set tmargin at screen top; set bmargin at screen top - panel_height
    if (row == 1) { set title (column == 1 ? 'linear shape functions' : 'gimp') offset 0, -0.4; set format x ''; unset xlabel } else { unset title; set format x '%g'; set xlabel 'x / L' }
    if (column == 1) { set ylabel 'y / L' offset 1, 0; set format y '%g' } else { unset ylabel; set format y '' }
    file = system('ls "'.run.'"/fringes_*.dat | tail -n 1')
    if (row == 1) { plot file @one_color notitle } else { plot file @white_light notitle }
} }
do for [row = 1:2] {
    set lmargin at screen 0.94; set rmargin at screen 0.958
    top = 0.89 - (row - 1) * (panel_height + 0.045); set tmargin at screen top; set bmargin at screen top - panel_height
    if (row == 1) { eval in_one_color; set label 1 'order' at screen 0.985, top right offset 0, 1 } else { eval in_white_light; unset label 1 }
    eval scale_of_orders
    if (row == 1) { plot '++' @orders_in_one_color notitle } else { plot '++' @orders_in_white_light notitle }
}
unset multiplot
