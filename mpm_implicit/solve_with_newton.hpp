// The same step by Newton and Krylov, as the talk's abstract has it for fields: nothing is
// linearized by hand, so plastic grains and growing volumes are as good as elastic ones.
//
// Unknowns: x = D^{1/2} v^theta of all dofs (2 n numbers), and m^{1/2} V of grains under force
// control. With R the missing momentum, and C the contact operator of the explicit program,
//     F(v) = v - C(v + R(v)/D),
//     R(v) = M (v^0 - v) + theta dt [f(sigma^theta(v)) + m g]
// is zero where impulses of contact make up for R, whatever the masses D of C: here diag A.
//     Newton           x <- x + s,  J s = -F,  J = dF/dx
//     GMRES            for s, with J s by differences of F
//     preconditioner   projected conjugate gradients for the elastic A and the pairs closed now
#pragma once

#include "common/newton_krylov.hpp"
#include "mpm_implicit/solve_nodes.hpp"
#include "mpm_implicit/update_stress.hpp"

namespace mpm_implicit {

template <int reach>
class NewtonSolver {
   public:
    /// v^theta and the impulses of contact, by Newton's method.
    /// in:     solver, with the matrix and v_0 of this step
    /// in/out: as NodeSolver::solve
    /// errors: NumericalError when Newton or Krylov does not get there, with the pair
    template <class Shape>
    ContactSums solve(const Shape& shape, const std::vector<AnyLaw>& laws,
                      const ThetaScheme& scheme, const Contact& contact, const BodyForce& body,
                      double dt, State& state, NodeSolver<reach>& solver, GrainNodes& nodes,
                      SolveReport& report) {
        solver.prepare(scheme, body, dt, nodes);
        solver.use_preconditioner(scheme, state.assembly.grains, nodes);
        Step step{laws, scheme, contact, body, dt, state.assembly, solver, nodes, report};
        begin(step);
        const auto F_of = [&](const Vector& x, Vector& F) { residual(shape, x, step, F); };
        const auto J_of = [&](const Vector& r, Vector& z) { precondition(r, step, z); };
        common::NewtonOptions options;
        options.first_forcing = 1e-4, options.smallest_forcing = 1e-6, options.convex = true;
        common::NewtonResult result;
        double unit = 0;
        // One Newton step at a time, each with the pairs that are closed then.
        for (report.loops = 0; report.loops <= scheme.max_outer_iterations; ++report.loops) {
            step.updating = true;
            F_of(x_, F_);
            step.updating = false;
            if (report.loops == 0)
                unit = std::max({common::safe_norm(F_), common::safe_norm(x_), missing_, pressed_,
                                 std::numeric_limits<double>::min()});
            // What round-off of R leaves in F.
            const double tolerance =
                std::max(scheme.tolerance,
                         8 * std::numeric_limits<double>::epsilon() * common::safe_norm(x_) / unit);
            result = {0, 0, common::safe_norm(F_) / unit, false, "Newton's limit"};
            result.converged = result.residual <= tolerance;
            if (result.converged || report.loops == scheme.max_outer_iterations) break;
            allowed_.build(solver.set, solver.scale(), nodes.size(), 0, false);
            options.size_of_x = unit;
            result =
                common::newton_krylov(F_of, J_of, x_, unit, tolerance, 1, 200, newton_, options);
            report.krylov += result.linear_iterations;
            if (result.newton_iterations == 0) break;
        }
        if (!result.converged)
            throw common::NumericalError("Newton's iteration did not converge: " + result.reason +
                                         "; residual " + common::format(result.residual) +
                                         ", asked for " + common::format(scheme.tolerance) + "; " +
                                         solver.set.hardest_pressed(state.assembly.grains) +
                                         solver.set.advice());
        return end(shape, step, state);
    }

   private:
    /// What the functions of one step have in common.
    struct Step {
        const std::vector<AnyLaw>& laws;
        const ThetaScheme& scheme;
        const Contact& contact;
        const BodyForce& body;
        double dt;
        Assembly& all;
        NodeSolver<reach>& solver;
        GrainNodes& nodes;
        SolveReport& report;
        bool updating = false;  // the states of pairs are updated
        const Vector& scale() const { return solver.scale(); }
    };

