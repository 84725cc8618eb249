// Active-set update: the states of the pairs after a solution, from its velocities and impulses.
//
//     open    -> slip    where the bodies approach
//     closed  -> open    where the impulse pulls: lambda < 0
//     stick   -> slip    where |lambda_t| > mu lambda, or where not all can stick and the pair slides
//     slip    -> stick   where friction drives: lambda_t (v_b - v_a).t > 0
// A pair that closes again only slips: otherwise sets can follow each other in a cycle. A pair may
// change as often as it has to: one that is kept as it is after two or three changes pulls or rubs too
// much, by up to a third of the largest impulse.
#pragma once

#include <cmath>

#include "mpm_implicit/solver/active_set.hpp"

namespace mpm_implicit {

/// What an update has changed.
struct ActiveSetChange {
    bool settled = true;
    std::size_t pair = 0;  // that changed last, or whose friction changed most
    double friction = 0;   // its change, of the largest impulse
};

/// The friction x of slipping pairs that the next solution is to have. Friction makes pressure, and
/// pressure the friction g(x) that ought to be, linear in x while the set stays the same: from the
/// solutions since then the next x is extrapolated.
/// in:     same, the set of the solution just made is that of the next
inline void extrapolate_friction(bool same, ActiveSet& set) {
    if (!same) return void(set.of_friction = {});
    const std::size_t count = set.list.pairs.size();
    Vector x = Vector::Zero(long(count)), g = x;
    for (std::size_t k = 0; k < count; ++k)
        if (set.list.pairs[k].state == ContactState::slip)
            x[long(k)] = set.list.pairs[k].lambda_t, g[long(k)] = set.updates[k].target;
    Vector next = x;
    set.of_friction.next(g - x, next);
    for (std::size_t k = 0; k < count; ++k) {
        if (set.list.pairs[k].state != ContactState::slip) continue;
        const double now = next[long(k)], is = x[long(k)], to = g[long(k)];
        // Below zero there is no friction; where more makes more, it grows until the pair sticks.
        const bool more = std::fabs(to) > std::fabs(is) && to * is >= 0;
        set.updates[k].friction = now * (is != 0 ? is : to) > 0 ? now : more ? 2 * to : 0;
    }
}

/// Changes the states of pairs that do not do what is asked of them.
/// in:     v, all velocities; V, of the grains under force control; accuracy, that v has been
///         solved to
/// in/out: set, with the impulses that belong to v
inline ActiveSetChange update_active_set(const Vector& v, const std::vector<double>& V,
                                         const GrainNodes& nodes, double accuracy, ActiveSet& set) {
    const long size = nodes.size();
    const double nearly = 1e3 * accuracy, friction_error = 1e5 * accuracy;
    // Impulses far below the momentum of a node are round-off. So are velocities far below what an
    // impulse gives to a node: bodies that stick to one at rest have no larger ones.
    double largest = 0, fastest = 0, heaviest = 0;
    for (const ContactPair& pair : set.list.pairs)
        largest = std::max({largest, std::fabs(pair.lambda_n), std::fabs(pair.lambda_t)});
    const auto velocity = [&](const ContactBody& body, double& x, double& y) {
        const bool fixed = body.is_fixed();
        x = fixed ? body.vx : v[body.dof], y = fixed ? body.vy : v[size + body.dof];
        if (body.force_control < 0) return;
        (body.control_along_x ? x : y) = V[body.force_control];
    };
    for (const ContactBody& body : set.list.bodies) {
        double x, y;
        velocity(body, x, y);
        fastest = std::max({fastest, std::fabs(x), std::fabs(y)});
        if (body.is_fixed()) continue;
        const double m = nodes.sums[body.dof].m;
        largest = std::max(largest, 1e-4 * m * std::hypot(x, y));
        heaviest = std::max(heaviest, m);
    }
    if (heaviest > 0) fastest = std::max(fastest, 1e-4 * largest / heaviest);
    ActiveSetChange change;
    for (const ContactList::Node& node : set.list.nodes) {
        for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
            ContactPair& pair = set.list.pairs[k];
            PairUpdate& update = set.updates[k];
            if (pair.bond >= 0) continue;
            double x = 0, y = 0;
            for (const ContactLink& link : pair.all_links()) {
                double ax, ay, bx, by;
                velocity(set.list.bodies[node.body_begin + link.a], ax, ay);
                velocity(set.list.bodies[node.body_begin + link.b], bx, by);
                x += link.weight * (bx - ax), y += link.weight * (by - ay);
            }
            const double parting = x * pair.nx + y * pair.ny, slip = x * pair.tx() + y * pair.ty();
            const ContactState before = pair.state;
            // A pair that has gone back and forth changes its friction before its state.
            const bool patient = pair.state == ContactState::slip && update.changes > 1;
            if (!pair.closed()) {
                if (parting < -nearly * fastest) {
                    pair.state = ContactState::slip;
                    update.friction = 0;
                }
            } else if (pair.lambda_n < -nearly * largest &&
                       !(patient && std::fabs(pair.lambda_t) > nearly * largest)) {
                pair.state = ContactState::open;
            } else if (pair.mu > 0) {
                // Below zero where a pair is to give up its friction before it opens again.
                const double most = pair.mu * pair.lambda_n;
                // A pair slips although it is to stick, where a grain cannot stick to all its partners.
                const bool slips = std::fabs(slip) > nearly * fastest;
                if (pair.state == ContactState::stick &&
                    (slips || std::fabs(pair.lambda_t) > most * (1 + nearly))) {
                    pair.state = ContactState::slip;
                    update.friction = std::copysign(most, slips ? -slip : pair.lambda_t);
                } else if (pair.state == ContactState::slip) {
                    if (pair.lambda_t * slip > nearly * largest * fastest &&
                        !(patient && std::fabs(pair.lambda_t) - most > nearly * largest)) {
                        pair.state = ContactState::stick;
                    } else {
                        const double against = pair.lambda_t == 0 ? -slip : pair.lambda_t;
                        const double now = most * std::copysign(1.0, against);
                        const double by_now = std::fabs(now - pair.lambda_t);
                        if (by_now > change.friction * largest && change.settled) change.pair = k;
                        change.friction = std::max(change.friction, by_now / largest);
                        update.target = now;
                        const double next =
                            patient ? pair.lambda_t + (now - pair.lambda_t) / update.changes : now;
                        update.friction = next * against > 0 ? next : 0;
                    }
                }
            }
            if (pair.state != before) change.settled = false, change.pair = k, ++update.changes;
        }
    }
    extrapolate_friction(change.settled, set);
    if (change.friction > friction_error) change.settled = false;
    return change;
}

