# History of a run: energies, what should be 0, amplitudes of modes, and all else that the run records, against time. Dashed, where there is theory: its rate of growth, which
# touches the run in the times of the measurement.
# fits: any
if (!exists('heading')) heading = run
load sprintf("< sh common/figures/history.sh '%s'", run)
