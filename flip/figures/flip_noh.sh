#!/bin/sh
# flip_noh.sh PIC FLIP FOLDER: gas that falls into a line with both programs.
set -eu
export LC_ALL=C.UTF-8
folder=$3
for program in "$1" "$2"; do
    "$program" flip/cases/noh.toml --resume --quiet --threads 1 --out "$folder/$(basename "$program")"
done
