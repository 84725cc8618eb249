# radial.gp: density on the plane with flip, and radial profiles of both programs against the exact solution. A script sets head, R (radius of the shock, exact), x_top, colors_top, rho_step,
# bottoms, tops and steps of the three profiles, and exact(k), the value of the exact k-th in a row of profile.dat.
folder(p) = run.'/'.p
file(p) = folder(p).'/profile.dat'
map = system(sprintf('ls "%s"/flip/fields_*.dat | tail -1', run))
set multiplot title head font ',24'
set bmargin at screen 0.1; set tmargin at screen 0.87
set lmargin at screen 0.075; set rmargin at screen 0.44
eval colors(viridis); set cbrange [0:colors_top]; set cbtics rho_step
set colorbox user origin 0.455, 0.1 size 0.012, 0.77
unset grid; set border 15; set size ratio -1; set tics out
set xrange [0:x_top]; set yrange [0:x_top]; set xtics 0.2; set ytics 0.2
set xlabel 'x' offset 0, 0.5; set ylabel 'z' offset 1.4, 0
set title 'density, flip' offset 0, -0.6
set parametric; set trange [0:pi / 2]
plot map using 1:2:3 with image notitle, R * cos(t), R * sin(t) with lines lw 1.6 dt 2 lc rgb 'white' title ''
unset parametric; unset title; set border 3; set grid; set size noratio; unset xlabel
names = 'rho v_r p'
labels = 'density velocity pressure'
do for [k = 1:3] {
    set lmargin at screen 0.585; set rmargin at screen 0.975
    bottom = 0.1 + (3 - k) * 0.27
    set bmargin at screen bottom; set tmargin at screen bottom + 0.23
    set xrange [0:x_top]
    set yrange [word(bottoms, k):word(tops, k)]; set ytics real(word(steps, k))
    set format x (k < 3 ? '' : '%g')
    if (k == 3) { set xlabel 'r' offset 0, 0.5 }
    set ylabel word(labels, k) offset 1, 0
    if (k == 1) { set key at screen 0.79, 0.93 center top maxrows 1 } else { unset key }
    y = col(file('pic'), word(names, k));     plot file('flip') using 1:(exact(k)) with lines lw 2 lc rgb ink title 'exact', \
         file('pic') using 1:y with points pt 7 ps 0.8 lc rgb orange title 'pic', \
         file('flip') using 1:y with points pt 7 ps 0.8 lc rgb blue title 'flip'
}
unset multiplot
