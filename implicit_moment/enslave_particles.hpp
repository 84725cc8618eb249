// particles and grid at once: particles that follow the field to where it leads them, so that both
// energy and Gauss's law hold to the tolerance of the solver.
//
// The mass matrix fixes the place x* where a particle feels the field; its current is then that of a
// particle that stands at x*, and charge is not conserved. Here the particle is felt all along its
// straight path from x^n to x^{n+1},
//
//     x^{n+1} = x^n + dt vbar,   vbar = R_p [ v^n + (q dt/2m) E_p ],   v^{n+1} = 2 vbar - v^n
//     E_p = int_0^1 sum_g W_g(x^n + s dt vbar) E_g ds
//     J_g = (1/V) sum_p q vbar int_0^1 W_g(x^n + s dt vbar) ds
//
// The same integrals in E_p and J make the exchange of energy exact; and because W are descending
// splines, d S^(l)/dx a difference of S^(l-1), rho^{n+1} - rho^n + dt div J = 0 exactly. The splines are
// polynomials between the lines halfway between nodes, so the integrals are too: between two lines,
// two points of Gauss are exact for the charge.
//
// Each particle's x^{n+1} depends on E^{n+theta}, and that on all of them. E^{n+theta} is corrected
// with the response of the mass matrix until the field equations hold with the current above.
//
// source: G. Chen, L. Chacon and D. C. Barnes, J. Comput. Phys. 230, 7018 (2011); the mass matrix
//         as the Jacobian here.
#pragma once

#include <cmath>
#include <vector>

#include "implicit_moment/kick_and_fly.hpp"
#include "implicit_moment/solve_field.hpp"

namespace implicit_moment {

namespace detail {

// One coordinate of a path in cells from the first node; behind walls and periodic ends it goes on
// straight. A piece of it lies between two of the lines where splines change their polynomials.
struct PathAxis {
    long cells;
    bool periodic;
    double start, way;  // from start to start + way
    double low, high;   // of the present piece

