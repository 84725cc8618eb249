#!/bin/sh
# read_openpmd.sh BUILD: another reader, h5dump, finds in the HDF5 files of a run the numbers of its text files. Status 77, for "not tested", where
# the programs were built without HDF5 or there is no h5dump.
set -eu
export LC_ALL=C.UTF-8
command -v h5dump > /dev/null || { echo "there is no h5dump (make deps-dev): not tested"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM
run=$scratch/run
"$1/cic" cic/cases/two_stream_2d.toml time.end=2 output.fields_interval=1 output.particles_interval=1 output.openpmd=true theory.compare=none \
    grid.cells_x=16 grid.cells_z=8 --quiet --threads 1 --out "$run" 2> "$scratch/said" || {
    cat "$scratch/said"
    grep -q 'built without HDF5' "$scratch/said" && exit 77
    exit 1
}

# same KIND COLUMN RECORD: the column of the last text file of a kind, and the record of the HDF5 file beside it.
same() {
    text=$(printf '%s\n' "$run/$1"_*.dat | tail -n 1)
    step=$(awk '/^# time/ { print $5; exit }' "$text")
    awk -v name="$2" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) c = k } NF && $1 + 0 == $1 { print $c }' "$text" > "$scratch/text"
    h5dump -d "/data/$step/$3" -y -w 1 -m '%.17g' "${text%.dat}.h5" | sed '/^ *}/q' | tr -d ', ' | grep -E '^-?[0-9.]+(e[-+]?[0-9]+)?$' > "$scratch/hdf5"
    paste "$scratch/text" "$scratch/hdf5" | awk -v what="$1 $2" '
        { if ($1 + 0 != $2 + 0 || NF != 2) wrong++; if ($1 != 0) numbers++ }
        END { if (wrong || !numbers) { print what ": " wrong + 0 " of " NR " numbers differ, " numbers + 0 " are not zero"; exit 1 } }'
}
same fields rho meshes/rho
same fields E_x meshes/E/x
same fields E_z meshes/E/z
same particles x particles/all/position/x
same particles z particles/all/position/z
same particles v_x particles/all/v/x
h5dump -a "/data/0/meshes/E/axisLabels" -y "$run/fields_000000.h5" | tr -d '\n ' | grep -q 'DATA{"z","x"}' || { echo "the axes are not z, x"; exit 1; }
