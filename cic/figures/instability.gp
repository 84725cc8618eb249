# A wave against theory, of any run: phase space at some of its times, above the growth of the field and, unless a script names another last_panel to load, the energies. A script may set
# heading and what phase_row.gp and growth.gp ask for; else it is found in the run. The times wanted are in `times`, or else follow from growth: shortly before
# the onset, when particles are trapped, later, and the last.
# fits: cic theory.compare=wave result:growth result:theory_growth
if (!exists('ink')) wide = 1500; high = 1080; load 'common/style.gp'
if (!exists('last_panel')) last_panel = 'cic/figures/energies.gp'
if (!exists('density') && !exists('colors_of_species')) load 'cic/figures/species.gp'
kind = exists('density') ? 'phase' : 'particles'
if (exists('times')) { times = near(kind, times) } else {
    onset = entry('results.onset.value'); rate = result('theory_growth')
    times = onset eq '' || rate <= 0 ? times_of(kind, 4) : system(sprintf("sh common/snapshots.sh near '%s' %s '%g %g %g %g' 2>/dev/null", \
        run, kind, real(onset) + 1 / rate, real(onset) + 4 / rate, real(onset) + 8 / rate, parameter('end')))
}
marks = times
as_is = exists('heading') ? '' : 'noenhanced'
if (!exists('heading')) heading = sprintf('wave of mode %d in %s', result('mode_x'), run)
set multiplot title heading @as_is font ',24'
if (times ne '') row_bottom = 0.545; row_top = 0.875; load 'cic/figures/phase_row.gp'
set bmargin at screen 0.1; set tmargin at screen (times eq '' ? 0.85 : 0.42)
set lmargin at screen 0.085; set rmargin at screen 0.53
load 'cic/figures/growth.gp'
set lmargin at screen 0.62; set rmargin at screen 0.97
load last_panel
unset multiplot
