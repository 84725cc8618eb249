# The two-stream instability of cold beams. In phase space they ripple, overtake themselves and roll up into a vortex, the hole that trapped particles circle. Below,
# the field grows by four powers of ten at the predicted rate; then it holds more than a third of the energy of the beams. Triangles mark the times above.
wide = 1500; high = 1080
load 'common/style.gp'
heading = 'Two-stream instability'
times = '32 40 48 72'
x_label = 'x ω_p / v_0'; v_label = 'v_x / v_0'; v_low = -2.6; v_high = 2.6; v_step = 1
colors_of_species = blue.' '.orange
growth_floor = 1e-7; growth_top = 10
load 'cic/figures/instability.gp'
