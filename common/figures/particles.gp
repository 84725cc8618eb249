# Particles of a run at four of the times that it has: in one dimension phase space (x, v_x), in two the plane, in the color of their species, material or grain; and in two the plane once more,
# in the color of their speed.
# fits: any kinds:particles
if (!exists('kind')) kind = 'particles'
if (!exists('heading')) heading = run.': '.kind
load sprintf("< sh common/figures/snapshots.sh '%s' %s", run, kind)
