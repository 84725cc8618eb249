#!/bin/sh
# mpm_explicit_rest.sh PROGRAM FOLDER: a block at rest on a plate for a minute, with contact on both velocities of the leapfrog; and with contact on the new one alone, until it bursts (status 3).
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
"$program" mpm_explicit/cases/block_at_rest.toml --threads 1 --resume --quiet --out "$folder/both"
"$program" mpm_explicit/cases/block_at_rest.toml contact.levels=1 --threads 1 --resume --quiet --out "$folder/new" 2>"$folder/burst.txt" || [ $? = 3 ]
