// on the grid: what the fluid equations say about the current of the coming step.
// [IMM-11, IMM-12]
//
// Eliminating J^{n+1} from the slide's momentum equation leaves, for every species, with O = q dt
// B / (2 m c),
//
//     J^{n+1/2} = R [ J^n - dt/2 div P^n + (q dt / 2m) rho^n E^{n+theta} ],      R(v) = [ v + v x
//     O + (v . O) O ] / (1 + O^2)
//
// Summed over species this is  J^{n+1/2} = J_hat + chi E^{n+theta} / (4 pi theta dt)  with the
// implicit susceptibility
//
//     chi = sum_s theta/2 (omega_ps dt)^2 R_s,      omega_ps^2 = 4 pi rho_s q_s/m_s.
#pragma once

#include <vector>

#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/smooth.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// A 3 x 3 tensor per point that takes a vector on the places of E to a vector on the places of
/// E. Row a is stored where component a lives. The diagonal acts in place; the other components
/// are averaged to the row's place.
struct Tensor {
    std::array<Field, 9> entry;  // xx xy xz  yx yy yz  zx zy zz
    explicit Tensor(const Grid& grid) {
        for (Field& f : entry) f = Field::Zero(grid.size());
    }
};

/// out = T v. in: v, ghosts filled. out: values on rows and columns 0..N, added to what is there
/// when `add` is set.
inline void apply_tensor(const Grid& grid, const Tensor& T, const double* v, bool add,
                         double* out) {
    const long s = grid.stride(), m = grid.size();
    const double *v_x = v, *v_y = v + m, *v_z = v + 2 * m;
    double *x = out, *y = out + m, *z = out + 2 * m;
    std::array<const double*, 9> t{};
    for (std::size_t k = 0; k < 9; ++k) t[k] = T.entry[k].data();
    const double keep = add ? 1 : 0;
    for_each_point(grid, [=](long n) {
        x[n] = keep * x[n] + t[0][n] * v_x[n] + t[1][n] * 0.5 * (v_y[n] + v_y[n + 1]) +
               t[2][n] * 0.25 * (v_z[n] + v_z[n + 1] + v_z[n - s] + v_z[n + 1 - s]);
    });
    for_each_point(grid, [=](long n) {
        y[n] = keep * y[n] + t[3][n] * 0.5 * (v_x[n] + v_x[n - 1]) + t[4][n] * v_y[n] +
               t[5][n] * 0.5 * (v_z[n] + v_z[n - s]);
    });
    for_each_point(grid, [=](long n) {
        z[n] = keep * z[n] + t[6][n] * 0.25 * (v_x[n] + v_x[n - 1] + v_x[n + s] + v_x[n - 1 + s]) +
               t[7][n] * 0.5 * (v_y[n] + v_y[n + s]) + t[8][n] * v_z[n];
    });
}

/// The rotation R of one species at the three places of E.
/// in: B, ghosts filled; half_kick = q dt / 2m.   exact: R v - (R v) x O = v at any point, and v
///        . R v >= 0.   source: [IMM-12]
inline void rotation_tensor(const Grid& grid, const double* B, double half_kick, Tensor& R) {
    const long s = grid.stride(), m = grid.size();
    const double *B_x = B, *B_y = B + m, *B_z = B + 2 * m;
    const double k = half_kick / c;
    std::array<double*, 9> r{};
    for (std::size_t a = 0; a < 9; ++a) r[a] = R.entry[a].data();
    for_each_point(grid, [=](long n) {
        const double x = 0.25 * k * (B_x[n] + B_x[n + 1] + B_x[n - s] + B_x[n + 1 - s]);
        const double y = 0.5 * k * (B_y[n] + B_y[n - s]);
        const double z = k * B_z[n];
        const double scale = 1 / (1 + x * x + y * y + z * z);
        r[0][n] = scale * (1 + x * x);
        r[1][n] = scale * (x * y + z);
        r[2][n] = scale * (x * z - y);
    });
    for_each_point(grid, [=](long n) {
        const double x = 0.5 * k * (B_x[n] + B_x[n - s]);
        const double y = 0.25 * k * (B_y[n] + B_y[n - 1] + B_y[n - s] + B_y[n - 1 - s]);
        const double z = 0.5 * k * (B_z[n] + B_z[n - 1]);
        const double scale = 1 / (1 + x * x + y * y + z * z);
        r[3][n] = scale * (y * x - z);
        r[4][n] = scale * (1 + y * y);
        r[5][n] = scale * (y * z + x);
    });
    for_each_point(grid, [=](long n) {
        const double x = k * B_x[n];
        const double y = 0.5 * k * (B_y[n] + B_y[n - 1]);
        const double z = 0.25 * k * (B_z[n] + B_z[n - 1] + B_z[n + s] + B_z[n - 1 + s]);
        const double scale = 1 / (1 + x * x + y * y + z * z);
        r[6][n] = scale * (z * x + y);
        r[7][n] = scale * (z * y - x);
        r[8][n] = scale * (1 + z * z);
    });
}

