#!/bin/sh
# show_cost.sh TABLE: the table of fig_cost.sh for the reader.
set -eu
export LC_ALL=C.UTF-8
awk '$1 + 0 == $1 {
    if (!head++) {
        printf "\ntime to unit flux of the GEM challenge, one thread\n\n%8s %28s %46s %30s\n", "", "implicit", "explicit", "explicit / implicit"
        printf "%8s %9s %8s %9s %12s %10s %10s %12s %12s %9s %9s\n", "m_i/m_e", "particles", "steps", "s", "particles", "steps", "M/s", "s", "part.-steps", "time", "formula"
    }
    printf "%8g %9.3g %8.0f %9.1f %12.3g %10.0f %10.1f %11.4g%s %12.0f %9.0f %9.0f\n", $1, $4, $5, $6, $8, $9, $10 / 1e6, $11, $12 ? " " : "*", $13, $14, $15
}
END { print "\nM/s: million particle-steps per second. The slide, m_i/m_e = 25: 456 in particle-steps for equal lengths, 125 by the formula (m_i/m_e)^(3/2).\nExplicit times: steps timed, multiplied to the time of unit flux; * with the time of a particle-step at m_i/m_e = 100." }' "$1"
