load 'implicit_moment/figures/fig11.gp'   # figure 11 from lhdi_quick.toml