/// J^n - dt/2 div P^n of one species on the places of E, ghosts filled: the current half a step
/// later without any field.
/// exact: d rho/dt = -div of it to second order in dt for particles in free flight.   source:
///        [IMM-11, IMM-12]
inline void free_current(const Grid& grid, const Moments& moments, double dt, VectorField& J) {
    const long s = grid.stride();
    const double by_dx = 0.5 * dt / grid.x.spacing(), by_dz = 0.5 * dt / grid.z.spacing();
    const double *J_x = moments.J_x.data(), *J_y = moments.J_y.data(), *J_z = moments.J_z.data();
    const double *P_xx = moments.P_xx.data(), *P_xy = moments.P_xy.data(),
                 *P_xz = moments.P_xz.data(), *P_yz = moments.P_yz.data(),
                 *P_zz = moments.P_zz.data();
    double *x = J.x(), *y = J.y(), *z = J.z();
    for_each_point(grid, [=](long n) {
        x[n] = J_x[n] - by_dx * (P_xx[n + 1] - P_xx[n]) - by_dz * (P_xz[n] - P_xz[n - s]);
        y[n] = J_y[n] - by_dx * (P_xy[n] - P_xy[n - 1]) - by_dz * (P_yz[n] - P_yz[n - s]);
        z[n] = J_z[n] - by_dx * (P_xz[n] - P_xz[n - 1]) - by_dz * (P_zz[n + s] - P_zz[n]);
    });
    fill_ghosts(grid, current, J);
}

/// What the field equations need from the plasma.
struct PlasmaResponse {
    Field rho;           // charge density, smoothed
    VectorField J_free;  // sum over species of J_hat before rotation... one species at a time
    VectorField J_hat;   // current without field, rotated, not yet smoothed
    Tensor R, chi;       // rotation of one species; susceptibility of all

    explicit PlasmaResponse(const Grid& grid)
        : rho(Field::Zero(grid.size())), J_free(grid), J_hat(grid), R(grid), chi(grid) {}
};

/// The charge, J_hat and chi of all species, with the magnetic rotation in the given B.
/// in: moments and q/m of each species; B, ghosts filled. out: response.
/// note: chi is the diagonal form of the exact response: the density that answers at a place is
///        the mean of the nodes beside it. On the first edge at a wall the odd image of the
///        current takes a quarter of the answer of a uniform plasma (S1 overlap: 7/8 - 1/8), so
///        chi_nn is 3/4 there.
inline void predict_current(const Grid& grid, const std::vector<Moments>& moments,
                            const std::vector<double>& charge_over_mass, const double* B, double dt,
                            double theta, PlasmaResponse& response) {
    const long s = grid.stride();
    response.J_hat.all.setZero();
    for (Field& f : response.chi.entry) f.setZero();
    response.rho.setZero();
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const double half_kick = 0.5 * dt * charge_over_mass[k];
        response.rho += moments[k].rho;
        free_current(grid, moments[k], dt, response.J_free);
        rotation_tensor(grid, B, half_kick, response.R);
        apply_tensor(grid, response.R, response.J_free.all.data(), true, response.J_hat.all.data());

        const double by_rho = 4 * pi * theta * dt * half_kick;
        const double* rho = moments[k].rho.data();
        for (std::size_t a = 0; a < 9; ++a) {
            const long beside = a < 3 ? 1 : a < 6 ? 0 : s;  // x-edges, nodes, z-edges
            const double* R = response.R.entry[a].data();
            double* chi = response.chi.entry[a].data();
            for_each_point(
                grid, [=](long n) { chi[n] += by_rho * 0.5 * (rho[n] + rho[n + beside]) * R[n]; });
        }
    }
    if (!grid.z.periodic) {
        for (const long j : {0L, grid.z.cells - 1}) {
            for (std::size_t a = 6; a < 9; ++a) {
                response.chi.entry[a].segment(grid.index(0, j), grid.x.cells + 1) *= 0.75;
            }
        }
    }
    if (!grid.x.periodic) {
        for (long j = 0; j <= grid.z.cells; ++j) {
            for (std::size_t a = 0; a < 3; ++a) {
                response.chi.entry[a][grid.index(0, j)] *= 0.75;
                response.chi.entry[a][grid.index(grid.x.cells - 1, j)] *= 0.75;
            }
        }
    }
    fill_ghosts(grid, current, response.J_hat);
}

}  // namespace implicit_moment
