#!/bin/sh
# cic_landau.sh PROGRAM FOLDER: Langmuir waves of k lambda_D = 0.3, 0.4 and 0.5, so small that they trap nothing while they are damped, and one so large that it does.
set -eu
export LC_ALL=C.UTF-8
program=$1
folder=$2

# A power of two is the quietest number of particles.
wave() {
    "$program" cic/cases/landau.toml species.electrons.particles_per_cell=16384 time.dt=0.1 time.end=60 --resume --quiet --out "$@"
}
wave "$folder/0.3" grid.length_x=20.943951023931955 species.electrons.amplitude=1e-3 output.phase_interval=0
wave "$folder/0.4" grid.length_x=15.707963267948966 species.electrons.amplitude=3e-3 output.phase_interval=0
wave "$folder/0.5" output.phase_interval=0
wave "$folder/trapping" species.electrons.amplitude=0.4 output.phase_v_max=5 output.phase_bins_v=256
