# Errors of Sod's shock tube against the number of cells, at 16 particles per cell and Courant number 0.3. flip converges at first order, the best there is with shocks. pic does not: a particle
# that enters a cell changes its pressure by a sixteenth, and finer meshes take more steps in which this noise grows, in the rarefaction and at the contact. Shorter steps or more particles put it off.
wide = 1500; high = 760
load 'common/style.gp'
names = 'flip pic pic_short pic_many'
titles = '"flip" "pic" "pic, Courant number 0.1" "pic, 64 particles per cell"'
tint = blue.' '.orange.' '.green.' '.amber
set multiplot title "Sod's shock tube: errors" font ',24'
set bmargin at screen 0.14; set tmargin at screen 0.88
set logscale xy
set xrange [40:1000]; set xtics (50, 100, 200, 400, 800); set xlabel 'cells'
set format y '10^{%T}'
do for [k = 1:2] {
    set lmargin at screen (k == 1 ? 0.11 : 0.6); set rmargin at screen (k == 1 ? 0.48 : 0.97)
    if (k == 1) { set yrange [6e-4:0.3]; set ylabel 'L_1(density) / larger density'; set key at graph 0.02, 0.985 top left } else { set yrange [1.5e-3:0.1]; set ylabel 'L_1(velocity)'; unset key }
    first = k == 1 ? 0.013 : 0.033
    plot for [n = 1:4] run.'/errors_'.word(names, n).'.dat' using 1:(column(k + 1)) with linespoints pt 7 ps 1.2 lc rgb word(tint, n) title word(titles, n), \
         first * 50 / x with lines dt 2 lw 2 lc rgb ink title 'first order'
}
unset multiplot
