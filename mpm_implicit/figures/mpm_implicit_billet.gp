# A block between plates, pressed so slowly that sound would pass through a cell a thousand times in one step. Left, the stress on the plate against strain: the few steps of the implicit program lie on the line of theory, of slope
# E/(1 - nu^2), and so do the many of the explicit one, damped. Right, what it takes: seconds for the whole compression against the CFL number.
wide = 1500; high = 760
load 'common/style.gp'
E = 1e5; nu = 0.3; width = 0.6; height = 0.4
implicit = run.'/alpha_1000/history.dat'; leapfrog = run.'/explicit/history.dat'
strain_of(file) = sprintf('(-100 * $%d / height)', col(file, 'travel_y_top'))
stress_of(file) = sprintf('(1000 * abs($%d) / width / E)', col(file, 'force_y_top'))
i_strain = strain_of(implicit); i_stress = stress_of(implicit); e_strain = strain_of(leapfrog); e_stress = stress_of(leapfrog)
explicit_wall = real(system(sprintf("LC_ALL=C awk '{ print $3 }' '%s'", run.'/costs_explicit.dat'))); explicit_steps = real(system(sprintf("LC_ALL=C awk '{ print $2 }' '%s'", run.'/costs_explicit.dat')))
implicit_steps = real(system(sprintf("LC_ALL=C awk '$1 == 1000 { print $2 }' '%s'", run.'/costs.dat')))
set multiplot title 'A slowly pressed block, implicit and explicit' font ',24'
set lmargin at screen 0.085; set rmargin at screen 0.48
set tmargin at screen 0.82; set bmargin at screen 0.14
set title 'stress on the plate / (10^{−3} E)' offset 0, -0.5
set xlabel 'strain / %'; set xrange [0:1.1]; set xtics 0.2; set yrange [0:14]; set ytics 2
set key top left
plot leapfrog using @e_strain:@e_stress with lines lt 5 lw 5 title sprintf('explicit, α = 1/4, %.0f steps', explicit_steps), \
     10 * x / (1 - nu**2) with lines lt 8 dt 2 lw 2 title 'theory', \
     implicit using @i_strain:@i_stress with points pt 7 ps 1.5 lc rgb blue title sprintf('implicit, α = 1000, %.0f steps', implicit_steps)
set lmargin at screen 0.6; set rmargin at screen 0.97
set title 'wall time / s'
set logscale xy; set xlabel 'α'; set xrange [0.15:2000]; set xtics ('1/4' 0.25, '1' 1, '4' 4, '16' 16, '64' 64, '250' 250, '1000' 1000)
set yrange [0.005:200]; set ytics (0.01, 0.1, 1, 10, 100)
set key bottom left
plot run.'/costs.dat' using 1:3 with linespoints lt 1 ps 1.6 title 'implicit', '+' using (0.25):(explicit_wall) every ::0::0 with points pt 5 ps 2 lc rgb amber title 'explicit', explicit_wall with lines lc rgb amber lw 1.5 dt 2 notitle
unset multiplot
