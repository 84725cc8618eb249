#!/bin/sh
# mpm_implicit_energy_bound.sh IMPLICIT EXPLICIT FOLDER: the same five disks in a box by the theta scheme, with both mass matrices, and by leapfrog with CFL numbers up to 1, strained as in the talk (method.crossing = 0).
set -eu
export LC_ALL=C.UTF-8
implicit=$1
explicit=$2
folder=$3
case=mpm_implicit/cases/energy_bound.toml
PROGRAM=$implicit SWEEP=$folder SWEEP_NAME='theta_{1}_{2}' sh common/sweep.sh $case method.theta=0.5,0.6,1 method.mass=consistent,lumped -- output.particles_interval=0
# Status 3: the energy, or a particle, has run away.
for alpha in 0.25 0.9 1; do
    "$explicit" $case time.alpha=$alpha method.crossing=0 time.energy_limit=0 output.particles_interval=0 --threads 1 --resume --quiet --out "$folder/explicit_$alpha" || test $? = 3
done
