# The profile that a run leaves at its end, profile.dat: one panel for each quantity, points, with the exact solution as a line where there is one.
# fits: any file:profile.dat theory.compare!=cavity
heading = run.': profile'
load sprintf("< awk -f common/columns.awk '%s/profile.dat' | awk -f common/figures/tables.awk -f common/figures/profile.awk - '%s/profile.dat'", run, run)
