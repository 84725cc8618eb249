#!/bin/sh
# kinks_quick.sh PROGRAM FOLDER: the same with half the particles, to t Omega_ci = 50.
exec sh implicit_moment/figures/kinks.sh "$1" "$2" kink_quick
