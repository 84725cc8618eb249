#!/bin/sh
# mpm_implicit_energy_bound.sh IMPLICIT EXPLICIT FOLDER: the same five disks in a box by the theta scheme, with both mass matrices, and by leapfrog with CFL numbers up to 1.
set -eu
export LC_ALL=C.UTF-8
implicit=$1
explicit=$2
folder=$3
bounce() { "$@" --threads 1 --resume --quiet --out "$out"; }
case=mpm_implicit/cases/energy_bound.toml
for theta in 0.5 0.6 1; do
    for mass in consistent lumped; do
        out=$folder/theta_${theta}_$mass
        bounce "$implicit" $case method.theta=$theta method.mass=$mass output.particles_interval=0
    done
done
# Status 3: the energy, or a particle, has run away.
for alpha in 0.25 0.9 1; do
    out=$folder/explicit_$alpha
    bounce "$explicit" $case time.alpha=$alpha time.energy_limit=0 output.particles_interval=0 || test $? = 3
done
