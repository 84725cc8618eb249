# A weak cold beam through a plasma at rest (at v_x = 0, below the frame). The wave travels slower than the beam and grows at the predicted rate, until it traps the
# beam; then the beam turns around omega/k as a whole, giving energy to the wave and taking it back.
wide = 1500; high = 1080
load 'common/style.gp'
heading = 'A beam of one part in a thousand through a cold plasma'
times = '120 140 160 180'
x_label = 'x ω_p / v_0'; v_label = 'v_x / v_0'; v_low = 0.6; v_high = 1.4; v_step = 0.2
colors_of_species = gray.' '.orange
wave_speed = result('theory_omega') / (2 * pi / parameter('length_x'))
growth_floor = 1e-7; growth_top = 1
load 'cic/figures/instability.gp'
