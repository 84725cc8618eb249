#!/bin/sh
# flip_noh.sh PIC FLIP FOLDER: gas that falls into a line with both programs.
set -eu
folder=$3
for program in "$1" "$2"; do
    "$program" flip/cases/noh.toml --force --quiet --threads 1 --out "$folder/$(basename "$program")"
done
