# The energy theorem carried from the material point method to the plasma: warm electrons on a mesh of 12 Debye lengths, where nothing physical happens.
# Left: the change of the total energy. The explicit code heats, the predicted current cools, and with the mass matrix the energy changes by what theta takes and by nothing
# else (line: run; circles: -(theta - 1/2) times the sum of V (|dE|^2 + |dB|^2) / 4 pi over the steps). Right: all other changes, on a logarithmic scale.
wide = 1500; high = 700
load 'common/style.gp'
history(name) = run.'/'.name.'/history.dat'
t = col(history('half'), 'time'); drift = col(history('half'), 'energy_drift')
energy = col(history('half'), 'energy'); by_theta = col(history('half'), 'energy_by_theta'); residual = col(history('half'), 'energy_residual')
te = col(history('explicit'), 'time'); de = col(history('explicit'), 'energy_drift')
stats history('one') every ::1::1 using energy nooutput
E0 = STATS_max
set multiplot title 'Energy of a plasma that the mesh does not resolve, {/Symbol D}x = 12 {/Symbol l}_D, {/Symbol w}_p{/Symbol D}t = 0.5' font ',22'
set tmargin at screen 0.88; set bmargin at screen 0.15
set lmargin at screen 0.085; set rmargin at screen 0.50
set xlabel 't {/Symbol w}_p'; set ylabel 'change of the energy [%]' offset 0.8, 0
set xrange [0:1000]
set key at graph 0.02, 0.985 left top
plot history('explicit') using te:(100 * column(de)) with lines linetype 2 title 'explicit', \
     history('moments') using t:(100 * column(drift)) with lines linetype 3 title 'implicit, moments', \
     history('half') using t:(100 * column(drift)) with lines linetype 1 title 'mass matrix, θ = 1/2', \
     history('one') using t:(100 * column(drift)) with lines linetype 4 title 'mass matrix, θ = 1', \
     history('one') every 100 using t:(100 * column(by_theta) / E0) @published title 'what θ takes'
set lmargin at screen 0.60; set rmargin at screen 0.97
set ylabel 'change of the energy but for θ' offset 0.5, 0
set logscale y; set yrange [1e-17:1]; set format y '10^{%T}'
set key at graph 0.98, 0.55 right top
plot history('explicit') using te:(abs(column(de))) with lines linetype 2 title 'explicit', \
     history('moments') using t:(abs(column(residual))) with lines linetype 3 title 'moments', \
     history('half') every 10 using t:(abs(column(residual)) + 1e-17) with lines linetype 1 title 'mass matrix, θ = 1/2', \
     history('one') every 10 using t:(abs(column(residual)) + 1e-17) with lines linetype 4 title 'mass matrix, θ = 1'
unset multiplot