    PathAxis(const common::Axis& axis, double x, double displacement)
        : cells(axis.cells),
          periodic(axis.periodic),
          start((x - axis.low) / axis.spacing()),
          way(displacement / axis.spacing()) {
        low = std::floor(start + 0.5) - 0.5, high = low + 1;
        const double node = low + 0.5;
        if (is_wall(node)) (start < node || (start == node && way < 0) ? high : low) = node;
    }
    bool is_wall(double node) const { return !periodic && std::fmod(node, double(cells)) == 0; }
    // The part of the path after which the piece ends.
    double end_of_piece() const {
        if (way == 0) return 2;
        return ((way > 0 ? high : low) - start) / way;
    }
    void next_piece() {
        double& front = way > 0 ? high : low;
        (way > 0 ? low : high) = front;
        const double side = way > 0 ? 0.5 : -0.5, node = front + side;
        front = is_wall(front) || is_wall(node) ? node : front + 2 * side;
    }
    // The place on the mesh of a point of the path: node, distance from it, and -1 where the path has
    // been reflected an odd number of times.
    void place(double part, long& node, double& d, double& mirror) const {
        const double middle = 0.5 * (low + high), turns = std::floor(middle / double(cells));
        double x = start + part * way - turns * double(cells), m = middle - turns * double(cells);
        mirror = 1;
        if (!periodic && std::fmod(turns, 2) != 0) {
            x = double(cells) - x, m = double(cells) - m;
            mirror = -1;
        }
        node = long(m + 0.5);
        d = x - double(node);
    }
    bool is_near_wall(double reach) const {
        reach = std::fmax(reach, std::fabs(way));
        return !periodic && (start - reach <= 0 || start + reach >= double(cells));
    }
    bool meets_wall() const {
        return !periodic && (start + way < 0 || start + way > double(cells));
    }
    // Where the path ends.
    double end(const common::Axis& axis, double& v) const {
        double x = axis.low + (start + way) * axis.spacing();
        land(axis, x, v);
        return x;
    }
};

// Calls visit(weight, corner, d_x, d_z, mirror_x, mirror_z) at the points of Gauss of every piece.
template <class Visit>
inline void along_path(const Grid& grid, PathAxis x, PathAxis z, const Visit& visit) {
    const double gauss = 0.5 / std::sqrt(3.0);
    for (double begin = 0; begin < 1;) {
        const double end_x = x.end_of_piece(), end_z = z.end_of_piece(),
                     end = std::fmin(1.0, std::fmax(begin, std::fmin(end_x, end_z)));
        if (end > begin) {
            for (const double side : {-gauss, gauss}) {
                const double part = 0.5 * (begin + end) + side * (end - begin);
                long i, j;
                double d_x, d_z, m_x, m_z;
                x.place(part, i, d_x, m_x);
                z.place(part, j, d_z, m_z);
                visit(0.5 * (end - begin), grid.index(i - 1, j - 1), d_x, d_z, m_x, m_z);
            }
        }
        if (end >= 1) break;
        if (end_x <= end) x.next_piece();
        if (end_z <= end) z.next_piece();
        begin = end;
    }
}

// The mean field along a path, in the frame in which the path is straight.
inline LocalField<double> field_along(const Grid& grid, const InterleavedField& field,
                                      const PathAxis& x, const PathAxis& z) {
    LocalField<double> mean{};
    along_path(grid, x, z,
               [&](double w, long corner, double d_x, double d_z, double m_x, double m_z) {
                   const auto at = gather_field(&field[corner], grid.stride(), d_x, d_z);
                   mean.E_x += w * m_x * at.E_x;
                   mean.E_y += w * at.E_y;
                   mean.E_z += w * m_z * at.E_z;
                   // B turns around in a mirror where E stays.
                   mean.B_x += w * m_z * at.B_x;
                   mean.B_y += w * m_x * m_z * at.B_y;
                   mean.B_z += w * m_x * at.B_z;
               });
    return mean;
}

// How far a path is found: settled, it stays as it is; sliding, it keeps its distance from a wall.
struct PathState {
    bool settled = false, slides_x = false, slides_z = false;
};

// Finds the path of one particle in a field, by iteration.
// in:     x, z and v at t^n; may_change, false where a path that meets a wall is to stay as it is
// in/out: vbar; state
// note:   reflected paths may jump between two ways to go, and a particle that the field presses against a
//         wall would bounce for ever: corrections become smaller, and at last it slides.
inline void find_path(const Grid& grid, const InterleavedField& field, double dt,
                      const MoverSettings& settings, double half_kick, double x, double z,
                      const Velocity<double>& v, bool may_change, Velocity<double>& vbar,
                      PathState& state) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    double change = 2 * settings.tolerance;
    for (long i = 0; change > settings.tolerance && !state.settled; ++i) {
        if (state.slides_x) vbar.x = 0;
        if (state.slides_z) vbar.z = 0;
        const PathAxis path_x(grid.x, x, dt * vbar.x), path_z(grid.z, z, dt * vbar.z);
        if (!may_change && (path_x.meets_wall() || path_z.meets_wall())) {
            state.settled = true;
            break;
        }
        const auto next = mean_velocity(v, field_along(grid, field, path_x, path_z), half_kick);
        if (i == 2 * settings.max_iterations) {
            state.slides_x = path_x.is_near_wall(std::fabs(dt * next.x * per_dx));
            state.slides_z = path_z.is_near_wall(std::fabs(dt * next.z * per_dz));
        }
        if (i == 4 * settings.max_iterations) state.settled = true;
        const double step_x = state.slides_x ? 0 : next.x - vbar.x, step_y = next.y - vbar.y,
                     step_z = state.slides_z ? 0 : next.z - vbar.z;
        change = dt * std::fmax(std::fabs(step_x) * per_dx, std::fabs(step_z) * per_dz);
        const double part = i < 3 ? 1 : 3 / double(i + 1);
        vbar = {vbar.x + part * step_x, vbar.y + part * step_y, vbar.z + part * step_z};
    }
    if (state.slides_x) vbar.x = 0;
    if (state.slides_z) vbar.z = 0;
}

}  // namespace detail

/// What enslaved particles keep through the iterations of one step.
struct EnslavedParticles {
    std::vector<std::vector<Velocity<double>>> vbar;  // [species][particle]
    std::vector<std::vector<detail::PathState>> state;
    std::vector<VectorField> J_of_block;
    VectorField J, curl;
    explicit EnslavedParticles(const Grid& grid)
        : J_of_block(common::block_count, VectorField(grid)), J(grid), curl(grid) {}
};

inline constexpr int free_turns = 4;  // after which a path that meets a wall stays as it is

