#!/bin/sh
# flip_advected_blob.sh PIC FLIP FOLDER: a warm blob that flows with dust, at four Courant numbers.
set -eu
export LC_ALL=C.UTF-8
folder=$3
for C in 0.05 0.2 0.5 0.9; do
    for program in "$1" "$2"; do
        "$program" flip/cases/advected_blob.toml time.dt="$(awk -v C=$C 'BEGIN { printf "%.17g", C / 256 }')" output.fields_interval=0.5 --resume --quiet --threads 1 --out "$folder/$(basename "$program")_$C"
    done
done
