// What contact is between grains, and when two bodies are near enough to press.
#pragma once

#include <vector>

#include "mpm_explicit/contact/surface_runs.hpp"

namespace mpm {

struct ContactRule {
    double friction = 0, wall_friction = 0;  // Coulomb's coefficients
    std::vector<double> between;  // friction of two materials, n by n; empty: one for all
    // Grains press when their surfaces are nearer than this, in cells; 0: wherever they approach,
    // which is too early. Where a node sees no outline, the centers of their parts around it count.
    double separation = 0.02, center_separation = 0.8;
    long levels = 2;     // leapfrog: contact acts on v_i^0 and v_i^1; 1: on v_i^1 alone
    bool points = true;  // whether disks that roll touch a plate between two columns of nodes
    // Surfaces press that will touch so soon [time], and come nearer by so many cells at most.
    double ahead = 0, most_ahead = 0.1;
};

/// The gap between the surfaces of two bodies at a node, as much nearer as they will soon come.
inline double gap_of(const ContactRule& rule, const ContactBody& one, const ContactBody& two,
                     const ContactPair& pair, double h) {
    return gap_between(one, two, pair.nx, pair.ny, rule.ahead, rule.most_ahead * h);
}

/// Whether the surfaces of two bodies touch at a node; h, the width of a cell.
inline bool touch(const ContactRule& rule, const ContactBody& one, const ContactBody& two,
                  const ContactPair& pair, double h) {
    if (rule.separation == 0) return true;
    if (has_outline(one, h) && has_outline(two, h))
        return gap_of(rule, one, two, pair, h) <= rule.separation * h;
    const double apart = (two.x - one.x) * pair.nx + (two.y - one.y) * pair.ny;
    return apart <= rule.center_separation * h * (two.wall ? 0.5 : 1);
}

}  // namespace mpm
