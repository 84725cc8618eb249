#!/bin/sh
# implicit_moment_energy.sh PROGRAM EXPLICIT FOLDER: the finite-grid case, from a quiet start and for ten times as long, by the explicit code, with the
# moments of the slide, and with the mass matrix for two theta.
set -eu
export LC_ALL=C.UTF-8
program=$1
explicit=$2
folder=$3
case=implicit_moment/cases/finite_grid.toml
same='plasma.loading=quiet time.end=1000 --resume --quiet'
mkdir -p "$folder"
sed '/^\[field\]/,$d' "$case" > "$folder/explicit.toml"
"$explicit" "$folder/explicit.toml" $same --out "$folder/explicit"
"$program" "$case" field.response=moments $same --out "$folder/moments"
"$program" "$case" $same --out "$folder/half"
"$program" "$case" field.theta=1 $same --out "$folder/one"
