# energies.gp: a panel with the energies of the run, relative to the kinetic energy at the start or to energy_unit, to be loaded within a multiplot. A script may set
# energy_unit, energy_label, energy_low, energy_high and energy_key.
kinetic = col(history, 'kinetic'); field = col(history, 'field'); energy = col(history, 'energy')
if (!exists('energy_unit')) {
    energy_unit = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { print $%d; exit }' '%s'", kinetic, history)))
    energy_label = 'energy / initial kinetic'; energy_low = 0; energy_high = 1.15
}
if (!exists('energy_key')) energy_key = 'center left'
set xrange [0:parameter('end')]; set xtics auto
set yrange [energy_low:energy_high]; set ytics auto
set xlabel 't ω_p'; set ylabel energy_label offset 0.5, 0
set key @energy_key
plot history using t:(column(energy) / energy_unit) with lines lt 8 lw 2 title 'total', \
     history using t:(column(kinetic) / energy_unit) with lines lt 1 title 'kinetic', \
     history using t:(column(field) / energy_unit) with lines lt 2 title 'field'
set xrange [*:*]; set yrange [*:*]
