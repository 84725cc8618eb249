// on the grid: the velocities v^theta of all nodes at once, with the forces and contacts of the
// same level.
//
//     m_i (v_i^1 - v_i^0)/dt = - sum_p V_p sigma_p^theta . grad S_ip + m_i f_i^theta     [MPM-8]
// sigma^theta = sigma^0 + theta T : de, de = dt sym grad v^theta [MPM-5, 7] and
// v^theta = v^0 + theta (v^1 - v^0), put in, give a symmetric system for v^theta:
//     A v^theta = M v^0 + theta dt (f^0 + m g) + H^T lambda,
//     A = M + theta dt (theta dt + beta) K
// with f^0 the force of the old stress, beta the viscosity of a material, and lambda the impulses of
// the closed pairs, which are found together with v^theta:
//
//     active set (open, slip, stick) -> projected conjugate gradients -> v^theta, lambda
//           ^                                                               |
//           +---- update where an impulse pulls, a pair approaches, --------+--> done when no state changes
//                 or friction is not Coulomb's
#pragma once

#include "mpm_implicit/solver/grain_factors.hpp"
#include "mpm_implicit/solver/mass_factors.hpp"
#include "mpm_implicit/solver/projected_cg.hpp"
#include "mpm_implicit/solver/update_active_set.hpp"
#include "mpm_implicit/theta_scheme.hpp"
#include "mpm_implicit/update_stress.hpp"

namespace mpm_implicit {

template <int reach>
class NodeSolver {
   public:
    GrainMatrix<reach> matrix;
    ActiveSet set;
    Constraints constraints;
    std::vector<ForceControl> force_controls;

    /// M and A of the step.
    /// in:     nodes.sums
    /// out:    matrix; small-mass and rank-deficient nodes are constrained to others
    template <class Shape>
    void assemble(const Shape& shape, const std::vector<AnyLaw>& laws, const ThetaScheme& scheme,
                  double dt, const State& state, GrainNodes& nodes) {
        const Assembly& all = state.assembly;
        const std::vector<GridRow> rows = grid_rows(all.grains, nodes, state.layout);
        constrain_small_mass_nodes(rows, {}, 1e-2, Neighbors::all, nodes);
        matrix.assemble(shape, laws, all.grains, all.particles, nodes, rows, scheme.theta * dt,
                        scheme.consistent());
        if (scheme.consistent())
            constrain_rank_deficient_nodes(mass_factors_.factorize(matrix, all.grains, nodes), rows,
                                           nodes);
    }

    /// M v^0 = P, and bonded grains have one velocity.
    /// in:     nodes.sums
    /// out:    nodes.motion, v_0; set, the bodies and pairs at every node
    /// errors: NumericalError when the mass matrix cannot be solved
    void find_old_velocities(const ThetaScheme& scheme, const Contact& contact, const State& state,
                             GrainNodes& nodes, SolveReport& report) {
        const Assembly& all = state.assembly;
        report = {};
        size_ = nodes.size();
        resize();
        nodal_velocity(all.grains, all.rigid, nodes);
        contact.join_bonds(all.bonds, nodes);
        set.find(contact, nodes, all.bonds, force_controls, state.active_pairs);
        matrix.diagonal_mass(scale_);
        invert_diagonal(nodes);
        for_each_dof(size_, [&](long i) {
            const NodeSums& sum = nodes.sums[i];
            b_[i] = sum.px, b_[size_ + i] = sum.py;
            v_0_[i] = scale_[i] > 0 ? nodes.motion[i].vx_0 : 0;
            v_0_[size_ + i] = scale_[size_ + i] > 0 ? nodes.motion[i].vy_0 : 0;
        });
        constraints.build(set, scale_, size_, 0, true);
        constraints.enforce({}, v_0_);
        ControlledGrains none;
        const auto multiply = [&](Vector& x, Vector& y) { matrix.multiply_mass(x, y); };
        const CgResult cg =
            projected_cg(multiply, mass_preconditioner(scheme), constraints, scale_, b_,
                         scheme.tolerance, scheme.max_iterations, v_0_, none, work_);
        report.mass_iterations = cg.iterations;
        if (!cg.converged) fail("the nodes before the step", cg, scheme);
        for_each_dof(size_, [&](long i) {
            if (nodes.is_free()[i] == 0) return;
            nodes.motion[i].vx_0 = v_0_[i], nodes.motion[i].vy_0 = v_0_[size_ + i];
        });
        fill_ghost_velocity(nodes);
    }

