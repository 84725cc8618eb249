# Fields of a run at four of the times that it has: images of each quantity that varies, one row each; or, of a single row of cells, lines. kind says which files are drawn: fields, phase (f(x, v)),
# velocities (f(v)), profile or fringes (grains in polarized light).
# fits: any kinds:fields,phase,velocities,profile,fringes
if (!exists('kind')) kind = 'fields'
if (!exists('heading')) heading = run.': '.kind
load sprintf("< sh common/figures/snapshots.sh '%s' %s", run, kind)
