#!/bin/sh
# fig05.sh PROGRAM FOLDER: the compressed grains with a CFL number of 0.25, with linear shape functions and strain as in the talk (method.crossing = 0) and with gimp, which particles feel less when they cross from cell to cell;
# for their energy also with larger CFL numbers.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
press() { "$program" mpm_explicit/cases/compressed.toml method.crossing=0 --resume --quiet --out "$@"; }
press "$folder/linear"
press "$folder/gimp" method.shape=gimp
# Status 3: the energy, or a particle, has run away.
press "$folder/alpha_0.5" time.alpha=0.5 output.fringes_interval=0
press "$folder/alpha_0.7" time.alpha=0.7 output.fringes_interval=0 || test $? = 3
