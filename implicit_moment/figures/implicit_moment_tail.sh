#!/bin/sh
# implicit_moment_tail.sh PROGRAM FOLDER: the tail at rest, the same with images of charge at its ends, and the thin one that reconnects.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2
PROGRAM=$program SWEEP=$folder/rest SWEEP_NAME='{1}' sh common/sweep.sh implicit_moment/cases/lembege_pellat.toml grid.boundary_x=reflecting,wall output.fields_interval=100
PROGRAM=$program SWEEP=$folder/thin SWEEP_NAME='{1}' sh common/sweep.sh implicit_moment/cases/thin_tail.toml plasma.seed=1 output.fields_interval=20