    /// The right-hand side and the diagonal of a step.
    /// in:     nodes with v_0 and, for projected_cg, the force of the old stress; else none
    void prepare(const ThetaScheme& scheme, const BodyForce& body, double dt, GrainNodes& nodes) {
        const double theta_dt = scheme.theta * dt;
        reduce_ghost_force(nodes);
        matrix.multiply_mass(v_0_, b_);
        for_each_dof(size_, [&](long i) {
            const double m = nodes.sums[i].m;
            b_[i] += theta_dt * (nodes.force[i].x + m * body.gravity_x);
            b_[size_ + i] += theta_dt * (nodes.force[i].y + m * body.gravity_y);
        });
        matrix.diagonal(scale_);
        invert_diagonal(nodes);
    }

    /// v^theta and the impulses of contact, by conjugate gradients with an active set.
    /// in/out: state: velocities of grains under force control, forces on rigid grains, bonds,
    ///         active pairs
    /// out:    nodes.motion, v^theta in the place of v_1; what contact did
    /// errors: NumericalError when the iteration or the active set does not settle, with the pair
    template <class Shape>
    ContactSums solve(const Shape& shape, const ThetaScheme& scheme, const Contact& contact,
                      const BodyForce& body, double dt, State& state, GrainNodes& nodes,
                      SolveReport& report) {
        const std::vector<Grain>& grains = state.assembly.grains;
        std::vector<RigidMotion>& rigid = state.assembly.rigid;
        force_of_stress(shape, grains, state.assembly.particles, nodes);
        prepare(scheme, body, dt, nodes);
        ControlledGrains controlled;
        for (const ForceControl& control : force_controls) {
            controlled.diagonal.push_back(control.mass + scheme.theta * dt * control.damping);
            controlled.V.push_back(control.velocity);
        }
        v_ = v_0_;
        use_preconditioner(scheme, grains, nodes);
        const auto multiply = [&](Vector& x, Vector& y) { matrix.multiply(x, y); };
        // Active sets settle long before velocities do.
        constexpr double rough = 1e-7;
        double tolerance = std::max(scheme.tolerance, rough);
        for (report.loops = 1;; ++report.loops) {
            set_right_hand_side(scheme.theta, dt, controlled);
            constraints.build(set, scale_, size_, force_controls.size(), false);
            constraints.enforce(controlled.V, v_);
            const CgResult cg =
                projected_cg(multiply, preconditioner(constraints), constraints, scale_, right_,
                             tolerance, scheme.max_iterations, v_, controlled, work_);
            report.iterations += cg.iterations;
            if (!cg.converged) fail("the nodes", cg, scheme);
            constraints.find_impulses(work_.r, set);
            const ActiveSetChange change =
                update_active_set(v_, controlled.V, nodes, tolerance, set);
            if (change.settled) {
                if (tolerance == scheme.tolerance) break;
                // The same set, to the end.
                tolerance = scheme.tolerance;
                --report.loops;
                continue;
            }
            if (report.loops == scheme.max_outer_iterations)
                fail_to_settle(change, set, grains, scheme.max_outer_iterations);
        }
        for (std::size_t s = 0; s < force_controls.size(); ++s) {
            RigidMotion& is = rigid[force_controls[s].grain];
            (force_controls[s].along_x ? is.vx : is.vy) = controlled.V[s];
            (force_controls[s].along_x ? is.travel_x : is.travel_y) += dt * controlled.V[s];
        }
        for_each_dof(size_, [&](long i) {
            nodes.motion[i].vx_1 = v_[i], nodes.motion[i].vy_1 = v_[size_ + i];
        });
        prescribe_rigid_velocity(grains, rigid, nodes);
        fill_ghost_velocity(nodes);
        state.active_pairs = set.active_pairs();
        return set.account(contact, scheme.theta, dt, nodes, state.assembly.bonds, rigid);
    }

