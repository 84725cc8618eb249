#!/bin/sh
# house.sh: what a script can check of the order of the house. Run it in the root of the project.
set -u
export LC_ALL=C.UTF-8
status=0
complain() { echo "$*" >&2; status=1; }

# A step knows numbers, not where they come from or where they go.
for header in cic/*.hpp flip/*.hpp flip/flip/*.hpp flip/pic/*.hpp implicit_moment/*.hpp \
    implicit_moment/explicit_em/*.hpp mpm_explicit/*.hpp mpm_implicit/*.hpp; do
    grep -qE '^#include "[a-z_/]*(setup|theory|output)/' "$header" &&
        complain "$header is a step and includes setup, theory or output"
    [ "$(wc -l < "$header")" -le 250 ] || complain "$header is longer than 250 lines"
done

# The slide is in the include list of its program.
for program in cic/cic.cpp flip/pic/pic.cpp flip/flip/flip.cpp mpm_explicit/mpm_explicit.cpp \
    mpm_implicit/mpm_implicit.cpp implicit_moment/implicit_moment.cpp \
    implicit_moment/explicit_em/explicit_em.cpp; do
    grep -qx "#include \"${program%/*}/step.hpp\"" "$program" ||
        complain "$program does not include ${program%/*}/step.hpp"
    [ "$(wc -l < "$program")" -le 100 ] || complain "$program is longer than 100 lines"
done

lines=$(cat common/*.hpp common/*/*.hpp common/*/*.cpp | wc -l)
[ "$lines" -le 4500 ] || complain "common/ has $lines lines, more than 4500"
exit $status
