# phase_row.gp: a row of panels with phase space (x, v_x) at some times, to be loaded within a multiplot. A script sets times, x_label, v_label, v_low, v_high,
# v_step, row_bottom and row_top (screen), and either colors_of_species, for dots, or density, what to add up of phase_*.dat, e.g. '$3 + $4', density_top and density_step.
# With wave_speed a line is drawn at the phase velocity of theory. x_low and x_of, what to draw as x, cut the periodic box elsewhere than at 0.
if (!exists('density')) density = ''
if (!exists('density_title')) density_title = 'f v_{th}/n_0'
if (!exists('x_low')) { x_low = 0; x_of = '$2' }
panels = words(times)
gap = 0.018
row_right = density ne '' ? 0.895 : 0.985
panel_width = (row_right - 0.075 - (panels - 1) * gap) / panels
set border 15; set tics front
set xrange [x_low:x_low + parameter('length_x')]; set yrange [v_low:v_high]
set xlabel x_label; set xtics auto; set format y '%g'
set bmargin at screen row_bottom; set tmargin at screen row_top
unset key
if (density ne '') { eval colors(inferno); set cbrange [0:density_top]; unset grid }
if (exists('wave_speed')) { set arrow 81 from graph 0, first wave_speed to graph 1, first wave_speed nohead front dashtype 2 linewidth 1.6 linecolor rgb gray }
do for [k = 1:panels] {
    left = 0.075 + (k - 1) * (panel_width + gap)
    set lmargin at screen left; set rmargin at screen left + panel_width
    set title sprintf('t ω_p = %.4g', real(word(times, k))) offset 0, -0.6
    if (k == 1) { set ylabel v_label offset 0.3, 0; set ytics v_step } else { unset ylabel; set ytics v_step format '' }
    if (k == 1 && exists('wave_speed')) { set label 81 'ω/k' at graph 0.04, first wave_speed offset 0, -0.7 front textcolor rgb gray } else { unset label 81 }
    if (density ne '') {
        if (k == panels) { set colorbox user origin 0.908, row_bottom size 0.012, row_top - row_bottom; set cbtics density_step; set label 82 density_title at screen 0.985, row_top right offset 0, 1.1 } else { unset colorbox }
        plot file_at('phase', real(word(times, k))) using 1:2:(@density) with image
    } else {
        picture = file_at('particles', real(word(times, k))); v_x = col(picture, 'v_x')
        # Species in turns, so that none covers the others.
        plot for [turn = 0:3] for [s = 1:words(colors_of_species)] picture every 4::turn \
            using ($1 == s - 1 ? @x_of : NaN):v_x with points pointtype 7 pointsize 0.1 linecolor rgb word(colors_of_species, s)
    }
}
unset title; unset arrow 81; unset label 81; unset label 82; set border 3; set format y '%g'; set grid
unset lmargin; unset rmargin; unset tmargin; unset bmargin
