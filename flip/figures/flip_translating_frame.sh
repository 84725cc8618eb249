#!/bin/sh
# flip_translating_frame.sh PIC FLIP FOLDER: Sod's shock tube in frames of reference that move with 0 to 4, with every transfer of flip and with pic.
set -eu
export LC_ALL=C.UTF-8
pic=$1
flip=$2
folder=$3

error() { awk -v key="results.L1_$1.value" -f common/json_lines.awk "$folder/scan/summary.json"; }
tube() {
    name=$1
    program=$2
    shift 2
    echo 'frame_velocity L1_density L1_velocity' > "$folder/$name.dat"
    for V in 0 0.25 0.5 1 1.5 2 2.5 3 3.5 4; do
        ends="inflow.velocity_x=$V"
        if [ $V = 0 ]; then ends='boundary.x_low="slip" inflow.velocity_x=0 inflow.material=""'; fi
        "$program" flip/cases/translating_frame.toml $ends left.velocity=$V right.velocity=$V theory.frame_x=$V "$@" --resume --quiet --threads 1 --out "$folder/scan"
        echo "$V $(error density) $(error velocity)" >> "$folder/$name.dat"
        if [ $V = 0 ] || [ $V = 4 ]; then cp "$folder/scan/profile.dat" "$folder/$name.$V.dat"; fi
    done
}
tube harlow "$pic"
tube flip "$flip"
tube pic "$flip" flip.transfer=pic
tube blend "$flip" flip.transfer=blend flip.blend=0.95
tube apic "$flip" flip.transfer=apic
tube xpic2 "$flip" flip.transfer=xpic
tube xpic5 "$flip" flip.transfer=xpic flip.xpic_order=5
