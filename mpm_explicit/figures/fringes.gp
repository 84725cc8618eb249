# Grains of any run in a polariscope at four of its times, in light of one color: dark lines are the orders 0, 1, 2 ... of the principal stress difference, as far
# apart as a quarter of the largest stress difference at the end, but for a hundredth of the pixels.
# fits: mpm_explicit|mpm_implicit kinds:fringes
wide = 1600; high = 560
load 'common/style.gp'
times = times_of('fringes', 4)
count = words(times)
f_sigma = real(system(sprintf("awk '$5 + 0 == $5 && $5 >= 0 { print $3 }' '%s' | LC_ALL=C sort -g | awk '{ s[NR] = $1 } END { print NR ? 0.25 * s[int(0.99 * NR)] : 1 }'", file_at('fringes', parameter('end')))))
if (!(f_sigma > 0)) f_sigma = 1
load 'mpm_explicit/figures/polariscope.gp'
set multiplot title run.sprintf(': one fringe is a stress difference of %.3g', f_sigma) noenhanced font ',24'
size_of = system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { if ($1 > x) x = $1; if ($2 > y) y = $2; if (!n || $1 < a) a = $1; if (!n++ || $2 < b) b = $2 } END { print a, x, b, y }' '%s'", file_at('fringes', 0)))
set xrange [word(size_of, 1):word(size_of, 2)]; set yrange [word(size_of, 3):word(size_of, 4)]
do for [k = 1:count] {
    eval in_one_color; unset colorbox
    set lmargin at screen 0.07 + (k - 1) * 0.9 / count; set rmargin at screen 0.05 + k * 0.9 / count
    set bmargin at screen 0.14; set tmargin at screen 0.8
    set title sprintf('time %.4g', real(word(times, k)))
    set xlabel 'x'; set xtics 0.25 * (real(word(size_of, 2)) - real(word(size_of, 1))) format '%.2g'; set ytics 0.25 * (real(word(size_of, 4)) - real(word(size_of, 3)))
    if (k == 1) { set ylabel "y"; set format y "%.2g" } else { unset ylabel; set format y "" }
    plot file_at('fringes', real(word(times, k))) @one_color
}
unset multiplot