/// The impulses of a pair, and the state that follows from them alone, for Newton's method.
inline void update_state(const ContactPair& now, ContactPair& pair) {
    pair.lambda_n = now.lambda_n, pair.lambda_t = now.lambda_t;
    if (pair.bond >= 0) return;
    const bool sticks = std::fabs(pair.lambda_t) < pair.mu * pair.lambda_n * 0.9999;
    pair.state = !(pair.lambda_n > 0) ? ContactState::open
                 : sticks             ? ContactState::stick
                                      : ContactState::slip;
}

/// Adds the known friction of slipping pairs to right-hand sides.
/// in:     size, number of dofs
/// in/out: set, whose slipping pairs get it as lambda_t; right, of the nodes; controlled, of the
///         grains under force control
inline void add_friction(long size, ActiveSet& set, Vector& right,
                         std::vector<double>& controlled) {
    for (const ContactList::Node& node : set.list.nodes) {
        for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
            ContactPair& pair = set.list.pairs[k];
            if (pair.state != ContactState::slip) continue;
            pair.lambda_t = set.updates[k].friction;
            if (pair.lambda_t == 0) continue;
            const auto push = [&](std::size_t who, double part) {
                const ContactBody& body = set.list.bodies[node.body_begin + who];
                const double jx = part * pair.lambda_t * pair.tx(),
                             jy = part * pair.lambda_t * pair.ty();
                if (!body.is_fixed()) right[body.dof] += jx, right[size + body.dof] += jy;
                if (body.force_control >= 0)
                    controlled[body.force_control] += body.control_along_x ? jx : jy;
            };
            for (const ContactLink& link : pair.all_links())
                push(link.a, -link.weight), push(link.b, link.weight);
        }
    }
}

/// The impulse of a pair on a grain under force control, along its direction.
inline double impulse_on(const ForceControl& control, const ContactNode& node,
                         const ContactPair& pair) {
    const double along = control.along_x ? pair.impulse_x() : pair.impulse_y();
    const auto is = [&](std::size_t who) {
        const ContactBody& body = node.bodies[who];
        return body.rigid && static_cast<std::size_t>(body.grain) == control.grain;
    };
    return (is(pair.b) ? along : 0) - (is(pair.a) ? along : 0);
}

/// errors: NumericalError, with the pair that changed last
[[noreturn]] inline void fail_to_settle(const ActiveSetChange& change, const ActiveSet& set,
                                        const std::vector<Grain>& grains, long loops) {
    throw common::NumericalError("contact did not settle in " + std::to_string(loops) +
                                 " loops: " + set.names(change.pair, grains) +
                                 " changed last, friction by " + common::format(change.friction) +
                                 " of the largest impulse; " + set.advice());
}

}  // namespace mpm_implicit