    /// Factorizes the grains, if the scheme asks for it.
    void use_preconditioner(const ThetaScheme& scheme, const std::vector<Grain>& grains,
                            const GrainNodes& nodes) {
        by_grains_ = scheme.preconditioner == "grains";
        if (by_grains_) factors_.factorize(matrix, scale_, grains, nodes);
    }

    /// z from t, both in y = D^{1/2} v and within what the pairs allow: t itself for the diagonal,
    /// P D^{1/2} A_g^-1 D^{1/2} P t for factorized grains.
    auto preconditioner(const Constraints& allowed) const {
        return [this, &allowed](const Vector& t, CgWorkspace& work) -> const Vector& {
            if (!by_grains_) return t;
            return precondition(factors_, allowed, t, work);
        };
    }

    const Vector& right_hand_side() const { return b_; }
    const Vector& old_velocities() const { return v_0_; }
    const Vector& scale() const { return scale_; }

   private:
    // z = P D^{1/2} F^-1 D^{1/2} P t with factors F.
    template <class Factors>
    const Vector& precondition(const Factors& factors, const Constraints& allowed, const Vector& t,
                               CgWorkspace& work) const {
        const double *s = scale_.data(), *from = t.data();
        double *r = work.s.data(), *z = work.z.data();
        for_each_dof(2 * size_, [&](long i) { r[i] = s[i] > 0 ? from[i] / s[i] : 0; });
        factors.solve(work.s, work.z);
        for_each_dof(2 * size_, [&](long i) { z[i] = s[i] > 0 ? z[i] / s[i] : 0; });
        allowed.project(work.z);
        return work.z;
    }

    auto mass_preconditioner(const ThetaScheme& scheme) const {
        return [this, factorized = scheme.consistent()](const Vector& t,
                                                        CgWorkspace& work) -> const Vector& {
            return factorized ? precondition(mass_factors_, constraints, t, work) : t;
        };
    }

    void resize() {
        work_.resize(size_);
        for (Vector* v : {&v_0_, &v_, &b_, &right_, &scale_})
            if (v->size() != 2 * size_) *v = Vector::Zero(2 * size_);
    }

    // D^{-1/2} where a velocity can change: of free grains, with mass, and not held by a wall.
    void invert_diagonal(const GrainNodes& nodes) {
        for_each_dof(size_, [&](long i) {
            const bool moves = nodes.is_free()[i] != 0 && nodes.sums[i].m > nodes.least_mass();
            for (const auto& [at, fixed] :
                 {std::pair(i, nodes.is_fixed_x(i)), std::pair(size_ + i, nodes.is_fixed_y(i))})
                scale_[at] = moves && !fixed && scale_[at] > 0 ? 1 / std::sqrt(scale_[at]) : 0;
        });
    }

    // The right-hand side of the step, with the known friction of slipping pairs.
    void set_right_hand_side(double theta, double dt, ControlledGrains& controlled) {
        right_ = b_;
        controlled.b.clear();
        for (const ForceControl& control : force_controls)
            controlled.b.push_back(control.mass * control.velocity + theta * dt * control.force);
        add_friction(size_, set, right_, controlled.b);
    }

    [[noreturn]] void fail(const char* what, const CgResult& cg, const ThetaScheme& scheme) const {
        const bool ran_out = cg.iterations >= scheme.max_iterations;
        throw common::NumericalError(
            std::string("the velocities of ") + what + " are not found in " +
            std::to_string(cg.iterations) + " iterations: residual " + common::format(cg.residual) +
            ", asked for " + common::format(scheme.tolerance) + "; " +
            (ran_out ? "raise solver.max_iterations, reduce time.alpha" : "round-off ended them") +
            (scheme.consistent() ? "; where the mass matrix is nearly singular, as in sharp "
                                   "corners, raise grid.particles_per_side"
                                 : ""));
    }

    GrainFactors factors_;
    MassFactors mass_factors_;
    bool by_grains_ = true;
    long size_ = 0;
    Vector v_0_, v_, b_, right_, scale_;
    CgWorkspace work_;
};

}  // namespace mpm_implicit
