#!/bin/sh
# flip_ringing.sh PIC FLIP FOLDER: uniform flow over a row of cells at Mach 0 to 0.4, with flip and with what may cure its ringing. Folders are called by cure and Mach number.
set -eu
export LC_ALL=C.UTF-8
flip=$2
folder=$3

scan() {
    name=$1
    shift
    PROGRAM=$flip SWEEP=$folder SWEEP_NAME="$name-{1}" sh common/sweep.sh flip/cases/ringing.toml \
        region.gas.velocity_x=0,0.03,0.06,0.08,0.1,0.12,0.14,0.16,0.18,0.2,0.25,0.3,0.4 -- "$@"
}
scan flip
scan viscosity viscosity.linear=0.5
scan blend flip.transfer=blend
# It rings so hard that particles would pile up.
scan apic flip.transfer=apic time.end=250
scan xpic flip.transfer=xpic
scan particles flip.density=particles
