# Two Maxwellian beams through each other: the hole between them rolls up and stays, with particles trapped around it. What rolls up is one smooth sheet, wound
# ever finer. Below, growth at the rate of the kinetic dispersion relation; warm beams give away less of their energy than cold ones.
wide = 1500; high = 1080
load 'common/style.gp'
heading = 'Two-stream instability of warm beams, v_0 = 3 v_{th}'
times = '20 30 40 70'
x_label = 'x / λ_D'; v_label = 'v_x / v_{th}'; v_low = -8; v_high = 8; v_step = 4
density = '$3 + $4'; density_top = 0.3; density_step = 0.1
field_label = '|E_k| / (m v_{th} ω_p/e)'
growth_floor = 1e-4; growth_top = 100
load 'cic/figures/instability.gp'
