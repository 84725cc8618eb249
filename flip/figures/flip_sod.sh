#!/bin/sh
# flip_sod.sh PIC FLIP FOLDER: Sod's shock tube with both programs, on 100 cells and then on 50 to 800; pic also with short steps and with many particles.
set -eu
export LC_ALL=C.UTF-8
pic=$1
flip=$2
folder=$3

tube() { "$@" --resume --quiet --threads 1; }
tube "$pic" flip/cases/sod.toml --out "$folder/pic"
tube "$flip" flip/cases/sod.toml --out "$folder/flip"

# Lines of errors: cells, L1(rho), L1(u).
error() { awk -v key="results.L1_$1.value" -f common/json_lines.awk "$folder/scan/summary.json"; }
scan() {
    file=$folder/$1.dat
    program=$2
    shift 2
    echo 'cells L1_density L1_velocity' > "$file"
    for cells in 50 71 100 141 200 283 400 566 800; do
        tube "$program" flip/cases/sod.toml grid.cells_x=$cells "$@" --out "$folder/scan"
        echo "$cells $(error density) $(error velocity)" >> "$file"
    done
}
scan errors_flip "$flip"
scan errors_pic "$pic"
scan errors_pic_short "$pic" time.cfl=0.1
scan errors_pic_many "$pic" particles.per_cell_x=64