    // The guess v^0, as x = D^{1/2} v where velocities can change; then V m^{1/2}.
    void begin(const Step& step) {
        const long n = step.nodes.size(),
                   count = static_cast<long>(step.solver.force_controls.size());
        for (Vector* v : {&root_, &v_, &Mv_, &part_, &rest_})
            if (v->size() != 2 * n) *v = Vector::Zero(2 * n);
        for (Vector* v : {&x_, &F_}) *v = Vector::Zero(2 * n + count);
        cg_.resize(n);
        const Vector& scale = step.scale();
        for_each_dof(2 * n, [&](long at) {
            root_[at] = scale[at] > 0 ? 1 / scale[at] : 0;
            x_[at] = root_[at] * step.solver.old_velocities()[at];
        });
        for (long s = 0; s < count; ++s) {
            const ForceControl& control = step.solver.force_controls[s];
            x_[2 * n + s] = std::sqrt(control.mass) * control.velocity;
        }
    }

    // Puts v + R(v)/D on the nodes, for contact.
    template <class Shape>
    void add_missing_momentum(const Shape& shape, const Vector& x, Step& step) {
        GrainNodes& nodes = step.nodes;
        const Vector &scale = step.scale(), &b = step.solver.right_hand_side();
        const long n = nodes.size();
        for (std::size_t s = 0; s < step.solver.force_controls.size(); ++s) {
            const ForceControl& control = step.solver.force_controls[s];
            RigidMotion& is = step.all.rigid[control.grain];
            (control.along_x ? is.vx : is.vy) =
                x[2 * n + static_cast<long>(s)] / std::sqrt(control.mass);
        }
        prescribe_rigid_velocity(step.all.grains, step.all.rigid, nodes);
        for_each_dof(n, [&](long i) {
            v_[i] = scale[i] * x[i], v_[n + i] = scale[n + i] * x[n + i];
            if (nodes.is_free()[i] != 0)
                nodes.motion[i].vx_1 = v_[i], nodes.motion[i].vy_1 = v_[n + i];
        });
        fill_ghost_velocity(nodes);
        force_at_theta(shape, step.laws, step.scheme, step.dt, step.all.grains, step.all.particles,
                       nodes);
        step.solver.matrix.multiply_mass(v_, Mv_);
        const double theta_dt = step.scheme.theta * step.dt;
        for_each_dof(n, [&](long i) {
            if (nodes.is_free()[i] == 0) return;
            const auto pushed = [&](long at, double force) {
                const double R = b[at] + theta_dt * force - Mv_[at];
                return scale[at] > 0 ? v_[at] + R * scale[at] * scale[at] : 0.0;
            };
            nodes.motion[i].vx_1 = pushed(i, nodes.force[i].x);
            nodes.motion[i].vy_1 = pushed(n + i, nodes.force[i].y);
        });
    }

    // The operator C of the explicit program, with the masses D.
    static void correct_velocities(const Vector& scale, long n, ContactNode& node) {
        node.isotropic = false;
        for (ContactBody& body : node.bodies) {
            if (body.is_fixed()) continue;
            body.per_mx = scale[body.dof] * scale[body.dof];
            body.per_my = scale[n + body.dof] * scale[n + body.dof];
        }
        for (ContactPair& pair : node.pairs) pair.lambda_n = pair.lambda_t = 0;
        find_effective_masses(node);
        solve_contact_node(node);
    }

