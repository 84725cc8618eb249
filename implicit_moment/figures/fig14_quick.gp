load 'implicit_moment/figures/fig14.gp'   # figure 14 from kink_quick.toml
