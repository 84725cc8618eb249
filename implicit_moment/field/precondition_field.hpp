// The inverse of the field equations of a uniform plasma, wave by wave, which preconditions GMRES.
//
// A wave e^{i k x} of E, counted from where each component lives, has real equations,
//
//     [ 1 + a^2 (K^2 - K K^T) + w^2 chi_ab g_ab(k) ] e,     K = (2/dx) sin(k dx/2),
//
// with w of the smoothing, chi the mean susceptibility with its rotation, and g_ab of what lies between the
// places of components a and b: averages, or with the mass matrix the overlap of its splines. So the
// inverse is: to waves (waves.hpp), 3 x 3 products, and back. Between walls the averages in the rotation do not
// have the parities of the waves, and chi is taken without it.
#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "implicit_moment/field/field_operator.hpp"

namespace implicit_moment {

/// Finds the inverse of the header's matrices for the mean of chi.
/// in:     a = c theta dt; solver.response.chi or solver.mass
/// out:    solver.inverse, for precondition_field.
/// note:   the number of iterations then does not grow with omega_p dt in a uniform plasma, and with Omega_c dt in
///         one without walls; otherwise it is bounded by the contrasts of density and magnetization.
inline void prepare_preconditioner(FieldSolver& solver, double a) {
    const Grid& grid = solver.grid;
    const bool has_mass = solver.settings.uses_mass_matrix();
    Eigen::Matrix3d chi;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            chi(i, j) =
                has_mass ? 4 * pi * a / c * mean_response(grid, solver.mass, 3 * i + j)
                         : interior(grid, solver.response.chi.entry[std::size_t(3 * i + j)].data())
                               .mean();
    if (!grid.x.periodic || !grid.z.periodic) chi = chi.diagonal().asDiagonal().toDenseMatrix();

    // What lies between the places of two components along one direction, both on nodes, both on midpoints, or
    // one on either; and what smoothing does.
    struct Along {
        double K, whole, half, between, w;
    };
    const auto along = [&](const AxisWaves& axis) {
        std::vector<Along> waves;
        for (std::size_t n = 0; n < axis.K.size(); ++n) {
            const double angle = axis.angle[n],
                         w = smoothing_factor(solver.settings.smoothing, angle);
            waves.push_back(has_mass ? Along{a * axis.K[n], quadratic_overlap(angle),
                                             linear_overlap(angle), mixed_overlap(angle), w}
                                     : Along{a * axis.K[n], 1, 1, std::cos(0.5 * angle), w});
        }
        return waves;
    };
    const std::vector<Along> of_x = along(solver.field_waves.x), of_z = along(solver.field_waves.z);
    const long columns = solver.field_waves.columns();
    for (std::vector<float>& entry : solver.inverse)
        entry.resize(std::size_t(solver.field_waves.rows() * columns));
    for (std::vector<float>& part : solver.half_z) part.clear();
    for (const double angle : solver.field_waves.z.angle) {
        solver.half_z[0].push_back(float(std::cos(0.5 * angle)));
        solver.half_z[1].push_back(float(-std::sin(0.5 * angle)));
    }
    common::for_each_row(
        solver.field_waves.rows(),
        [&](long p) {
            const Along& x = of_x[std::size_t(p)];
            for (long q = 0; q < columns; ++q) {
                const Along& z = of_z[std::size_t(q)];
                const double w2 = x.w * x.w * z.w * z.w;
                Eigen::Matrix3d M;
                M << x.half * z.whole, x.between * z.whole, x.between * z.between,
                    x.between * z.whole, x.whole * z.whole, x.whole * z.between,
                    x.between * z.between, x.whole * z.between, x.whole * z.half;
                M = (w2 * M.cwiseProduct(chi)).eval();
                M.diagonal() +=
                    Eigen::Vector3d(1 + z.K * z.K, 1 + x.K * x.K + z.K * z.K, 1 + x.K * x.K);
                M(0, 2) -= x.K * z.K, M(2, 0) -= x.K * z.K;
                const Eigen::Matrix3f inverse = M.inverse().cast<float>();
                for (int k = 0; k < 9; ++k)
                    solver.inverse[std::size_t(k)][std::size_t(p * columns + q)] =
                        inverse(k / 3, k % 3);
            }
        },
        grid.size());
}

/// out = the inverse of the operator with uniform chi, applied to r: the preconditioner.
/// in:     solver.inverse, of prepare_preconditioner; r on the unknowns of E.
/// exact:  to single precision, which flexible GMRES takes without losing the double one of its
///         solution.
inline void precondition_field(FieldSolver& solver, const Eigen::VectorXd& r,
                               Eigen::VectorXd& out) {
    const Grid& grid = solver.grid;
    const long m = grid.size(), columns = solver.field_waves.columns();
    out.resize(r.size());
    const auto part = [&](std::size_t k) {
        return WaveComponent{r.data() + long(k) * m, out.data() + long(k) * m, electric.place[k]};
    };
    solver.field_waves.apply({part(0), part(1), part(2)}, [&](long p, const FieldWaves::Row& e) {
        const double angle = solver.field_waves.x.angle[std::size_t(p)];
        const float c_x = float(std::cos(0.5 * angle)), s_x = float(-std::sin(0.5 * angle));
        std::array<const float*, 9> inverse;
        for (std::size_t k = 0; k < 9; ++k)
            inverse[k] = &solver.inverse[k][std::size_t(p * columns)];
        const float *c_z = solver.half_z[0].data(), *s_z = solver.half_z[1].data();
        float *e_x = e[0], *e_y = e[1], *e_z = e[2];
#pragma omp simd
        for (long q = 0; q < columns; ++q) {
            const float x_re = c_x * e_x[2 * q] - s_x * e_x[2 * q + 1],
                        x_im = c_x * e_x[2 * q + 1] + s_x * e_x[2 * q], y_re = e_y[2 * q],
                        y_im = e_y[2 * q + 1], z_re = c_z[q] * e_z[2 * q] - s_z[q] * e_z[2 * q + 1],
                        z_im = c_z[q] * e_z[2 * q + 1] + s_z[q] * e_z[2 * q];
            const auto row = [&](std::size_t k, float x, float y, float z) {
                return inverse[k][q] * x + inverse[k + 1][q] * y + inverse[k + 2][q] * z;
            };
            const float to_x_re = row(0, x_re, y_re, z_re), to_x_im = row(0, x_im, y_im, z_im),
                        to_z_re = row(6, x_re, y_re, z_re), to_z_im = row(6, x_im, y_im, z_im);
            e_x[2 * q] = c_x * to_x_re + s_x * to_x_im;
            e_x[2 * q + 1] = c_x * to_x_im - s_x * to_x_re;
            e_y[2 * q] = row(3, x_re, y_re, z_re), e_y[2 * q + 1] = row(3, x_im, y_im, z_im);
            e_z[2 * q] = c_z[q] * to_z_re + s_z[q] * to_z_im;
            e_z[2 * q + 1] = c_z[q] * to_z_im - s_z[q] * to_z_re;
        }
    });
    keep_unknowns(grid, out.data());
}

}  // namespace implicit_moment
