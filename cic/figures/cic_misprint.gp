# Gauss's law as the slide prints it, div E = -rho: like charges attract, and electrons fall together like a cloud of dust under its own weight. The field grows at the rate
# omega_p, where the same seed with div E = rho is a plasma oscillation; its energy is negative and pays for the motion.
wide = 1500; high = 1080
load 'common/style.gp'
other = run.'/corrected'; other_title = 'the same seed with div E = ρ'
run = run.'/as_printed'
heading = 'A misprint: div E = −ρ'
times = '12 14 16 18'
x_label = 'k x'; v_label = 'v_x k / ω_p'; v_low = -3; v_high = 3; v_step = 1
x_low = -pi; x_of = '($2 > pi ? $2 - 2 * pi : $2)'
colors_of_species = blue
field_label = '|E_k| / (m ω_p²/e k)'
growth_floor = 2e-10; growth_top = 100
growth_key = "at graph 0.98, 0.53 top right samplen 1.5 font ',17'"; energy_key = 'inside top left'
energy_unit = parameter('length_x'); energy_label = 'energy / (n_0 m ω_p^2 L/k^2)'; energy_low = -0.7; energy_high = 0.7
load 'cic/figures/instability.gp'
