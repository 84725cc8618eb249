# A disk between two plates (Brazilian test). Above: fringes of the principal stress difference, in each picture computed on the left and, on the right, of Hertz's disk between two line loads of the
# same size. Below: stress on both diameters; points are particles. The plates press a flat, an eighth of the disk wide, not a line: next to it the two differ.
# fits: mpm_explicit theory.compare=disk file:fringes_*.dat file:particles_*.dat result:load
wide = 1500; high = 1330
load 'common/style.gp'
R = real(given('grain.*.radius')); P = result('load'); unit = 2 * P / (pi * 2 * R)
# As many fringes for any load; and wider ones in white light, whose higher orders are pale.
f_sigma = 0.8 * unit; wider = 2.5
load 'mpm_explicit/figures/polariscope.gp'
last(what) = system('ls "'.run.'"/'.what.'_*.dat | tail -n 1')
fringes = last('fringes'); particles = last('particles')
middle(axis) = real(system(sprintf("LC_ALL=C awk '$5 == 0 { s += $%d; n++ } END { print s / n }' '%s'", axis, particles)))
x_0 = middle(1); y_0 = middle(2)
# Hertz's disk, in units of R and of s_xx at its center.
q(x, y) = (x**2 + y**2)**2
xx(x, y) = 1 - 2 * (1 - y) * x**2 / q(x, 1 - y) - 2 * (1 + y) * x**2 / q(x, 1 + y)
yy(x, y) = 1 - 2 * (1 - y)**3 / q(x, 1 - y) - 2 * (1 + y)**3 / q(x, 1 + y)
xy(x, y) = 2 * (1 - y)**2 * x / q(x, 1 - y) - 2 * (1 + y)**2 * x / q(x, 1 + y)
hertz(x, y) = unit * sqrt((xx(x, y) - yy(x, y))**2 + 4 * xy(x, y)**2)
X = '(($1 - x_0) / R)'; Y = '(($2 - y_0) / R)'
# s1 - s2 of a pixel: computed, or theory, or -1 outside of the disk; -2 in a plate.
pixel = sprintf('($5 > 0 ? -2 : %s <= 0 ? ($5 < 0 ? -1 : $3) : %s**2 + %s**2 < 1 ? hertz(%s, %s) : -1)', X, X, Y, X, Y)
light(d) = d == -2 ? 0.3 : d < 0 ? 0 : dark_field(d / f_sigma)
channel(d, n) = d == -2 ? 140 : d < 0 ? 0 : n == 1 ? white_R[entry_of(d / f_sigma / wider)] : n == 2 ? white_G[entry_of(d / f_sigma / wider)] : white_B[entry_of(d / f_sigma / wider)]
set multiplot title (entry('program') eq 'mpm_implicit' ? sprintf('A disk between two plates, implicit, α = %g, θ = %g', parameter('alpha'), parameter('theta')) : 'A disk between two plates') font ',24'
side = 0.405; top = 0.935
set xrange [-1.15:1.15]; set yrange [-1.15:1.15]; set xtics 0.5; set ytics 0.5
set xlabel 'x / R'
set label 1 'computed' at graph 0.02, 0.125 front textcolor rgb 'white'
set label 2 'theory' at graph 0.98, 0.125 right front textcolor rgb 'white'
set arrow 1 from 0, -1 to 0, 1 nohead front lc rgb 'white' lw 1 dt 3
do for [k = 1:2] {
    eval (k == 1 ? in_one_color : in_white_light); unset colorbox; set size noratio
    left = k == 1 ? 0.085 : 0.575
    set lmargin at screen left; set rmargin at screen left + side
    set tmargin at screen top; set bmargin at screen top - side * wide / high
    if (k == 1) {
        set ylabel 'y / R' offset 1, 0
        plot fringes skip 1 using @X:@Y:(light(@pixel)) with image
    } else {
        unset ylabel
        plot fringes skip 1 using @X:@Y:(d = @pixel, channel(d, 1)):(channel(d, 2)):(channel(d, 3)) with rgbimage
    }
}
eval daylight
unset label 1; unset label 2; unset arrow 1; unset colorbox; set border 3
set tmargin at screen 0.37; set bmargin at screen 0.085
set xrange [-1:1]; set yrange [-8:2]; set ytics 2; set samples 400
h = parameter('length_x') / parameter('cells_x')
line(along, across, stress) = sprintf("using (abs($%d - %s) < 0.35 * h && $5 == 0 ? ($%d - %s) / R : NaN):($%d / unit)", across, across == 1 ? 'x_0' : 'y_0', along, along == 1 ? 'x_0' : 'y_0', stress)
mark = 'with points pt 7 ps 0.7'
set key center bottom
set lmargin at screen 0.085; set rmargin at screen 0.085 + side
set ylabel 'stress / (2P/πD)' offset 0.5, 0
on_x_xx = line(1, 2, 6); on_x_yy = line(1, 2, 7); on_y_xx = line(2, 1, 6); on_y_yy = line(2, 1, 7)
plot particles @on_x_xx @mark lc rgb blue title 'σ_{xx} on y = 0', particles @on_x_yy @mark lc rgb orange title 'σ_{yy} on y = 0', \
     xx(x, 0) with lines lt 8 lw 2 title 'theory', yy(x, 0) with lines lt 8 lw 2 notitle
set lmargin at screen 0.575; set rmargin at screen 0.575 + side
set xlabel 'y / R'; unset ylabel
plot particles @on_y_xx @mark lc rgb blue title 'σ_{xx} on x = 0', particles @on_y_yy @mark lc rgb orange title 'σ_{yy} on x = 0', \
     xx(0, x) with lines lt 8 lw 2 title 'theory', yy(0, x) with lines lt 8 lw 2 notitle
unset multiplot
