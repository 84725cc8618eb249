#!/bin/sh
# cic_misprint.sh PROGRAM FOLDER: the same seed with div E = -rho, as the slide prints it, and with div E = rho.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
"$program" cic/cases/misprint.toml --out "$folder/as_printed" --threads 1 --resume --quiet
"$program" cic/cases/misprint.toml gauss.sign=1 output.particles_interval=0 --out "$folder/corrected" --threads 1 --resume --quiet
