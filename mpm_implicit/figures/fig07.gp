# Figure 7 of the talk: particle positions, colored by velocity, and fringes of the principal stress difference in equal disks between two rows of rigid ones (gray), the upper of
# which moves to the right with U. Chains of force lean against the motion and tighten as the rows climb on each other. s1 - s2 grows by 0.025 E from one dark fringe to the next.
load 'mpm_explicit/figures/mpm_explicit_shear.gp'
