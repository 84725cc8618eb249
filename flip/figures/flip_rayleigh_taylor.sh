#!/bin/sh
# flip_rayleigh_taylor.sh PIC FLIP FOLDER: heavy fluid falls through light fluid; pic begins faster, so that it feels anything at all.
set -eu
export LC_ALL=C.UTF-8
folder=$3
"$2" flip/cases/rayleigh_taylor.toml --resume --quiet --threads 1 --out "$folder/flip"
"$1" flip/cases/rayleigh_taylor.toml region.lower.amplitude=0.2 region.upper.amplitude=0.2 time.end=3.5 theory.compare='"none"' --resume --quiet --threads 1 --out "$folder/pic"
