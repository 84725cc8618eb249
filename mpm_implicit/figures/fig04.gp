# Figure 4 of the talk: fringes of the principal stress difference in grains that a plate compresses, implicit, with a CFL number of 4. Above in one color, below in white light; s1 - s2 grows by 0.02 E
# from one order to the next (the scale), as in figure 5, its explicit side. With linear shape functions, the talk's, particles that cross from cell to cell crumple the fringes; with gimp they are smooth.
load 'mpm_explicit/figures/fig05.gp'
