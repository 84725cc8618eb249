# A free disk that spins: its angular momentum and its moment of inertia, over those at the start. FLIP with the lumped mass loses the first; a spin that particles carry, APIC, and FLIP with the
# consistent mass keep it. The disk starts without stress and breathes about the size of a steady spin (dashed).
wide = 1300; high = 1000
load 'common/style.gp'
file(name) = run.'/'.name.'/history.dat'
array angular[2] = [col(file('flip_linear'), 'angular_momentum'), col(file('implicit_1'), 'angular_momentum')]
array inertia[2] = [col(file('flip_linear'), 'inertia'), col(file('implicit_1'), 'inertia')]
of(k) = k < 6 ? 1 : 2
turn = 3.14159265
first(name, c) = real(system(sprintf("awk '$1 + 0 == $1 { print $%d; exit }' '%s'", c, file(name))))
names = 'flip_linear flip_quadratic spin_linear spin_quadratic apic_quadratic implicit_1 implicit_10'
titles = '"FLIP, linear" "FLIP, quadratic" "with spin, linear" "with spin, quadratic" "APIC, quadratic" "implicit, {/Symbol a} = 1" "implicit, {/Symbol a} = 10"'
array angular_0[7]
array inertia_0[7]
do for [k = 1:7] {
    angular_0[k] = first(word(names, k), angular[of(k)])
    inertia_0[k] = first(word(names, k), inertia[of(k)])
}
set multiplot title 'A free disk spins, 16 cells across' font ',24'
set lmargin at screen 0.125; set rmargin at screen 0.68
set tmargin at screen 0.92; set bmargin at screen 0.56
set xrange [0:5]
set key at screen 0.7, 0.92 left top
set ylabel 'angular momentum / initial'; set yrange [0.9:1.02]; set format x ''
plot for [k = 1:7] file(word(names, k)) using (column(1) / turn):(column(angular[of(k)]) / angular_0[k]) with lines lt k lw 2 title word(titles, k)
set tmargin at screen 0.49; set bmargin at screen 0.11
set xlabel 'turns'; set ylabel 'moment of inertia / initial'; set yrange [0.98:1.08]; set format x '%g'
unset key; set label 1 "dashes: a steady spin" at screen 0.715, 0.47 left textcolor rgb ink
set arrow from 0, 1.00206 to 5, 1.00206 nohead lc rgb ink lw 1.5 dt 2 front
plot for [k = 1:7] file(word(names, k)) using (column(1) / turn):(column(inertia[of(k)]) / inertia_0[k]) with lines lt k lw 2 title word(titles, k)
unset multiplot
