load 'implicit_moment/figures/fig12.gp'   # figure 12 from lhdi_quick.toml
