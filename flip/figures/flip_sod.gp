# Sod's shock tube at t = 0.2 on 100 cells, with 16 particles in each, against the exact solution. The shock is at x = 0.85, the contact, where only density and internal energy jump, at
# x = 0.685, the rarefaction from 0.26 to 0.49. pic is noisy behind the shock and sharp at its front, flip is smooth; both keep the contact sharp, for particles do not mix.
wide = 1500; high = 1000
load 'common/style.gp'
file(n) = run.'/'.word('pic flip', n).'/profile.dat'
set multiplot title "Sod's shock tube" font ',24'
names = 'rho u p e'
labels = 'density velocity pressure "internal energy"'
tops = '1.1 1.05 1.1 3.15'
bottoms = '0 -0.05 0 1.6'
steps = '0.2 0.2 0.2 0.5'
set xrange [0:1]; set xtics 0.2
do for [k = 1:4] {
    left = k % 2 == 1 ? 0.085 : 0.575
    bottom = k < 3 ? 0.53 : 0.085
    set lmargin at screen left; set rmargin at screen left + 0.405
    set bmargin at screen bottom; set tmargin at screen bottom + 0.385
    set yrange [word(bottoms, k):word(tops, k)]; set ytics real(word(steps, k))
    set ylabel word(labels, k) offset 0.8, 0
    if (k > 2) { set xlabel 'x' offset 0, 0.4 } else { unset xlabel }
    if (k == 1) { set key top right } else { unset key }
    y = col(file(1), word(names, k)); exact = col(file(1), word(names, k).'_exact')
    plot file(1) using 1:exact with lines lw 2 lc rgb ink title 'exact', \
         file(1) using 1:y with points pt 7 ps 0.9 lc rgb orange title 'pic', \
         file(2) using 1:y with points pt 7 ps 0.9 lc rgb blue title 'flip'
}
unset multiplot
