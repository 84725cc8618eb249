#!/bin/sh
# flip_rotating_disk.sh PIC FLIP FOLDER: a disk of dust that turns once in a harmonic trap, with every transfer of flip and with pic, in 241 to 2413 steps.
set -eu
export LC_ALL=C.UTF-8
pic=$1
flip=$2
folder=$3

kept() { awk -v key=results.angular_momentum_kept.value -f common/json_lines.awk "$folder/$name.$steps/summary.json"; }
disk() {
    name=$1
    program=$2
    shift 2
    echo 'steps angular_momentum_kept' > "$folder/$name.dat"
    for steps in 241 483 1081 2413; do
        # A hair more than the even share, lest round-off adds a step.
        dt=$(awk -v n=$steps 'BEGIN { printf "%.12g", 8 * atan2(1, 1) / n * (1 + 1e-9) }')
        "$program" flip/cases/rotating_disk.toml time.dt="$dt" "$@" --resume --quiet --threads 1 --out "$folder/$name.$steps"
        echo "$steps $(kept)" >> "$folder/$name.dat"
    done
}
disk harlow "$pic"
disk flip "$flip"
disk pic "$flip" flip.transfer=pic
disk blend "$flip" flip.transfer=blend flip.blend=0.95
disk apic "$flip" flip.transfer=apic
disk xpic2 "$flip" flip.transfer=xpic
disk xpic5 "$flip" flip.transfer=xpic flip.xpic_order=5
