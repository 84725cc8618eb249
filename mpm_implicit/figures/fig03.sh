#!/bin/sh
# fig03.sh PROGRAM FOLDER: the rebound by the theta scheme with CFL numbers of 1 and 5.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
PROGRAM=$program SWEEP=$folder SWEEP_NAME='alpha_{1}' sh common/sweep.sh mpm_implicit/cases/rebound.toml time.alpha=1,5 -- output.particles_interval=0
