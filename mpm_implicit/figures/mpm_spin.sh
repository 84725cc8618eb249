#!/bin/sh
# mpm_spin.sh IMPLICIT EXPLICIT FOLDER: a free disk spins for five turns, explicit with three transfers, implicit at two time steps. Disks whose results fail are part of the picture (status 0).
set -eu
export LC_ALL=C.UTF-8
implicit=$1
explicit=$2
folder=$3
for shape in linear quadratic; do
    for transfer in flip spin; do
        "$explicit" mpm_explicit/cases/spinning_disk.toml method.shape=$shape method.transfer=$transfer --threads 1 --resume --quiet --out "$folder/${transfer}_$shape" 2>"$folder/results.txt"
    done
done
"$explicit" mpm_explicit/cases/spinning_disk.toml method.transfer=apic --threads 1 --resume --quiet --out "$folder/apic_quadratic"
for alpha in 1 10; do
    "$implicit" mpm_implicit/cases/spinning_disk.toml time.alpha=$alpha --threads 1 --resume --quiet --out "$folder/implicit_$alpha"
done
