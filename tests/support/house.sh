#!/bin/sh
# house.sh: what a script can check of the order of the house. Run it in the root of the project.
set -u
export LC_ALL=C.UTF-8
status=0
complain() { echo "$*" >&2; status=1; }

# A step knows numbers, not where they come from or where they go.
for header in $(find cic flip implicit_moment mpm_explicit mpm_implicit -name '*.hpp' |
    grep -vE '/(setup|theory|output)/'); do
    grep -qE '^#include "[a-z_/]*(setup|theory|output)/' "$header" &&
        complain "$header is a step and includes setup, theory or output"
    [ "$(wc -l < "$header")" -le 250 ] || complain "$header is longer than 250 lines"
done

# Names that hid what the field calls otherwise.
banished='put_on_nodes|velocity_of_nodes|fold_sums|spread_velocity|lay_out_nodes|NodeRow|StripCurrent|tie_light_nodes|untie|Homes|gather_at_home|sort_by_home|follow_path|PathSums|part_to_border|count_moments|start_back|NoTurn|undo_rotation|PushField|push_field|meet_walls|cross_ends|Meetings|MeetingPair|Meeter|weigh_pairs|settle_contact|turn_stress|put_back|drive_rigid|Servo|old_stress|Session|guarded|keep_going|Lanes|worth_sharing|three_apart|refuse_idle|refuse_impossible|add_followed|StripSums|Chunk|Books|Ledger'
found=$(grep -rnwE "$banished" --include='*.hpp' --include='*.cpp' cic flip mpm_explicit mpm_implicit \
    implicit_moment common tests) && complain "names that were banished: $found"

# The slide is in the include list of its program.
for program in cic/cic.cpp flip/pic/pic.cpp flip/flip/flip.cpp mpm_explicit/mpm_explicit.cpp \
    mpm_implicit/mpm_implicit.cpp implicit_moment/implicit_moment.cpp \
    implicit_moment/explicit_em/explicit_em.cpp; do
    grep -qx "#include \"${program%/*}/step.hpp\"" "$program" ||
        complain "$program does not include ${program%/*}/step.hpp"
    [ "$(wc -l < "$program")" -le 100 ] || complain "$program is longer than 100 lines"
    # Beside main stands what the step calls; what that needs in turn has rooms of its own.
    [ "$(ls "${program%/*}"/*.hpp | wc -l)" -le 18 ] || complain "${program%/*}/ has more than 18 headers beside main"
done

lines=$(cat common/*.hpp common/*.cpp common/*/*.hpp common/*/*.cpp | wc -l)
[ "$lines" -le 6061 ] || complain "common/ has $lines lines, more than 6061"
exit $status
