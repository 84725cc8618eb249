// The operator of the field equations, A E = (1 + S chi S) E + a^2 curl curl E, and its inverse for a
// uniform plasma, which preconditions GMRES.   [IMM-10]
//
// Applied, E visits the places of the mesh:
//
//     E  edges, nodes --curl--> B  z-edges, faces, x-edges --curl--> edges, nodes   times a^2
//     E  --smooth S--> as particles feel it --chi--> their current --smooth S--> as the field sees it
//
// chi is a 3 x 3 tensor on nodes (predict_current.hpp), or 4 pi theta dt times the mass matrix
// (mass_matrix.hpp); S is the smoothing; walls enter through the ghosts. A is never built as a matrix.
//
// For a uniform chi_0 without magnetization the operator falls apart. In the modes of mesh_modes.hpp
// E_x has U_k(x) V_l(z), E_y has V_k V_l, E_z has V_k U_l; curl curl and S act on each mode alone:
//
//     | 1 + w^2 chi_x + k_z^2      - k_x k_z        |  e_x
//     |     - k_x k_z          1 + w^2 chi_z + k_x^2 |  e_z       (1 + w^2 chi_y + k_x^2 + k_z^2) e_y
//
// with k = a sigma and w the smoothing factor of the mode; with the mass matrix w^2 also has what the
// products of its splines make of the mode. So the inverse is: to modes by four small matrix products,
// 2 x 2 and 1 x 1 solves, and back. Where a uniform magnetization turns a doubly periodic plasma, 3 x 3 solves
// of pairs of modes take the place of these (mode_inverse.hpp).
#pragma once

#include <array>
#include <string>

#include "common/gmres.hpp"
#include "common/newton_krylov.hpp"
#include "implicit_moment/apply_mass_matrix.hpp"
#include "implicit_moment/mode_inverse.hpp"
#include "implicit_moment/predict_current.hpp"

namespace implicit_moment {

/// How the field equations are solved.
struct FieldSettings {
    std::string response = "moments";    // or "mass_matrix": the current that E drives
    std::string rotation = "particles";  // or "mesh": what R of [IMM-12] turns, with moments
    std::string B_level =
        "by_response";             // or "start", "middle": time of the B that rotates particles
    std::string solver = "gmres";  // or "newton_krylov"
    double theta = 0.5;            // time level of E
    double tolerance = 0;          // residual over right-hand side; 0: what the response needs
    long max_iterations = 200;
    SmoothingSettings smoothing;

    bool uses_mass_matrix() const { return response == "mass_matrix"; }
    // A plasma that moves needs it: with B^n the particles' own current drives transverse waves, at a rate of
    // half of omega_p V/c, which no energy forbids.
    bool rotates_in_the_middle() const {
        return B_level == "middle" || (B_level == "by_response" && uses_mass_matrix());
    }
    bool rotates_on_mesh() const { return rotation == "mesh"; }
    // With the mass matrix the energy is as exact as the solution.
    double solved_to() const {
        return tolerance > 0 ? tolerance : uses_mass_matrix() ? 1e-12 : 1e-8;
    }
};

/// The room in which the field equations are solved: nothing of it is state, or is read before it is
/// written in the same step.
struct FieldSolver {
    Grid grid;
    FieldSettings settings;
    MeshModes modes;
    PlasmaResponse response;  // of the moments
    MassMatrix mass;          // of the particles themselves, where the case asks for it
    Field gauss, scratch;
    VectorField source, ghosted, curl_E, chi_E;
    std::array<Eigen::MatrixXf, 3> amplitude, unknowns;
    std::array<Eigen::MatrixXf, 6> half_way;
    Eigen::MatrixXf U_x, V_x, U_z, V_z;        // the modes again, for the preconditioner
    Eigen::VectorXd smoothing_x, smoothing_z;  // what smoothing does to each mode
    ModeInverse inverse;
    Eigen::ArrayXXf solved_x;
    common::GmresWorkspace krylov;
    common::NewtonWorkspace newton;

