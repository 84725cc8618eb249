#!/bin/sh
# cic_grid_instability.sh PROGRAM FOLDER: the cold beam of cold_beam_grid_instability.toml with four schemes; each run writes particles when it saturates, and at its end.
# On a lattice, nearest grid points see no displacement smaller than the distance of the particles: there the seed is larger, and there is no linear growth.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
beam() {
    "$program" cic/cases/cold_beam_grid_instability.toml --threads 1 --resume --quiet --out "$folder/$1_$2" method.weighting="$1" method.scheme="$2" output.particles_interval="$3" $4
}
beam ngp momentum 9.5 'species.beam.amplitude=0.1 theory.compare=none'
beam cic momentum 60 ''
beam tsc momentum 144 ''
beam cic energy 56 ''
