# A disk that yields meets a rigid wall at x = 0. Above: its particles, colored by plastic strain; the dashed circle has its center and its first radius. Below: where the energy goes; it leaves with
# a small part of what it brought, vibrating, and most of the rest is plastic work, which never comes back.
# fits: mpm_explicit|mpm_implicit theory.compare=yield file:particles_*.dat result:largest_plastic_strain
wide = 1500; high = 1060
load 'common/style.gp'
R = real(given('grain.*.radius')); v_0 = abs(real(given('grain.*.velocity_x')))
file = run.'/history.dat'
kinetic = col(file, 'kinetic'); elastic = col(file, 'elastic'); plastic = col(file, 'plastic'); contact = col(file, 'contact'); release = entry('program') eq 'mpm_explicit' ? col(file, 'release') : 0
E_0 = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", kinetic, file)))
picture(t) = file_at('particles', t)
strain = col(picture(0), 'plastic_strain')
middle(t, axis) = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { s += $%d; n++ } END { print s / n }' '%s'", axis, picture(t))))
times = near('particles', sprintf('%g %g %g', 0.2 * R / v_0, 0.3 * R / v_0, 0.6 * R / v_0))
set multiplot title 'A disk that yields' font ',24'
set border 15; unset grid; unset key
set xrange [0:2.5]; set yrange [0.3:2.7]; set xtics 0, 0.5, 2; set ytics 0.5
set xlabel 'x / R'
eval colors(viridis); set cbrange [0:result("largest_plastic_strain")]
panel = 0.265; gap = 0.02; top = 0.87; bottom = top - panel * wide / high * 2.4 / 2.5
do for [k = 1:words(times)] {
    t = real(word(times, k))
    left = 0.075 + (k - 1) * (panel + gap)
    set lmargin at screen left; set rmargin at screen left + panel
    set tmargin at screen top; set bmargin at screen bottom
    set title sprintf('t = %.1f R/v_0', t * v_0 / R) offset 0, -0.5
    if (k == 1) { set ylabel 'y / R' offset 0.5, 0; set format y '%g' } else { unset ylabel; set format y '' }
    if (k == words(times)) { set colorbox user origin left + panel + 0.015, bottom size 0.012, top - bottom; set label 82 'plastic strain' at screen 0.995, top right offset 0, 1 } else { unset colorbox }
    set object 1 circle at middle(t, 1) / R, middle(t, 2) / R size 1 front fillstyle empty border lc rgb ink lw 1.5 dt 2
    plot picture(t) using ($1 / R):($2 / R):strain with points pt 7 ps 1.05 lc palette
}
unset object 1; unset label 82; unset title; set border 3; set grid; set format y '%g'
end = parameter('end')
set xrange [0:end * v_0 / R]; set xtics 0.1; set xlabel 't / (R/v_0)'
set tmargin at screen 0.39; set bmargin at screen 0.1
set lmargin at screen 0.095; set rmargin at screen 0.72
set yrange [0:1.05]; set ytics 0.25
set ylabel 'energy / initial'
# The work of contact is negative: what it took; in the explicit program also where it opens.
lower(n) = (n > 1 ? column(kinetic) : 0) + (n > 2 ? column(elastic) : 0) + (n > 3 ? column(plastic) : 0)
upper(n) = lower(n) + (n == 1 ? column(kinetic) : n == 2 ? column(elastic) : n == 3 ? column(plastic) : -column(contact) - (release ? column(release) : 0))
tint = blue.' '.green.' '.orange.' '.gray
array heading[4] = ['kinetic', 'elastic', 'plastic work', 'lost in contact']
set key at screen 0.98, 0.3 right center
plot for [n = 4:1:-1] file using ($1 * v_0 / R):(lower(n) / E_0):(upper(n) / E_0) with filledcurves fs solid 0.55 noborder lc rgb word(tint, n) title heading[n]
set key default
unset multiplot
