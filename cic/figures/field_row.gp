# field_row.gp: a row of pictures of a field in the plane (x, z) at some times, in true proportions, to be loaded within a multiplot. A script sets times, x_label, z_label,
# plane_step, row_top (screen), field_of, what to draw of fields_*.dat, e.g. '-column(rho)', the columns it names, its colors by  eval colors(...)  and cbrange, and field_title.
times = near('fields', times)
panels = words(times)
gap = 0.018
panel_width = (0.895 - 0.075 - (panels - 1) * gap) / panels
row_bottom = row_top - panel_width * wide / high * parameter('length_z') / parameter('length_x')
set border 15; set tics front; unset grid; unset key
set xrange [0:parameter('length_x')]; set yrange [0:parameter('length_z')]
set xlabel x_label; set xtics 0, plane_step, parameter('length_x') - 0.3 * plane_step
set bmargin at screen row_bottom; set tmargin at screen row_top
do for [k = 1:panels] {
    left = 0.075 + (k - 1) * (panel_width + gap)
    set lmargin at screen left; set rmargin at screen left + panel_width
    set title sprintf('t ω_p = %.4g', real(word(times, k))) offset 0, -0.6
    if (k == 1) { set ylabel z_label offset 0.3, 0; set ytics plane_step } else { unset ylabel; set ytics plane_step format '' }
    if (k == panels) {
        set colorbox user origin 0.908, row_bottom size 0.012, row_top - row_bottom
        set label 82 field_title at screen 0.985, row_top right offset 0, 1.1
    } else { unset colorbox }
    plot file_at('fields', real(word(times, k))) using 1:2:(@field_of) with image
}
unset title; unset label 82; set border 3; set format y '%g'; set grid; set ytics auto
unset lmargin; unset rmargin; unset tmargin; unset bmargin
