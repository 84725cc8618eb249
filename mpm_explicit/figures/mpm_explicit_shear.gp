# The explicit side of figure 7 of the talk: particle positions, colored by velocity, and fringes of the principal stress difference in equal disks between two rows of rigid ones (gray), the upper of
# which moves to the right with U. Chains of force lean against the motion and tighten as the rows climb on each other. s1 - s2 grows by 0.025 E from one dark fringe to the next.
wide = 1500; high = 1060
load 'common/style.gp'
f_sigma = 2500.0
load 'mpm_explicit/figures/polariscope.gp'
U = given('pack.top.velocity_x') + 0; L = parameter('length_x'); height = 0.92
particles = system('ls "'.run.'"/particles_*.dat | tail -n 3'); fringes = system('ls "'.run.'"/fringes_*.dat | tail -n 3')
with_rigid = "using 1:2:($5 < 0 ? 0 : $5 < 5 || $5 > 19 ? 0.3 : dark_field($3 / f_sigma)) with image"
panel_width = 0.268; gap = 0.018
panel_height = panel_width * wide / high * height / L
set multiplot title sprintf('Equal disks in shear, %s, α = %g', entry('program') eq 'mpm_implicit' ? 'implicit' : 'explicit', parameter('alpha')) font ',24'
set xrange [0:L]; set yrange [0:height]; set xtics 0, 0.2, 0.9; set ytics 0.2
unset key
do for [row = 1:2] { do for [k = 1:3] {
    left = 0.075 + (k - 1) * (panel_width + gap); top = 0.885 - (row - 1) * (panel_height + 0.04)
    set lmargin at screen left; set rmargin at screen left + panel_width
    set tmargin at screen top; set bmargin at screen top - panel_height
    if (row == 1) {
        set border 15; unset grid; set format x ''; unset xlabel
        set title sprintf('shift %.3f L', U * time_of(word(particles, k)) / L) offset 0, -0.5
        eval colors(viridis); set cbrange [0:1]; set cbtics 0.25
        if (k == 3) { set colorbox user origin left + panel_width + 0.013, top - panel_height size 0.012, panel_height; set label 82 'v_x / U' at screen 0.985, top right offset 0, 1 } else { unset colorbox; unset label 82 }
    } else {
        unset label 82
        eval in_one_color; unset colorbox; set size noratio; unset title; set format x '%g'; set xlabel 'x / L'
    }
    if (k == 1) { set ylabel 'y / L' offset 0.5, 0; set format y '%g' } else { unset ylabel; set format y '' }
    if (row == 1) {
        plot word(particles, k) using 1:($5 < 5 || $5 > 19 ? $2 : NaN) with points pt 7 ps 0.35 lc rgb '#9a9a9a', \
             word(particles, k) using 1:($5 < 5 || $5 > 19 ? NaN : $2):($3 / U) with points pt 7 ps 0.35 lc palette
    } else { plot word(fringes, k) @with_rigid }
} }
unset multiplot
