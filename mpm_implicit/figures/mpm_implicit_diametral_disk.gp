# A disk between two plates (Brazilian test), implicit, with linear shape functions, a CFL number of 4 and theta = 1. Above: fringes of the principal stress difference, in each picture computed on the left and, on the right, of Hertz's disk between two line loads of the
# same size. Below: stress on both diameters; points are particles. The plates press a flat, an eighth of the disk wide, not a line: next to it the two differ.
# fits: mpm_implicit theory.compare=disk file:fringes_*.dat file:particles_*.dat result:load
load 'mpm_explicit/figures/mpm_explicit_diametral_disk.gp'