    FieldSolver(const Grid& g, const FieldSettings& s)
        : grid(g),
          settings(s),
          modes(g),
          response(g),
          mass(g),
          gauss(Field::Zero(g.size())),
          scratch(Field::Zero(g.size())),
          source(g),
          ghosted(g),
          curl_E(g),
          chi_E(g) {
        const auto factors = [&](const AxisModes& axis) {
            return axis.angle.unaryExpr(
                [&](double angle) { return smoothing_factor(s.smoothing, angle); });
        };
        U_x = modes.x.U.cast<float>(), V_x = modes.x.V.cast<float>();
        U_z = modes.z.U.cast<float>(), V_z = modes.z.V.cast<float>();
        smoothing_x = factors(modes.x);
        smoothing_z = factors(modes.z);
    }
};

/// out = (1 + S chi S) E + a^2 curl curl E on the unknowns of E, zero elsewhere.
/// in:     a = c theta dt; E, any values where no unknowns are; solver.response.chi or solver.mass.
/// note:   particles feel the smoothed field and their current is smoothed; with chi between the
///         same two smoothings the predicted current does the work that the particles receive.
inline void apply_field_operator(FieldSolver& solver, double a, const Eigen::VectorXd& E,
                                 Eigen::VectorXd& out) {
    const Grid& grid = solver.grid;
    const SmoothingSettings& smoothing = solver.settings.smoothing;
    VectorField &ghosted = solver.ghosted, &curl_E = solver.curl_E, &chi_E = solver.chi_E;
    ghosted.all = E;
    fill_ghosts(grid, electric, ghosted);
    curl_of_electric(grid, ghosted.all.data(), curl_E.all.data());
    fill_ghosts(grid, magnetic, curl_E);
    curl_of_magnetic(grid, curl_E.all.data(), out.data());
    if (mirrors_plasma(grid)) fill_ghosts(grid, felt(grid), ghosted);
    smooth(grid, felt(grid), smoothing, ghosted.all.data(), solver.scratch);
    if (solver.settings.uses_mass_matrix()) {
        apply_mass_matrix(grid, solver.mass, ghosted.all.data(), chi_E.all.data());
        chi_E.all *= 4 * pi * a / c;
    } else {
        apply_tensor(grid, solver.response.chi, ghosted.all.data(), false, solver.response.scratch,
                     chi_E.all.data());
        fill_ghosts(grid, felt(grid), chi_E);
    }
    smooth(grid, felt(grid), smoothing, chi_E.all.data(), solver.scratch);
    out = E + chi_E.all + a * a * out;
    keep_unknowns(grid, out.data());
}

/// Finds the inverse of the header's matrices for the mean of chi.
/// out:    solver.inverse, for precondition_field.
/// note:   the number of iterations then does not grow with omega_p dt in a uniform plasma, and with Omega_c dt in
///         one without walls; otherwise it is bounded by the contrasts of density and magnetization.
inline void prepare_preconditioner(FieldSolver& solver, double a) {
    const Grid& grid = solver.grid;
    Eigen::Matrix3d chi;
    const bool has_mass = solver.settings.uses_mass_matrix();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            chi(i, j) =
                has_mass ? 4 * pi * a / c * mean_response(grid, solver.mass, 3 * i + j)
                         : interior(grid, solver.response.chi.entry[std::size_t(3 * i + j)].data())
                               .mean();
    const Eigen::Vector3d chi_0 = chi.diagonal();
    // What the overlap of splines makes of a mode, by the place of a component.
    const auto half = [&](double angle) { return has_mass ? linear_overlap(angle) : 1; };
    const auto whole = [&](double angle) { return has_mass ? quadratic_overlap(angle) : 1; };
    ModeInverse& inverse = solver.inverse;
    for (Eigen::ArrayXXf* f : {&inverse.xx, &inverse.xz, &inverse.zz, &inverse.yy})
        f->resize(grid.x.cells, grid.z.cells);
    for (long l = 0; l < grid.z.cells; ++l) {
        const double k_z = a * solver.modes.z.sigma[l];
        for (long k = 0; k < grid.x.cells; ++k) {
            const double k_x = a * solver.modes.x.sigma[k];
            const double x = solver.modes.x.angle[k], z = solver.modes.z.angle[l];
            const double w = solver.smoothing_x[k] * solver.smoothing_z[l];
            const double xx = 1 + w * w * chi_0[0] * half(x) * whole(z) + k_z * k_z;
            const double zz = 1 + w * w * chi_0[2] * whole(x) * half(z) + k_x * k_x;
            const double yy = 1 + w * w * chi_0[1] * whole(x) * whole(z) + k_x * k_x + k_z * k_z;
            const double determinant = xx * zz - k_x * k_x * k_z * k_z;
            inverse.xx(k, l) = float(zz / determinant);
            inverse.xz(k, l) = float(k_x * k_z / determinant);
            inverse.zz(k, l) = float(xx / determinant);
            inverse.yy(k, l) = float(1 / yy);
        }
    }
    const Eigen::Matrix3d turn = chi - chi_0.asDiagonal().toDenseMatrix();
    inverse.turns =
        grid.x.periodic && grid.z.periodic && turn.cwiseAbs().maxCoeff() > 0.01 * chi_0.maxCoeff();
    if (!inverse.turns) return;
    const auto between = [&](double angle) {
        return has_mass ? mixed_overlap(angle) : std::cos(0.5 * angle);
    };
    find_wave_inverses(
        grid,
        [&](long k, long l) {
            const double k_x = a * solver.modes.x.sigma[k], k_z = a * solver.modes.z.sigma[l];
            const double x = solver.modes.x.angle[k], z = solver.modes.z.angle[l],
                         w = solver.smoothing_x[k] * solver.smoothing_z[l];
            const double g_xy = between(x) * whole(z), g_yz = whole(x) * between(z),
                         g_xz = between(x) * between(z);
            Eigen::Matrix3d g;
            g << half(x) * whole(z), g_xy, g_xz, g_xy, whole(x) * whole(z), g_yz, g_xz, g_yz,
                whole(x) * half(z);
            Eigen::Matrix3d M = w * w * g.cwiseProduct(chi);
            M.diagonal() +=
                Eigen::Vector3d(1 + k_z * k_z, 1 + k_x * k_x + k_z * k_z, 1 + k_x * k_x);
            return std::pair(M, k_x * k_z);
        },
        inverse);
}

/// out = the inverse of the operator with uniform chi_0, applied to r: the preconditioner.
/// in:     solver.inverse, of prepare_preconditioner; r on the unknowns of E.
/// exact:  to single precision, which flexible GMRES takes without losing the double one of its
///         solution.
inline void precondition_field(FieldSolver& solver, const Eigen::VectorXd& r,
                               Eigen::VectorXd& out) {
    const Grid& grid = solver.grid;
    const long m = grid.size(), nx = grid.x.cells, nz = grid.z.cells;
    // The modes of each component, along x and along z, by its place on the mesh.
    const std::array<const Eigen::MatrixXf*, 3> X{&solver.U_x, &solver.V_x, &solver.V_x};
    const std::array<const Eigen::MatrixXf*, 3> Z{&solver.V_z, &solver.V_z, &solver.U_z};
    // Calls work(component, half, first, columns) for both halves of every component: work for two threads.
    const auto for_each_half = [&](const auto& work) {
        common::for_each_row(
            6,
            [&](long task) {
                const long first = task % 2 * (nz / 2),
                           columns = task % 2 == 0 ? nz / 2 : nz - nz / 2;
                work(task / 2, task, first, columns);
            },
            numbers_to_share(grid));
    };
    for (std::size_t k = 0; k < 3; ++k) {
        solver.unknowns[k] = interior(grid, r.data() + k * m).cast<float>();
        solver.amplitude[k].resize(nx, nz);
    }
    for_each_half([&](long k, long half, long first, long columns) {
        solver.half_way[half].noalias() = solver.unknowns[k] * Z[k]->middleCols(first, columns);
        solver.amplitude[k].middleCols(first, columns).noalias() =
            X[k]->transpose() * solver.half_way[half];
    });

    // Solve every mode alone.
    auto &e_x = solver.amplitude[0], &e_y = solver.amplitude[1], &e_z = solver.amplitude[2];
    const ModeInverse& inverse = solver.inverse;
    if (inverse.turns) {
        solve_waves(grid, inverse, solver.amplitude);
    } else {
        e_y.array() *= inverse.yy;
        solver.solved_x = inverse.xx * e_x.array() + inverse.xz * e_z.array();
        e_z.array() = inverse.xz * e_x.array() + inverse.zz * e_z.array();
        e_x.array() = solver.solved_x;
    }

    // Go back to the mesh.
    out.resize(r.size());
    for_each_half([&](long k, long half, long first, long columns) {
        solver.half_way[half].noalias() =
            solver.amplitude[k] * Z[k]->middleRows(first, columns).transpose();
        solver.unknowns[k].middleCols(first, columns).noalias() = *X[k] * solver.half_way[half];
    });
    for (std::size_t k = 0; k < 3; ++k)
        interior(grid, out.data() + k * m) = solver.unknowns[k].cast<double>();
    keep_unknowns(grid, out.data());
}

}  // namespace implicit_moment
