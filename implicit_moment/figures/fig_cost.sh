#!/bin/sh
# fig_cost.sh IMPLICIT EXPLICIT FOLDER: the cost slide, timed on this machine by one thread. For each mass ratio the implicit run goes to unit flux. Of the
# explicit one some steps are timed (m_i/m_e = 25 and 100), and its time to unit flux is the time of a particle-step times their number: particles in
# proportion to m_i/m_e at equal numbers per cell, steps to (m_i/m_e)^(1/2), to the time of unit flux that the implicit run has measured (at 25: the full
# explicit run, implicit_moment/data/explicit_gem_flux.csv). Beyond 100 the time of a particle-step is that of 100: extrapolated, and said so.
set -eu
export LC_ALL=C.UTF-8
implicit=$1
explicit=$2
folder=$3
cases=implicit_moment/cases
table=$folder/cost.dat

entry() { awk -v key="$1" -f common/json_lines.awk "$2/summary.json"; }
of() { awk "BEGIN { printf \"%.10g\", $1 }"; }

# seconds STEPS CELLS_X CELLS_Z DT C_OVER_V_A M PARTICLES: wall time of a short explicit run
seconds() {
    "$explicit" $cases/gem_explicit.toml time.end="$(of "$1 * $4")" grid.cells_x="$2" grid.cells_z="$3" time.dt="$4" harris.light_over_alfven="$5" \
        harris.mass_ratio="$6" harris.particles="$7" output.fields_interval=0 output.checkpoint_steps=0 --threads 1 --resume --quiet --out "$folder/explicit_$6"
    entry performance.wall_s "$folder/explicit_$6"
}

unit_25=$(awk -F, '/^#/ { next } $2 >= 1 { print t + ($1 - t) * (1 - f) / ($2 - f); exit } { t = $1; f = $2 }' implicit_moment/data/explicit_gem_flux.csv)
{
    echo 'mass_ratio light_over_alfven unit_flux_at implicit_particles implicit_steps implicit_s' \
        '7:explicit_unit_flux_at[1/Omega_ci] 8:explicit_particles 9:explicit_steps 10:particle_steps_per_s 11:explicit_s 12:timed' \
        '13:ratio_of_particle_steps 14:ratio_of_time 15:formula'
} > "$table.partial"
per_step=0
while read -r mass c dt particles; do
    run=$folder/implicit_$mass
    "$implicit" $cases/gem.toml harris.mass_ratio="$mass" harris.light_over_alfven="$c" time.dt="$dt" harris.particles="$particles" \
        time.end="$(of "18 * $c")" output.fields_interval=0 --threads 1 --resume --quiet --out "$run"
    unit=$(entry results.time_at_unit_flux.value "$run")
    implicit_steps=$(of "$unit * $c / $dt")
    implicit_s=$(of "$(entry performance.wall_s "$run") * $unit / 18")

    root=$(of "sqrt($mass / 25)")
    cells_x=$(of "int(512 * $root / 2 + 0.5) * 2")
    cells_z=$(of "int(256 * $root / 2 + 0.5) * 2")
    explicit_dt=$(of "0.03 / $root")
    count=$(of "int(9.12e6 * $mass / 50) * 2")
    timed=0
    if [ "$mass" -le 100 ]; then
        short=$(seconds 10 "$cells_x" "$cells_z" "$explicit_dt" "$c" "$mass" "$count")
        long=$(seconds 50 "$cells_x" "$cells_z" "$explicit_dt" "$c" "$mass" "$count")
        per_step=$(of "($long - $short) / 40 / $count")
        timed=1
    fi
    explicit_unit=$unit
    [ "$mass" = 25 ] && explicit_unit=$unit_25
    explicit_steps=$(of "$explicit_unit * $c / $explicit_dt")
    explicit_s=$(of "$explicit_steps * $count * $per_step")
    echo "$mass $c $unit $particles $implicit_steps $implicit_s $explicit_unit $count $explicit_steps $(of "1 / $per_step") $explicit_s $timed" \
        "$(of "$explicit_steps * $count / ($implicit_steps * $particles)") $(of "$explicit_s / $implicit_s") $(of "$mass ^ 1.5")" >> "$table.partial"
done <<END
25 20 0.3 200000
100 20 0.3 200000
400 30 0.3 200000
1836 50 0.2 400000
END
mv "$table.partial" "$table"
