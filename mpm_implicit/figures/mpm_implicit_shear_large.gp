# Poured disks whose radii differ by up to a fifth (the smallest of radius R), sheared under pressure between two rows of rigid ones (gray), the upper of which moves to the right with U and slowly down; implicit with a CFL number of 4. Left, particles colored by velocity;
# right, fringes of the principal stress difference, which grows by 0.025 E from one dark fringe to the next: chains of force lean against the motion, branch, and leave grains between them in the dark.
wide = 1700; high = 990
load 'common/style.gp'
f_sigma = 2500.0
load 'mpm_explicit/figures/polariscope.gp'
U = 0.3; L = 2.6; height = 2.92; R = 0.1
particles = system('ls "'.run.'"/particles_*.dat | tail -n 1'); fringes = system('ls "'.run.'"/fringes_*.dat | tail -n 1')
rigid(g) = g < 13 || g > 156
light(g, s) = g < 0 ? 0 : rigid(g) ? 0.3 : dark_field(s / f_sigma)
travel = real(system(sprintf("LC_ALL=C awk 'END { print $%d }' '%s'", col(run.'/history.dat', 'travel_x_top_g0001'), run.'/history.dat')))
set multiplot title sprintf('Disks in shear, implicit, α = 4, shift %.1f R', travel / R) font ',24'
set xrange [0:L / R]; set yrange [0:height / R]; set xtics 5; set ytics 5
unset key
panel_width = 0.385; panel_height = panel_width * wide / high * height / L
do for [k = 1:2] {
    left = k == 1 ? 0.075 : 0.595; top = 0.9
    set lmargin at screen left; set rmargin at screen left + panel_width
    set tmargin at screen top; set bmargin at screen top - panel_height
    set xlabel 'x / R'
    if (k == 1) {
        set border 15; unset grid; set ylabel 'y / R' offset 0.5, 0
        eval colors(viridis); set cbrange [0:1]; set cbtics 0.25
        set colorbox user origin left + panel_width + 0.013, top - panel_height size 0.012, panel_height; set label 82 'v_x / U' at screen left + panel_width + 0.02, top center offset 0, 0.8
        plot particles using ($1 / R):(rigid($5) ? $2 / R : NaN) with points pt 7 ps 0.36 lc rgb '#9a9a9a', '' using ($1 / R):(rigid($5) ? NaN : $2 / R):($3 / U) with points pt 7 ps 0.36 lc palette
    } else {
        unset label 82; unset ylabel
        eval in_one_color; unset colorbox; set size noratio
        plot fringes skip 1 using ($1 / R):($2 / R):(light($5, $3)) with image
    }
}
unset multiplot
