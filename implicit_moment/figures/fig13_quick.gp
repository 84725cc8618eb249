load 'implicit_moment/figures/fig13.gp'   # figure 13 from kink_quick.toml
