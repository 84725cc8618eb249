// The same step by Newton and Krylov, as the talk's abstract has it for fields: nothing is linearized
// by hand, so plastic grains and growing volumes are as good as elastic ones; and contact is the
// operator of the explicit program, put on v^theta.
//
// With R the momentum that is missing, and C the operator that ends approach and slip at the nodes,
//     F(v) = v - C(v + R(v)/D),
//     R(v) = M (v^0 - v) + theta dt [f(sigma^theta(v)) + m g - c M v]
// is zero exactly where R is made up by impulses that press and rub as they should, whatever the
// masses D are that C works with: here the diagonal of A, with which v + R/D never goes far. Newton's
// linear systems are solved by GMRES with differences of F, preconditioned by conjugate gradients for
// the elastic grains with the pairs that are closed now.
#pragma once

#include "common/newton_krylov.hpp"
#include "mpm_implicit/solve_nodes.hpp"
#include "mpm_implicit/update_stress.hpp"

namespace mpm_implicit {

template <int reach>
class NewtonSolver {
   public:
    /// in:     solver, with the matrix and v_0 of this step
    /// in/out: as NodeSolver::solve
    /// errors: NumericalError when Newton or Krylov does not get there, with the pair
    template <class Shape>
    ContactSums solve(const Shape& shape, const std::vector<AnyLaw>& laws,
                      const ThetaScheme& scheme, const Contact& contact, const BodyForce& body,
                      double dt, State& state, NodeSolver<reach>& solver, GrainNodes& nodes,
                      SolveReport& report) {
        const std::vector<Grain>& grains = state.assembly.grains;
        const Particles& particles = state.assembly.particles;
        std::vector<RigidMotion>& rigid = state.assembly.rigid;
        std::vector<Bond>& bonds = state.assembly.bonds;
        const long n = nodes.size();
        const double theta = scheme.theta;
        const auto count = static_cast<long>(solver.servos.size());
        resize(n, count);
        solver.prepare(scheme, body, dt, nodes);
        const Vector& b = solver.right_hand_side();
        // x = D^{1/2} v, where velocities can change.
        const Vector& scale = solver.scale();
        for_each_slot(n, [&](long i, std::size_t) {
            for (const long at : {i, n + i}) {
                root_[at] = scale[at] > 0 ? 1 / scale[at] : 0;
                x_[at] = root_[at] * solver.old_velocities()[at];
            }
        });
        for (long s = 0; s < count; ++s)
            x_[2 * n + s] = std::sqrt(solver.servos[static_cast<std::size_t>(s)].mass) *
                            solver.servos[static_cast<std::size_t>(s)].velocity;

        const double factor_M = 1 + theta * dt * body.damping;
        // Puts v on the nodes, and finds R(v).
        const auto load = [&](const Vector& x) {
            for (long s = 0; s < count; ++s) {
                const Servo& servo = solver.servos[static_cast<std::size_t>(s)];
                RigidMotion& is = rigid[servo.grain];
                (servo.along_x ? is.vx : is.vy) = x[2 * n + s] / std::sqrt(servo.mass);
            }
            drive_rigid(grains, rigid, nodes);
            for_each_slot(n, [&](long i, std::size_t k) {
                v_[i] = scale[i] * x[i], v_[n + i] = scale[n + i] * x[n + i];
                if (nodes.is_free()[k] != 0)
                    nodes.motion[k].vx_1 = v_[i], nodes.motion[k].vy_1 = v_[n + i];
            });
            spread_velocity(nodes);
            force_at_theta(shape, laws, scheme, dt, grains, particles, nodes);
            solver.matrix.multiply_mass(v_, Mv_);
            for_each_slot(n, [&](long i, std::size_t k) {
                R_[i] = b[i] + theta * dt * nodes.force[k].x - factor_M * Mv_[i];
                R_[n + i] = b[n + i] + theta * dt * nodes.force[k].y - factor_M * Mv_[n + i];
            });
        };
        // Puts v + R/D on the nodes, for contact to correct.
        const auto push = [&] {
            for_each_slot(n, [&](long i, std::size_t k) {
                if (nodes.is_free()[k] == 0) return;
                const auto pushed = [&](long at) {
                    return scale[at] > 0 ? v_[at] + R_[at] * scale[at] * scale[at] : 0.0;
                };
                nodes.motion[k].vx_1 = pushed(i), nodes.motion[k].vy_1 = pushed(n + i);
            });
        };
        // The operator of the explicit program, with the masses D.
        const auto correct_node = [&](int, mpm::detail::NodeProblem& node) {
            node.isotropic = false;
            for (std::size_t k = 0; k < node.parties; ++k) {
                mpm::detail::Party& party = node.party[k];
                if (party.is_fixed()) continue;
                party.per_mx = scale[party.slot] * scale[party.slot];
                party.per_my = scale[n + party.slot] * scale[n + party.slot];
            }
            mpm::detail::weigh_pairs(node);
            mpm::detail::solve(node);
        };
        const auto residual = [&](const Vector& x, Vector& F) {
            load(x);
            push();
            std::array<std::vector<double>, common::block_count> reaction;
            for (auto& block : reaction) block.assign(static_cast<std::size_t>(count), 0.0);
            std::array<std::size_t, common::block_count> next = solver.set.first_pair;
            contact.meetings().for_each(nodes, bonds, false, [&](int number, auto& node) {
                const auto block = static_cast<std::size_t>(number);
                correct_node(number, node);
                for (std::size_t k = 0; k < node.pairs; ++k) {
                    const mpm::detail::Pair& pair = node.pair[k];
                    if (watching_) see(pair, solver.set.pairs[next[block]++]);
                    for (long s = 0; s < count; ++s) {
                        const Servo& servo = solver.servos[static_cast<std::size_t>(s)];
                        for (const auto& [who, sign] :
                             {std::pair(pair.a, -1.0), std::pair(pair.b, 1.0)}) {
                            const mpm::detail::Party& party = node.party[who];
                            if (!party.rigid ||
                                static_cast<std::size_t>(party.grain) != servo.grain)
                                continue;
                            reaction[block][static_cast<std::size_t>(s)] +=
                                sign * (servo.along_x
                                            ? pair.lambda_n * pair.nx - pair.lambda_t * pair.ny
                                            : pair.lambda_n * pair.ny + pair.lambda_t * pair.nx);
                        }
                    }
                }
                for (std::size_t k = 0; k < node.parties; ++k) {
                    if (node.party[k].is_fixed()) continue;
                    NodeMotion& v = nodes.motion[static_cast<std::size_t>(node.party[k].slot)];
                    v.vx_1 = node.party[k].vx, v.vy_1 = node.party[k].vy;
                }
            });
            for_each_slot(n, [&](long i, std::size_t k) {
                F[i] = x[i] - root_[i] * nodes.motion[k].vx_1;
                F[n + i] = x[n + i] - root_[n + i] * nodes.motion[k].vy_1;
            });
            for (long s = 0; s < count; ++s) {
                const Servo& servo = solver.servos[static_cast<std::size_t>(s)];
                double impulse = dt * servo.force;
                for (const auto& block : reaction)
                    impulse += block[static_cast<std::size_t>(s)] / theta;
                const double V =
                    (servo.velocity + impulse / servo.mass) / (1 + dt * servo.damping / servo.mass);
                F[2 * n + s] = x[2 * n + s] - std::sqrt(servo.mass) * V;
            }
        };

        // (1 - P) r + (P A P)^-1 [P r - P A (1 - P) r], P the projection to what closed pairs allow.
        const auto multiply = [&](Vector& x, Vector& y) { solver.matrix.multiply(x, y); };
        const auto precondition = [&](const Vector& r, Vector& z) {
            part_ = r.head(2 * n);
            by_A_.project(part_);
            for_each_slot(n, [&](long i, std::size_t) {
                for (const long at : {i, n + i}) {
                    rest_[at] = scale[at] > 0 ? r[at] - part_[at] : 0;
                    v_[at] = scale[at] * rest_[at];
                }
            });
            solver.matrix.multiply(v_, Mv_);
            for_each_slot(n, [&](long i, std::size_t) {
                for (const long at : {i, n + i}) part_[at] = root_[at] * part_[at] - Mv_[at];
            });
            v_.setZero();
            PlateSystem none;
            const CgResult cg = projected_cg(multiply, solver.preconditioner(by_A_), by_A_, scale,
                                             part_, 1e-4, scheme.most_iterations, v_, none, cg_);
            report.iterations += cg.iterations;
            for_each_slot(n, [&](long i, std::size_t) {
                for (const long at : {i, n + i}) z[at] = rest_[at] + root_[at] * v_[at];
            });
            for (long s = 0; s < count; ++s) z[2 * n + s] = r[2 * n + s];
        };

        solver.use_preconditioner(scheme, grains, nodes);
        common::NewtonOptions options;
        options.first_forcing = 1e-4, options.smallest_forcing = 1e-6, options.convex = true;
        double unit = 0;
        common::NewtonResult result;
        for (report.loops = 0; report.loops <= scheme.most_loops; ++report.loops) {
            watching_ = true;
            residual(x_, F_);
            watching_ = false;
            if (report.loops == 0)
                unit = std::max({common::safe_norm(F_), common::safe_norm(x_),
                                 std::numeric_limits<double>::min()});
            // What round-off of R leaves in F.
            const double tolerance =
                std::max(scheme.tolerance,
                         8 * std::numeric_limits<double>::epsilon() * common::safe_norm(x_) / unit);
            result = {0, 0, common::safe_norm(F_) / unit, false, "Newton's limit"};
            result.converged = result.residual <= tolerance;
            if (result.converged || report.loops == scheme.most_loops) break;
            by_A_.build(solver.set, scale, n, 0, false);
            options.size_of_x = unit;
            result = common::newton_krylov(residual, precondition, x_, unit, tolerance, 1, 200,
                                           newton_, options);
            report.krylov += result.linear_iterations;
            if (result.newton_iterations == 0) break;
        }
        if (!result.converged) fail(result, scheme, grains, solver.set);
        load(x_);
        push();
        const ContactSums did =
            contact.apply(dt, nodes, bonds, rigid, {0, 1 / theta}, correct_node);
        for (long s = 0; s < count; ++s) {
            RigidMotion& is = rigid[solver.servos[static_cast<std::size_t>(s)].grain];
            const bool along_x = solver.servos[static_cast<std::size_t>(s)].along_x;
            (along_x ? is.travel_x : is.travel_y) += dt * (along_x ? is.vx : is.vy);
        }
        state.pressed = solver.set.memory();
        return did;
    }

