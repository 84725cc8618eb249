#!/bin/sh
# exercises.sh: what `make exercise E=... ANSWER=...` says of answers that are right, wrong, or no numbers.
set -u
export LC_ALL=C.UTF-8
status=0

judge() {  # ID, answer, status, what is said, and the status and words that there were
    [ "$5" = "$3" ] && [ "$6" = "$4" ] && return
    echo "$1: the answer '$2' ended with $5 and said: $6; not $3: $4" >&2
    status=1
}

answer() {  # ID, answer, status, what is said
    result=0
    said=$(sh common/exercise.sh answer "$1" "$2" 2>&1) || result=$?
    judge "$@" "$result" "$said"
}

make_answer() {  # the same by make, which says itself how it ended
    said=$(env -u MAKEFLAGS -u MAKELEVEL make exercise E="$1" ANSWER="$2" 2>&1)
    judge "$@" "$(echo "$said" | sed -n 's/^make:.* Error //p')" "$(echo "$said" | grep -v '^make:')"
}

for right in 0.9239 .9239 9.239e-1 +0.9239 ' 0.9239 '; do answer 1-3 "$right" 0 "right (within 0.022 %)"; done
answer 3-8 1.4e-6 0 "right (within 35 %)"
answer 2-4 16 0 right
answer 1-3 0.9 1 "not right, but near; give more digits: it is too small"
answer 1-3 0.8 1 "not right; too small"
answer 1-3 -0.9239 1 "not right; too small"
answer 1-3 1 1 "not right; too large"
answer 1-3 0.92 1 "not right, but near; give more digits: it is too small"
answer 1-3 0.93 1 "not right: near, but beyond the tolerance; too large"
answer 1-1 0.9952 1 "not right: near, but beyond the tolerance; too large"
answer 6-10 0.7071 1 "not right: near, but beyond the tolerance; too small"
answer 4b-6 1e-4 1 "not right; the exponent is asked for, as -2 for 1e-2"
answer 4b-6 -6 1 "not right; too small"

answer 1-3 0,9239 2 "'0,9239' is no number: write a point, 0.9239"
for none in 1,2,3 'cos(pi/8)' 1/2 '0.9239 omega_p' '−0.9239' 5e .5. . + 0x1 nan inf '*'; do
    answer 1-3 "$none" 2 "'$none' is no number: a number looks like 0.5, .5 or 5e-1"
done
for none in "it's" '"' ';'; do
    make_answer 1-3 "$none" 2 "'$none' is no number: a number looks like 0.5, .5 or 5e-1"
done
make_answer 1-3 '' 2 "the answer is empty: give a number, like ANSWER=0.5"
make_answer 1-3 0.9239 "" "right (within 0.022 %)"
for empty in '' ' '; do answer 1-3 "$empty" 2 "the answer is empty: give a number, like ANSWER=0.5"; done
answer 1-3 '92 %' 2 "write 0.92 for 92 %"
answer 4b-9 1.3% 2 "the answer is asked for in per cent: write 92 for 92 %"
answer 0-1 1 2 "there is no exercise '0-1'; 'make exercises' lists them"
exit $status
