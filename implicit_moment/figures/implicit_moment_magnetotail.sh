#!/bin/sh
# implicit_moment_magnetotail.sh PROGRAM FOLDER: the magnetotail case with guide fields 0, 0.5 and 1.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
PROGRAM=$program SWEEP=$folder SWEEP_NAME='{1}' sh common/sweep.sh implicit_moment/cases/magnetotail.toml harris.guide_field=0,0.5,1
