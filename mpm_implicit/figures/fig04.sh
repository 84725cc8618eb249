#!/bin/sh
# fig04.sh PROGRAM FOLDER: the compressed grains, with linear shape functions as in the talk and with gimp; for their energy also with a CFL number of 1.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
press() { "$program" mpm_implicit/cases/compressed.toml --resume --quiet --out "$@"; }
press "$folder/linear"
press "$folder/gimp" method.shape=gimp
press "$folder/alpha_1" time.alpha=1 output.fringes_interval=0