   private:
    template <class Work>
    static void for_each_slot(long n, const Work& work) {
        common::for_each_block(n, [&](int, long begin, long end) {
            for (long i = begin; i < end; ++i) work(i, static_cast<std::size_t>(i));
        });
    }

    void resize(long n, long servos) {
        for (Vector* v : {&root_, &v_, &Mv_, &R_, &part_, &rest_})
            if (v->size() != 2 * n) *v = Vector::Zero(2 * n);
        for (Vector* v : {&x_, &F_}) *v = Vector::Zero(2 * n + servos);
        cg_.resize(n);
    }

    // What a pair does now.
    static void see(const mpm::detail::Pair& now, MeetingPair& pair) {
        pair.lambda_n = now.lambda_n, pair.lambda_t = now.lambda_t;
        if (pair.bond >= 0) return;
        pair.hold = !(now.lambda_n > 0)                                         ? Hold::open
                    : std::fabs(now.lambda_t) < pair.mu * now.lambda_n * 0.9999 ? Hold::stick
                                                                                : Hold::slip;
    }

    [[noreturn]] static void fail(const common::NewtonResult& result, const ThetaScheme& scheme,
                                  const std::vector<Grain>& grains, const ContactSet& set) {
        std::size_t hardest = 0;
        for (std::size_t k = 0; k < set.pairs.size(); ++k)
            if (set.pairs[k].lambda_n > set.pairs[hardest].lambda_n) hardest = k;
        const std::string who =
            set.pairs.empty() ? "" : "; hardest pressed are " + set.names(hardest, grains);
        throw common::NumericalError("Newton's iteration did not converge: " + result.reason +
                                     "; residual " + common::shown(result.residual) +
                                     ", asked for " + common::shown(scheme.tolerance) + who +
                                     ": reduce time.alpha, or raise solver.most_loops");
    }

    bool watching_ = false;
    Vector root_, x_, F_, v_, Mv_, R_, part_, rest_;
    Constraints by_A_;
    CgWorkspace cg_;
    common::NewtonWorkspace newton_;
};

}  // namespace mpm_implicit
