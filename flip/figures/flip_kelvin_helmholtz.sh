#!/bin/sh
# flip_kelvin_helmholtz.sh PIC FLIP FOLDER: a layer of shear winds up in flip; pic, with a wave twenty times as large at the start, has it drowned in noise.
set -eu
export LC_ALL=C.UTF-8
folder=$3
"$2" flip/cases/kelvin_helmholtz.toml --resume --quiet --threads 1 --out "$folder/flip"
"$1" flip/cases/kelvin_helmholtz.toml region.lower.amplitude=0.1 region.upper.amplitude=0.1 time.end=1 theory.compare='"none"' --resume --quiet --threads 1 --out "$folder/pic"
