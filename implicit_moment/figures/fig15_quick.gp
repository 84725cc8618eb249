load 'implicit_moment/figures/fig15.gp'   # figure 15 from lhdi_quick.toml
