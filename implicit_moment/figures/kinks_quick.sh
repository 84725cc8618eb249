#!/bin/sh
# kinks_quick.sh PROGRAM FOLDER: the same with fewer particles and cells.
exec sh implicit_moment/figures/kinks.sh "$1" "$2" kink_quick
