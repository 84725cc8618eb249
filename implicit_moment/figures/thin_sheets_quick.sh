#!/bin/sh
# thin_sheets_quick.sh PROGRAM FOLDER: the same with fewer particles and cells.
exec sh implicit_moment/figures/thin_sheets.sh "$1" "$2" lhdi_quick
