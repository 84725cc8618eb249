# A warm beam of 5 % on the tail of a plasma (f of all electrons; the bulk, below v_x = 2, is beyond the colors). Where f rises with v, at the phase velocity omega/k, the wave
# grows at the predicted rate; then it traps what moves with it, and the trapped particles, turning around, flatten the bump to a plateau.
wide = 1500; high = 1080
load 'common/style.gp'
heading = 'Bump on the tail: a warm beam of 5 %'
times = '40 60 80 140'
x_label = 'x / λ_D'; v_label = 'v_x / v_{th}'; v_low = 0; v_high = 7; v_step = 2
density = '$3 + $4'; density_top = 0.06; density_step = 0.02
wave_speed = result('theory_omega') / (2 * pi / parameter('length_x'))
field_label = '|E_k| / (m v_{th} ω_p/e)'
growth_floor = 1e-5; growth_top = 10
last_panel = 'cic/figures/velocities.gp'
f_times = '0 60 140'; of_v = '$2 + $3'; f_low = 0; f_high = 0.08
load 'cic/figures/instability.gp'