/// Finds every particle's path in a field, and the current along the paths.
/// in:     field, the smoothed E^{n+theta} and B, ghosts filled; particles at t^n
/// in/out: enslaved.vbar, the guess and what was found
/// out:    enslaved.J, ghosts filled
/// exact:  rho(x^n + dt vbar) - rho(x^n) + dt div J = 0 to round-off, for any vbar
inline void follow_field(const InterleavedField& field, const Grid& grid, double dt,
                         const MoverSettings& settings, const std::vector<Particles>& species,
                         int turn, EnslavedParticles& enslaved) {
    for (VectorField& J : enslaved.J_of_block) J.all.setZero();
    const long stride = grid.stride();
    for (std::size_t k = 0; k < species.size(); ++k) {
        const Particles& s = species[k];
        const double half_kick = 0.5 * dt * s.q_p / s.m_p, q = s.q_p / grid.cell_area();
        common::for_each_block(s.count(), [&](int block, long begin, long end) {
            VectorField& J = enslaved.J_of_block[std::size_t(block)];
            for (long p = begin; p < end; ++p) {
                const Velocity<double> v{s.ux_p[p], s.uy_p[p], s.uz_p[p]};
                Velocity<double>& vbar = enslaved.vbar[k][std::size_t(p)];
                detail::find_path(grid, field, dt, settings, half_kick, s.x_p[p], s.z_p[p], v,
                                  turn < free_turns, vbar, enslaved.state[k][std::size_t(p)]);
                detail::along_path(
                    grid, {grid.x, s.x_p[p], dt * vbar.x}, {grid.z, s.z_p[p], dt * vbar.z},
                    [&](double w, long corner, double d_x, double d_z, double m_x, double m_z) {
                        const common::QuadraticWeights<double> S_x(d_x), S_z(d_z);
                        const double j_x = q * w * m_x * vbar.x, j_y = q * w * vbar.y,
                                     j_z = q * w * m_z * vbar.z;
                        for (int j = 0; j < 3; ++j) {
                            const double w_x = j_x * S_z.quadratic[j], w_y = j_y * S_z.quadratic[j];
                            double *J_x = J.x() + corner + j * stride,
                                   *J_y = J.y() + corner + j * stride;
                            for (int i = 0; i < 2; ++i) J_x[i] += w_x * S_x.linear[i];
                            for (int i = 0; i < 3; ++i) J_y[i] += w_y * S_x.quadratic[i];
                        }
                        for (int j = 0; j < 2; ++j) {
                            const double w_z = j_z * S_z.linear[j];
                            double* J_z = J.z() + corner + j * stride;
                            for (int i = 0; i < 3; ++i) J_z[i] += w_z * S_x.quadratic[i];
                        }
                    });
            }
        });
    }
    enslaved.J.all.setZero();
    for (const VectorField& J : enslaved.J_of_block) enslaved.J.all += J.all;
    for (std::size_t a = 0; a < 3; ++a)
        common::fold_ghosts(grid, electric.place[a], electric.parity[a],
                            enslaved.J.all.data() + long(a) * grid.size());
}

/// Takes the step that follow_field has found: x^{n+1} where the path ends, v^{n+1} from the field along it.
/// in:     field, that of follow_field
/// exact:  particles gain dt sum V J . E, also where mover.tolerance stopped the iteration for a path: there
///         2 vbar - v^n is scaled to |v^{n+1}|^2 = |v^n|^2 + 2 (q dt/m) (x^{n+1} - x^n)/dt . E_p.
/// errors: NumericalError where no speed has that energy: a path was not found
inline void move_enslaved(const InterleavedField& field, const Grid& grid, double dt,
                          const EnslavedParticles& enslaved, std::vector<Particles>& species) {
    for (std::size_t k = 0; k < species.size(); ++k) {
        Particles& s = species[k];
        const double half_kick = 0.5 * dt * s.q_p / s.m_p;
        const double lost = common::sum_over_blocks(s.count(), [&](long begin, long end) {
            double count = 0;
            for (long p = begin; p < end; ++p) {
                const Velocity<double> v{s.ux_p[p], s.uy_p[p], s.uz_p[p]},
                    &u = enslaved.vbar[k][std::size_t(p)];
                const detail::PathAxis x(grid.x, s.x_p[p], dt * u.x), z(grid.z, s.z_p[p], dt * u.z);
                const auto at = detail::field_along(grid, field, x, z);
                const auto vbar = mean_velocity(v, at, half_kick);
                const double X = 2 * vbar.x - v.x, Y = 2 * vbar.y - v.y, Z = 2 * vbar.z - v.z;
                const double before = v.x * v.x + v.y * v.y + v.z * v.z,
                             work = 4 * half_kick * (u.x * at.E_x + u.y * at.E_y + u.z * at.E_z),
                             found = X * X + Y * Y + Z * Z, wanted = before + work;
                if (wanted < -1e-12 * (before + found)) ++count;
                const double scale = wanted > 0 && found > 0 ? std::sqrt(wanted / found) : 1;
                s.ux_p[p] = scale * X;
                s.uy_p[p] = scale * Y;
                s.uz_p[p] = scale * Z;
                s.x_p[p] = x.end(grid.x, s.ux_p[p]);
                s.z_p[p] = z.end(grid.z, s.uz_p[p]);
            }
            return count;
        });
        if (lost > 0)
            throw common::NumericalError("the paths of " + common::format(lost) + " of the " +
                                         s.name + " are not found; reduce time.dt");
    }
}

