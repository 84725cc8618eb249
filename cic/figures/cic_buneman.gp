# Electrons (blue) drift through ions at rest (orange), m_i/m_e = 100. The wave grows at the predicted rate until its potential stops electrons, t = 100; the current breaks
# up into a hot plasma, and ions begin to move in beams of their own.
wide = 1500; high = 1080
load 'common/style.gp'
heading = 'Buneman instability: electrons (blue) drift through ions (orange), m_i = 100 m_e'
times = '90 100 110 140'
x_label = 'x ω_p / v_0'; v_label = 'v_x / v_0'; v_low = -2; v_high = 2; v_step = 1
colors_of_species = blue.' '.orange
growth_floor = 1e-7; growth_top = 10
load 'cic/figures/instability.gp'
