# Theorem [MPM-13] term by term: two disks meet off center, with friction, and the scheme takes energy on purpose (theta = 0.75, lumped mass). Above, what is left and who took the rest, one band for each; the bands fill the
# initial energy exactly. Below, how exactly: what is left when all terms are counted is round-off, and so is the work of contact.
wide = 1500; high = 1150
load 'common/style.gp'
file = run.'/oblique/history.dat'
kinetic = col(file, 'kinetic'); elastic = col(file, 'elastic'); energy = col(file, 'energy'); theta_velocity = col(file, 'theta_velocity'); theta_strain = col(file, 'theta_strain')
lumped = col(file, 'lumped'); friction = col(file, 'friction'); contact = col(file, 'contact'); residual = col(file, 'residual')
E_0 = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", energy, file)))
set multiplot title 'Where the energy goes: an oblique rebound with friction, implicit, θ = 0.75, lumped mass' font ',24'
set xrange [0.6:2]; set xtics 0.2
set lmargin at screen 0.11; set rmargin at screen 0.745
set tmargin at screen 0.915; set bmargin at screen 0.47
set yrange [0:1]; set ytics 0.2; set ylabel 'energy / initial' offset -0.5, 0
set format x ''
set key at screen 0.755, 0.915 left top Left reverse invert
set border 15
a1(x) = column(kinetic); a2(x) = column(energy); a3(x) = a2(0) - column(friction); a4(x) = a3(0) + column(lumped); a5(x) = a4(0) + column(theta_strain); a6(x) = a5(0) + column(theta_velocity)
plot file using 1:(0):(a1(0) / E_0) with filledcurves fc rgb blue fs solid 0.75 title 'kinetic energy', \
     '' using 1:(a1(0) / E_0):(a2(0) / E_0) with filledcurves fc rgb sky fs solid 0.85 title 'elastic energy', \
     '' using 1:(a2(0) / E_0):(a3(0) / E_0) with filledcurves fc rgb '#444444' title 'friction', \
     '' using 1:(a3(0) / E_0):(a4(0) / E_0) with filledcurves fc rgb pink fs solid 0.85 title 'lumped mass', \
     '' using 1:(a4(0) / E_0):(a5(0) / E_0) with filledcurves fc rgb amber fs solid 0.85 title 'θ, by strain', \
     '' using 1:(a5(0) / E_0):(a6(0) / E_0) with filledcurves fc rgb orange fs solid 0.85 title 'θ, by velocity', \
     '' using 1:(a2(0) / E_0) with lines lc rgb 'white' lw 2 notitle
set border 3
set format x '%g'; set xlabel 't'
set tmargin at screen 0.43; set bmargin at screen 0.1
set logscale y; set yrange [1e-20:10]; set format y '10^{%T}'; set ytics 1e-16, 1e4, 1; set ylabel '|sum since the start| / initial' offset 0.5, 0; set mytics 1
set key at screen 0.755, 0.43 left top Left reverse noinvert
size(what) = abs(column(what)) / E_0 > 1e-20 ? abs(column(what)) / E_0 : NaN
plot file using 1:(size(theta_velocity)) with lines lc rgb orange title 'θ, by velocity', '' using 1:(size(theta_strain)) with lines lc rgb amber title 'θ, by strain', \
     '' using 1:(size(lumped)) with lines lc rgb pink title 'lumped mass', '' using 1:(size(friction)) with lines lc rgb '#444444' title 'friction', \
     '' using 1:(size(contact)) with points pt 7 ps 0.5 lc rgb green title 'contact', '' using 1:(size(residual)) with points pt 7 ps 0.5 lc rgb 'black' title 'residual of all'
unset multiplot