namespace detail {

// Anderson's acceleration of E <- E + f(E): of the last few E and f the combination with the smallest f.
// source: D. G. Anderson, J. ACM 12, 547 (1965)
class Acceleration {
   public:
    // in: f, what E lacks by the plain iteration. out: E, the next guess
    void next(const Eigen::VectorXd& f, Eigen::VectorXd& E) {
        if (last_f_.size() > 0) {
            const Eigen::Index k = count_++ % depth;
            if (dE_.cols() == 0) dE_.setZero(E.size(), depth), df_ = dE_;
            dE_.col(k) = E - last_E_;
            df_.col(k) = f - last_f_;
        }
        last_E_ = E, last_f_ = f;
        E += f;
        const Eigen::Index known = std::min<Eigen::Index>(count_, depth);
        if (known == 0) return;
        const Eigen::VectorXd gamma = df_.leftCols(known).colPivHouseholderQr().solve(f);
        E -= (dE_.leftCols(known) + df_.leftCols(known)) * gamma;
    }

   private:
    static constexpr Eigen::Index depth = 8;
    Eigen::Index count_ = 0;
    Eigen::MatrixXd dE_, df_;
    Eigen::VectorXd last_E_, last_f_;
};

}  // namespace detail

/// Solves field and particles together.
/// in:     solver.mass of the same particles; particles and field at t^n
/// out:    field.E_theta; enslaved.vbar; enslaved.J, smoothed
/// exact:  |residual| <= tolerance |source|
/// errors: NumericalError when it does not converge
inline FieldReport solve_enslaved_field(FieldSolver& solver, double dt,
                                        const MoverSettings& settings,
                                        const std::vector<Particles>& species, FieldState& field,
                                        VectorField& B_theta, InterleaveScratch& scratch,
                                        InterleavedField& interleaved,
                                        EnslavedParticles& enslaved) {
    const Grid& grid = solver.grid;
    const SmoothingSettings& smoothing = solver.settings.smoothing;
    const double a = c * solver.settings.theta * dt, by_J = 4 * pi * solver.settings.theta * dt;
    const double goal = solver.settings.solved_to();
    enslaved.vbar.resize(species.size());
    enslaved.state.resize(species.size());
    for (std::size_t k = 0; k < species.size(); ++k) {
        enslaved.vbar[k].resize(species[k].x_p.size());
        enslaved.state[k].assign(species[k].x_p.size(), {});
        for (std::size_t p = 0; p < species[k].x_p.size(); ++p)
            enslaved.vbar[k][p] = {species[k].ux_p[p], species[k].uy_p[p], species[k].uz_p[p]};
    }

    // The guess: the mass matrix alone. Then what is left of the field equations is corrected with it.
    FieldReport report = solve_field(solver, dt, field, 1e-3);
    Eigen::VectorXd source = solver.source.all + by_J * solver.mass.J_hat.all, correction;
    keep_unknowns(grid, source.data());
    const double scale = std::max(common::safe_norm(source), common::safe_norm(solver.source.all));
    detail::Acceleration faster;
    MoverSettings follow = settings;
    for (int turn = 0;; ++turn) {
        // B at the same level: B^n - a curl E.
        curl_of_electric(grid, field.E_theta.all.data(), enslaved.curl.all.data());
        B_theta.all = field.B.all - a * enslaved.curl.all;
        fill_ghosts(grid, magnetic, B_theta);
        interleave_field(grid, smoothing, field.E_theta, B_theta, scratch, interleaved);
        follow_field(interleaved, grid, dt, follow, species, turn, enslaved);
        smooth(grid, electric, smoothing, enslaved.J.all.data(), solver.scratch);

        // What is left: source - E + a curl (B_theta - B^n) - 4 pi theta dt J.
        VectorField& left = solver.source;
        B_theta.all -= field.B.all;
        curl_of_magnetic(grid, B_theta.all.data(), left.all.data());
        left.all = source - field.E_theta.all + a * left.all - by_J * enslaved.J.all;
        keep_unknowns(grid, left.all.data());
        report.residual = scale > 0 ? common::safe_norm(left.all) / scale : 0;
        if (report.residual <= goal) break;
        if (turn == 100 || !std::isfinite(report.residual))
            throw common::NumericalError(
                "field and particles did not converge together (relative "
                "residual " +
                common::format(report.residual) + "); reduce time.dt");
        follow.tolerance = std::min(settings.tolerance, std::max(1e-14, 0.1 * report.residual));
        correction.setZero(left.all.size());
        report.iterations += detail::solve_linear_field(solver, a, 1e-3, correction).iterations;
        faster.next(correction, field.E_theta.all);
        keep_unknowns(grid, field.E_theta.all.data());
        fill_ghosts(grid, electric, field.E_theta);
    }
    B_theta.all += field.B.all;
    field.iterations = report.iterations;
    return report;
}

}  // namespace implicit_moment
