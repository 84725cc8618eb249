#!/bin/sh
# flip_sedov.sh PIC FLIP FOLDER: a blast with both programs.
set -eu
export LC_ALL=C.UTF-8
folder=$3
for program in "$1" "$2"; do
    "$program" flip/cases/sedov.toml --resume --quiet --threads 1 --out "$folder/$(basename "$program")"
done
