#!/bin/sh
# implicit_moment_magnetotail.sh PROGRAM FOLDER: the magnetotail case with guide fields 0, 0.5 and 1.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
for guide in 0 0.5 1; do
    "$program" implicit_moment/cases/magnetotail.toml harris.guide_field=$guide --out "$folder/$guide" --resume --quiet
done
