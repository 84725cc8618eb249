#!/bin/sh
# fig03.sh PROGRAM FOLDER: the rebound by the theta scheme with CFL numbers of 1 and 5.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for alpha in 1 5; do "$program" mpm_implicit/cases/rebound.toml time.alpha=$alpha output.particles_interval=0 --resume --quiet --out "$folder/alpha_$alpha"; done
