# A blast that starts in a corner of two slip walls, at t = 0.8, against Sedov's solution (dashes: its shock). Nearly all mass is in a shell that 96 x 96 cells hardly resolve, so that its peak, 6, is
# hardly reached, and the shock is where theory has it. In the middle there are fewer particles than cells: velocity and pressure are noise, which weighs nothing.
wide = 1500; high = 860
load 'common/style.gp'
head = 'Sedov: a blast in cold gas'
x_top = 1; rho_step = 1; colors_top = 6
bottoms = '0 -1.4 0'; tops = '6.3 1.4 0.4'; steps = '1 0.4 0.1'
exact(k) = column(4 + k)
R = real(system(sprintf("LC_ALL=C awk -v key=results.shock_radius.expected -f common/json_lines.awk '%s'/flip/summary.json", run)))
load 'flip/figures/radial.gp'
