#!/bin/sh
# flip_rotating_column.sh PIC FLIP FOLDER: inertial waves of columns of five heights and what one transfer leaves of them, and a column whose angular momentum falls outward.
set -eu
export LC_ALL=C.UTF-8
flip=$2
folder=$3
column=flip/cases/rotating_column.toml

for high in 0.5 0.75 1 1.5 2; do
    cells=$(awk -v H=$high 'BEGIN { print 24 * H }')
    k=$(awk -v H=$high 'BEGIN { printf "%.17g", atan2(0, -1) / H }')
    middle=$(awk -v H=$high 'BEGIN { print H / 2 }')
    end=$(awk -v H=$high 'BEGIN { print H < 1.2 ? 15 : 15 * H }')
    "$flip" $column grid.length_z=$high grid.cells_z=$cells constant.k.value="$k" region.gas.center_z=$middle time.end=$end \
        --resume --quiet --out "$folder/high-$high"
done
"$flip" $column flip.transfer=pic --resume --quiet --out "$folder/pic"
"$flip" $column region.gas.angular_velocity=0 region.gas.velocity_theta='2*x*exp(-4*x^2)' constant.A.value=1e-4 time.end=24 \
    --resume --quiet --out "$folder/falling"
