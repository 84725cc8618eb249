#!/bin/sh
# flip_acoustic.sh PIC FLIP FOLDER: what one step does to a sound wave: the theta scheme with steps from a = c k dt = 0.1 to 100, the explicit step as long as it is stable.
# Folders are called by theta, or by the transfer, and a.
set -eu
export LC_ALL=C.UTF-8
flip=$2
folder=$3

wave() {
    steps=$(awk -v a="$2" 'BEGIN { n = int(20 / a); print n < 4 ? 4 : n }')
    "$flip" flip/cases/acoustic.toml time.dt="$(awk -v a="$2" 'BEGIN { printf "%.17g", a / 6.283185307179586 }')" \
        time.end="$(awk -v a="$2" -v n="$steps" 'BEGIN { printf "%.12g", (n - 1e-3) * a / 6.283185307179586 }')" --resume --quiet --out "$folder/$1-$2" $3
}
for a in 0.1 0.3 1 3 10 30 100; do
    for theta in 0.5 0.55 0.6 1; do wave $theta $a flip.theta=$theta; done
done
for a in 0.005 0.01 0.02 0.04 0.08; do
    for transfer in flip apic pic; do
        wave $transfer $a "flip.pressure=explicit flip.theta=1 flip.tolerance=1e-8 flip.transfer=$transfer"
    done
done
