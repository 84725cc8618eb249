# species.gp: what phase_row.gp draws of a run whose species it does not know: phase_*.dat, all densities added up, or dots in a color for each species; and ranges from the data.
field_label = '|E_k|'; density_title = 'f / n_0'
x_label = 'x'; v_label = 'v_x'
kind = times_of('particles', 1) ne '' ? 'particles' : 'phase'
sample = file_at(kind, parameter('end'))
of_v = sample eq '' ? 0 : col(sample, 'v_x')
if (kind eq 'particles' && sample ne '') {
    colors_of_species = system("awk '$1 + 0 == $1 && $1 > m { m = $1 } END { print m + 1 }' '".sample."'")
    colors_of_species = int(colors_of_species) > 1 ? blue.' '.orange.' '.green.' '.pink.' '.amber.' '.sky.' '.gray.' '.blue : blue
    farthest = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { v = $%d < 0 ? -$%d : $%d; if (v > m) m = v } END { print 1.05 * m }' '%s'", of_v, of_v, of_v, sample)))
} else { if (sample ne '') {
    density = system(sprintf("awk -f common/columns.awk '%s' | awk 'NR > 2 { printf \"%%s$%%d\", (NR > 3 ? \" + \" : \"\"), $1 }'", sample))
    density_top = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { f = 0; for (i = 3; i <= NF; i++) f += $i; if (f > m) m = f } END { print m }' '%s'", sample)))
    farthest = real(system(sprintf("LC_ALL=C awk '$1 + 0 == $1 { f = 0; for (i = 3; i <= NF; i++) f += $i; v = $2 < 0 ? -$2 : $2; if (f > 1e-3 * %g && v > m) m = v } END { print 1.05 * m }' '%s'", density_top, sample)))
    density_step = 10**floor(log10(density_top))
} }
if (sample ne '') {
    v_low = -farthest; v_high = farthest
    v_step = 10**floor(log10(farthest)); v_step = farthest / v_step < 2 ? 0.5 * v_step : farthest / v_step < 5 ? v_step : 2 * v_step
}
