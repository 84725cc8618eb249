// The operator of the field equations, (1 + chi) E + a^2 curl curl E, and its inverse for a uniform
// plasma, which preconditions GMRES.   [IMM-10]
#pragma once

#include <array>
#include <string>

#include "common/gmres.hpp"
#include "common/newton_krylov.hpp"
#include "implicit_moment/field_state.hpp"
#include "implicit_moment/mesh_modes.hpp"
#include "implicit_moment/predict_current.hpp"

namespace implicit_moment {

struct FieldSettings {
    std::string solver = "gmres";
    double theta = 0.5;
    double tolerance = 1e-8;
    long max_iterations = 200;
    SmoothingSettings smoothing;
};

/// The inverse of the uniform field operator for every mode: 2 x 2 in the plane, one number for y.
struct ModeInverse {
    Eigen::ArrayXXf xx, xz, zz, yy;
};

/// The room in which the field equations are solved, kept between steps: nothing of it is state, and
/// nothing of it is read before it is written in the same step.
struct FieldSolver {
    Grid grid;
    FieldSettings settings;
    MeshModes modes;
    PlasmaResponse response;
    Field gauss, scratch;
    VectorField source, ghosted, curl_E, chi_E;
    std::array<Eigen::MatrixXf, 3> amplitude, unknowns;
    std::array<Eigen::MatrixXf, 6> half_way;
    Eigen::MatrixXf U_x, V_x, U_z, V_z;        // the modes again, for the preconditioner
    Eigen::VectorXd smoothing_x, smoothing_z;  // what smoothing does to each mode
    ModeInverse inverse;
    Eigen::ArrayXXf rotated;
    common::GmresWorkspace krylov;
    common::NewtonWorkspace newton;

    FieldSolver(const Grid& g, const FieldSettings& s)
        : grid(g),
          settings(s),
          modes(g),
          response(g),
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

/// out = (1 + chi) E + a^2 curl curl E on the unknowns of E, zero elsewhere, with chi between two
/// smoothings: S chi S.
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
    smooth(grid, electric, smoothing, ghosted.all.data(), solver.scratch);
    apply_tensor(grid, solver.response.chi, ghosted.all.data(), false, solver.response.scratch,
                 chi_E.all.data());
    fill_ghosts(grid, electric, chi_E);
    smooth(grid, electric, smoothing, chi_E.all.data(), solver.scratch);
    out = E + chi_E.all + a * a * out;
    keep_unknowns(grid, out.data());
}

/// Inverts the operator with a uniform diagonal chi_0, the mean of chi, mode by mode.
/// note:   the number of iterations then does not grow with omega_p dt in a uniform plasma, and is
///         bounded by the contrasts of density and magnetization otherwise.
inline void prepare_preconditioner(FieldSolver& solver, double a) {
    const Grid& grid = solver.grid;
    std::array<double, 3> chi_0{};
    for (std::size_t k = 0; k < 3; ++k) {
        chi_0[k] = interior(grid, solver.response.chi.entry[4 * k].data()).mean();
    }
    ModeInverse& inverse = solver.inverse;
    for (Eigen::ArrayXXf* f : {&inverse.xx, &inverse.xz, &inverse.zz, &inverse.yy}) {
        f->resize(grid.x.cells, grid.z.cells);
    }
    for (long l = 0; l < grid.z.cells; ++l) {
        const double k_z = a * solver.modes.z.sigma[l];
        for (long k = 0; k < grid.x.cells; ++k) {
            const double k_x = a * solver.modes.x.sigma[k];
            const double w = solver.smoothing_x[k] * solver.smoothing_z[l];
            const double xx = 1 + w * w * chi_0[0] + k_z * k_z;
            const double zz = 1 + w * w * chi_0[2] + k_x * k_x;
            const double yy = 1 + w * w * chi_0[1] + k_x * k_x + k_z * k_z;
            const double determinant = xx * zz - k_x * k_x * k_z * k_z;
            inverse.xx(k, l) = static_cast<float>(zz / determinant);
            inverse.xz(k, l) = static_cast<float>(k_x * k_z / determinant);
            inverse.zz(k, l) = static_cast<float>(xx / determinant);
            inverse.yy(k, l) = static_cast<float>(1 / yy);
        }
    }
}

/// out = [ 1 + w^2 chi_0 + a^2 curl curl ]^{-1} r for a uniform diagonal chi_0, w the smoothing
/// factor of each mode.
/// exact:  to single precision, which flexible GMRES takes without losing the double one of its
///         solution.
/// in:     what prepare_preconditioner has prepared.
inline void precondition_field(FieldSolver& solver, const Eigen::VectorXd& r,
                               Eigen::VectorXd& out) {
    const Grid& grid = solver.grid;
    const long m = grid.size();
    // The modes of each component, along x and along z, by its place on the mesh.
    const std::array<const Eigen::MatrixXf*, 3> X{&solver.U_x, &solver.V_x, &solver.V_x};
    const std::array<const Eigen::MatrixXf*, 3> Z{&solver.V_z, &solver.V_z, &solver.U_z};
    const long nx = grid.x.cells, nz = grid.z.cells;
    for (std::size_t k = 0; k < 3; ++k) {
        solver.unknowns[k] = interior(grid, r.data() + static_cast<long>(k) * m).cast<float>();
        solver.amplitude[k].resize(nx, nz);
    }
    common::for_each_row(6, [&](long task) {
        const auto k = static_cast<std::size_t>(task / 2), t = static_cast<std::size_t>(task);
        const long first = task % 2 * (nz / 2), columns = task % 2 == 0 ? nz / 2 : nz - nz / 2;
        solver.half_way[t].noalias() = solver.unknowns[k] * Z[k]->middleCols(first, columns);
        solver.amplitude[k].middleCols(first, columns).noalias() =
            X[k]->transpose() * solver.half_way[t];
    });

    // Every mode alone.
    auto &e_x = solver.amplitude[0], &e_y = solver.amplitude[1], &e_z = solver.amplitude[2];
    const ModeInverse& inverse = solver.inverse;
    e_y.array() *= inverse.yy;
    solver.rotated = inverse.xx * e_x.array() + inverse.xz * e_z.array();
    e_z.array() = inverse.xz * e_x.array() + inverse.zz * e_z.array();
    e_x.array() = solver.rotated;

    // Back to the mesh.
    out.resize(r.size());
    common::for_each_row(6, [&](long task) {
        const auto k = static_cast<std::size_t>(task / 2), t = static_cast<std::size_t>(task);
        const long first = task % 2 * (nz / 2), columns = task % 2 == 0 ? nz / 2 : nz - nz / 2;
        solver.half_way[t].noalias() =
            solver.amplitude[k] * Z[k]->middleRows(first, columns).transpose();
        solver.unknowns[k].middleCols(first, columns).noalias() = *X[k] * solver.half_way[t];
    });
    for (std::size_t k = 0; k < 3; ++k) {
        interior(grid, out.data() + static_cast<long>(k) * m) = solver.unknowns[k].cast<double>();
    }
    keep_unknowns(grid, out.data());
}

}  // namespace implicit_moment