    // F(v) = v - C(v + R(v)/D), and of a grain under force control
    // V^theta - [V^0 + (theta dt F + impulses)/m]/(1 + theta dt c/m).
    template <class Shape>
    void residual(const Shape& shape, const Vector& x, Step& step, Vector& F) {
        GrainNodes& nodes = step.nodes;
        const std::vector<ForceControl>& controls = step.solver.force_controls;
        const long n = nodes.size();
        add_missing_momentum(shape, x, step);
        const double theta_dt = step.scheme.theta * step.dt;
        if (step.updating) {
            for_each_dof(n, [&, &scale = step.scale()](long i) {
                part_[i] = root_[i] * nodes.motion[i].vx_1 - x[i];
                part_[n + i] = root_[n + i] * nodes.motion[i].vy_1 - x[n + i];
                rest_[i] = scale[i] * theta_dt * nodes.force[i].x;
                rest_[n + i] = scale[n + i] * theta_dt * nodes.force[i].y;
            });
            missing_ = common::safe_norm(part_), pressed_ = common::safe_norm(rest_);
        }
        std::array<std::vector<double>, common::block_count> impulses;
        for (auto& block : impulses) block.assign(controls.size(), 0.0);
        step.solver.set.list.for_each(nodes, [&](int number, ContactNode& node, std::size_t first) {
            const auto block = static_cast<std::size_t>(number);
            correct_velocities(step.scale(), n, node);
            for (const ContactPair& pair : node.pairs) {
                if (step.updating) update_state(pair, step.solver.set.list.pairs[first++]);
                for (std::size_t s = 0; s < controls.size(); ++s)
                    impulses[block][s] += impulse_on(controls[s], node, pair);
            }
            store_velocities(node, nodes);
        });
        for_each_dof(n, [&](long i) {
            F[i] = x[i] - root_[i] * nodes.motion[i].vx_1;
            F[n + i] = x[n + i] - root_[n + i] * nodes.motion[i].vy_1;
        });
        for (std::size_t s = 0; s < controls.size(); ++s) {
            double impulse = theta_dt * controls[s].force;
            for (const auto& block : impulses) impulse += block[s];
            const double m = controls[s].mass, V = (controls[s].velocity + impulse / m) /
                                                   (1 + theta_dt * controls[s].damping / m);
            F[2 * n + long(s)] = x[2 * n + long(s)] - std::sqrt(m) * V;
        }
    }

    // z = (1 - P) r + (P A P)^-1 [P r - P A (1 - P) r] with Constraints::project; z = r for V.
    void precondition(const Vector& r, Step& step, Vector& z) {
        const Vector& scale = step.scale();
        const long n = step.nodes.size();
        part_ = r.head(2 * n);
        allowed_.project(part_);
        for_each_dof(2 * n, [&](long at) {
            rest_[at] = scale[at] > 0 ? r[at] - part_[at] : 0;
            v_[at] = scale[at] * rest_[at];
        });
        const auto multiply = [&](Vector& x, Vector& y) { step.solver.matrix.multiply(x, y); };
        multiply(v_, Mv_);
        for_each_dof(2 * n, [&](long at) { part_[at] = root_[at] * part_[at] - Mv_[at]; });
        v_.setZero();
        ControlledGrains none;
        const CgResult cg =
            projected_cg(multiply, step.solver.preconditioner(allowed_), allowed_, scale, part_,
                         1e-4, step.scheme.max_iterations, v_, none, cg_);
        step.report.iterations += cg.iterations;
        z = r;
        for_each_dof(2 * n, [&](long at) { z[at] = rest_[at] + root_[at] * v_[at]; });
    }

    // What contact has done at the solution, with the masses D.
    template <class Shape>
    ContactSums end(const Shape& shape, Step& step, State& state) {
        state.active_pairs = step.solver.set.active_pairs();
        add_missing_momentum(shape, x_, step);
        const long n = step.nodes.size();
        ContactTally sums = step.contact.tally({0, 1 / step.scheme.theta});
        step.solver.set.list.for_each(step.nodes, [&](int block, ContactNode& node, std::size_t) {
            correct_velocities(step.scale(), n, node);
            sums.add(block, node);
            store_velocities(node, step.nodes);
        });
        fill_ghost_velocity(step.nodes);
        const ContactSums did = sums.finish(step.dt, step.all.bonds, step.all.rigid);
        for (const ForceControl& control : step.solver.force_controls) {
            RigidMotion& is = step.all.rigid[control.grain];
            const double V = control.along_x ? is.vx : is.vy;
            (control.along_x ? is.travel_x : is.travel_y) += step.dt * V;
        }
        return did;
    }

    Vector root_, x_, F_, v_, Mv_, part_, rest_;
    double missing_ = 0, pressed_ = 0;  // D^{-1/2} times R, and times theta dt f
    Constraints allowed_;
    CgWorkspace cg_;
    common::NewtonWorkspace newton_;
};

}  // namespace mpm_implicit
