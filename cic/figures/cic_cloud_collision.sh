#!/bin/sh
# cic_cloud_collision.sh PROGRAM FOLDER: two clouds that swing through each other, with three kinds of weighting, and pairs that pass through each other at once, each
# pair elsewhere on the mesh.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for weighting in ngp cic tsc; do
    clouds() { "$program" cic/cases/cloud_collision.toml method.weighting=$weighting --threads 1 --resume --quiet --out "$@"; }
    clouds "$folder/${weighting}_swinging" time.end=4200  # three periods with tsc
    for place in 0 1 2 3 4 5 6 7; do
        # Eight places within a cell.
        x=$(awk -v n=$place 'BEGIN { print 20 + n / 8 }')
        z=$(awk -v n=$place 'BEGIN { print 32 + (3 * n % 8) / 8 }')
        clouds "$folder/${weighting}_passing_$place" species.a.center_x="$x" species.b.center_x="$(awk -v x="$x" 'BEGIN { print x + 7.3 }')" \
            species.a.center_z="$z" species.b.center_z="$z" species.a.drift_x=0.0567 species.b.drift_x=0.0067 time.dt=0.25 time.end=150
    done
done
