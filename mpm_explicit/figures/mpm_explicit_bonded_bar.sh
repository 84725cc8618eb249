#!/bin/sh
# mpm_explicit_bonded_bar.sh PROGRAM FOLDER: two bonded halves of a bar, with the bond of the case, which breaks, and with one that holds.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
bar() { "$program" mpm_explicit/cases/bonded_bar.toml time.end=20 --threads 1 --resume --quiet --out "$@"; }
bar "$folder/breaks"
bar "$folder/holds" bond.joint.tension=1 bond.joint.shear=1
