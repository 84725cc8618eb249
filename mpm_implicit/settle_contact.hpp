// Whether the velocities of a guess of who presses are what contact asks for, and a better guess.
#pragma once

#include "mpm_implicit/contact_set.hpp"
#include "mpm_implicit/grain_matrix.hpp"

namespace mpm_implicit {

/// What has changed between two guesses.
struct Change {
    bool settled = true;
    std::size_t pair = 0;  // that changed last, or whose friction changed most
    double friction = 0;   // its change, of the largest impulse
    long held = 0;         // pairs that ought to change, and may not any more
};

/// Friction x makes pressure, and pressure the friction g(x) that ought to be. Where two solutions
/// in turn have the same set, the next x is taken where a secant through both says g(x) = x.
///   x_2 = g_1 - s (g_1 - g_0),  s = f_1 . (f_1 - f_0)/|f_1 - f_0|^2,  f = g - x
/// in:     same, the set of the solution just made is that of the next
/// source: Anderson, J. ACM 12, 547 (1965), with one step back.
inline void extrapolate_friction(bool same, ContactSet& set) {
    double along = 0, squared = 0;
    for (MeetingPair& pair : set.pairs) {
        if (pair.hold != Hold::slip) continue;
        const double f_1 = pair.target - pair.lambda_t, f_0 = pair.target_before - pair.x_before;
        along += f_1 * (f_1 - f_0), squared += (f_1 - f_0) * (f_1 - f_0);
    }
    const double s = same && set.same_before && squared > 0 ? along / squared : 0;
    for (MeetingPair& pair : set.pairs) {
        if (pair.hold != Hold::slip) continue;
        const double next = pair.target - s * (pair.target - pair.target_before);
        if (same && next * pair.target > 0) pair.friction = next;
        pair.x_before = pair.lambda_t, pair.target_before = pair.target;
    }
    set.same_before = same;
}

/// Changes the set where a pair does not do what is asked of it.
/// in:     v, all velocities; V, of the plates that forces drive; accuracy, that v has been solved to
/// in/out: set, with the impulses that belong to v
inline Change correct(const Vector& v, const std::vector<double>& V, const GrainNodes& nodes,
                      double accuracy, ContactSet& set) {
    const long size = nodes.size();
    const double nearly = 1e3 * accuracy, friction_error = 1e5 * accuracy;
    constexpr int most_releases = 2, most_switches = 3;
    double largest = 0, fastest = 0;
    for (const MeetingPair& pair : set.pairs)
        largest = std::max({largest, std::fabs(pair.lambda_n), std::fabs(pair.lambda_t)});
    const auto velocity = [&](const Meeter& is, double& x, double& y) {
        x = is.fixed ? is.vx : v[is.dof], y = is.fixed ? is.vy : v[size + is.dof];
        if (is.force_control < 0) return;
        (is.control_along_x ? x : y) = V[static_cast<std::size_t>(is.force_control)];
    };
    for (const Meeter& is : set.meeters) {
        double x, y;
        velocity(is, x, y);
        fastest = std::max({fastest, std::fabs(x), std::fabs(y)});
        // Impulses far below the momentum of a node are round-off.
        if (!is.fixed)
            largest = std::max(
                largest, 1e-4 * nodes.sums[static_cast<std::size_t>(is.dof)].m * std::hypot(x, y));
    }
    Change change;
    for (const MeetingNode& node : set.nodes) {
        for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
            MeetingPair& pair = set.pairs[k];
            if (pair.bond >= 0) continue;
            double ax, ay, bx, by;
            velocity(set.meeters[node.meeter_begin + pair.a], ax, ay);
            velocity(set.meeters[node.meeter_begin + pair.b], bx, by);
            const double parting = (bx - ax) * pair.nx + (by - ay) * pair.ny,
                         slip = (bx - ax) * pair.tx() + (by - ay) * pair.ty();
            const Hold before = pair.hold;
            if (!pair.closed()) {
                if (parting < -nearly * fastest) {
                    pair.hold = Hold::slip;
                    pair.friction = 0;
                }
            } else if (pair.lambda_n < -nearly * largest) {
                if (pair.releases < most_releases)
                    pair.hold = Hold::open, ++pair.releases;
                else
                    ++change.held;
            } else if (pair.mu > 0) {
                const double most = pair.mu * std::max(0.0, pair.lambda_n);
                // Where a grain cannot stick to all who hold it, a pair slips all the same.
                const bool slips = std::fabs(slip) > nearly * fastest;
                if (pair.hold == Hold::stick &&
                    (slips || std::fabs(pair.lambda_t) > most * (1 + nearly))) {
                    if (pair.switches < most_switches) {
                        pair.hold = Hold::slip, ++pair.switches;
                        pair.friction = std::copysign(most, slips ? -slip : pair.lambda_t);
                    } else {
                        ++change.held;
                    }
                } else if (pair.hold == Hold::slip) {
                    const bool drives = pair.lambda_t * slip > nearly * largest * fastest;
                    if (drives && pair.switches < most_switches) {
                        pair.hold = Hold::stick, ++pair.switches;
                    } else {
                        change.held += drives ? 1 : 0;
                        const double now =
                            std::copysign(most, pair.lambda_t == 0 ? -slip : pair.lambda_t);
                        const double by_now = std::fabs(now - pair.lambda_t);
                        if (by_now > change.friction * largest && change.settled) change.pair = k;
                        change.friction = std::max(change.friction, by_now / largest);
                        pair.friction = pair.target = now;
                    }
                }
            }
            if (pair.hold != before) change.settled = false, change.pair = k;
        }
    }
    extrapolate_friction(change.settled, set);
    if (change.friction > friction_error) change.settled = false;
    return change;
}

/// errors: NumericalError, with who changed last
[[noreturn]] inline void fail_to_settle(const Change& change, const ContactSet& set,
                                        const std::vector<Grain>& grains, long loops) {
    throw common::NumericalError("contact did not settle in " + std::to_string(loops) +
                                 " loops: " + set.names(change.pair, grains) +
                                 " changed last, friction by " + common::format(change.friction) +
                                 " of the largest impulse; reduce time.alpha, or raise "
                                 "solver.max_outer_iterations");
}

}  // namespace mpm_implicit
