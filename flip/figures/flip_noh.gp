# Cold gas falls into a line with velocity 1 and stops behind a shock, dashed, at t = 0.6: exactly 16 times as dense. Both methods have the shock early and the density low, and a hot and thin middle:
# artificial viscosity heats the gas while it falls together, before there is a shock. This is the honest failure that W. F. Noh made the problem for; finer meshes make it smaller.
wide = 1500; high = 860
load 'common/style.gp'
head = 'Noh: cold gas falls into a line'
x_top = 0.4; rho_step = 4; colors_top = 18
bottoms = '0 -1.1 0'; tops = '18 0.2 6.5'; steps = '4 0.4 2'
R = 0.2
exact(k) = k == 1 ? column(5) : k == 2 ? (column(1) < R ? 0 : -1) : (column(1) < R ? 16.0 / 3 : 0)
load 'flip/figures/radial.gp'
