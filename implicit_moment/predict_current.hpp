// on the grid: what the fluid equations say about the current of the coming step.
// [IMM-11, IMM-12]
//
// Eliminating J^{n+1} from the slide's momentum equation leaves, for every species, with
// O = q dt B / (2 m c),
//
//     J^{n+1/2} = R [ J^n - dt/2 div P^n + (q dt / 2m) rho^n E^{n+theta} ],
//     R(v) = [ v + v x O + (v . O) O ] / (1 + O^2)
//
// Summed over species this is  J^{n+1/2} = J_hat + chi E^{n+theta} / (4 pi theta dt)  with the
// implicit susceptibility
//
//     chi = sum_s theta/2 (omega_ps dt)^2 R_s,      omega_ps^2 = 4 pi rho_s q_s/m_s.
//
// where a relativistic species has sum_p (4 pi theta dt) (q^2 dt / 2m) A_p S (mean_velocity.hpp). In the part
// without E, J_hat, every particle has been rotated by itself (deposit_moments.hpp), or R
// turns J - dt/2 div P here, as the slide has it (field.rotation = "mesh").
#pragma once

#include <vector>

#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/field/smooth.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// A 3 x 3 tensor on every node, which acts on vectors that live on the places of E.
struct Tensor {
    std::array<Field, 9> entry;  // xx xy xz  yx yy yz  zx zy zz
    explicit Tensor(const Grid& grid) {
        for (Field& f : entry) f = Field::Zero(grid.size());
    }
};

/// out = T v: the diagonal acts where each component lives, with the mean of the nodes beside it;
/// the rest goes through the nodes, to which components are averaged and from which results are
/// averaged back.
/// in:     v, ghosts filled; scratch, room.
/// out:    values on rows and columns 0..N, added to what is there when `add` is set.
/// exact:  (T v) . v >= sum over nodes of (T v') . v' with v' the averaged v. A magnetic rotation
///         thus stays one on the mesh: its skew part does no work, however fast the rotation.
inline void apply_tensor(const Grid& grid, const Tensor& T, const double* v, bool add,
                         VectorField& scratch, double* out) {
    const long s = grid.stride(), m = grid.size();
    const double *v_x = v, *v_y = v + m, *v_z = v + 2 * m;
    double *x = out, *y = out + m, *z = out + 2 * m;
    double *w_x = scratch.x(), *w_z = scratch.z();
    std::array<const double*, 9> t{};
    for (std::size_t k = 0; k < 9; ++k) t[k] = T.entry[k].data();
    const double keep = add ? 1 : 0;
    for_each_point(grid, [=](long n) {
        const double mean_x = 0.5 * (v_x[n - 1] + v_x[n]), mean_z = 0.5 * (v_z[n - s] + v_z[n]);
        w_x[n] = t[1][n] * v_y[n] + t[2][n] * mean_z;
        y[n] = keep * y[n] + t[3][n] * mean_x + t[4][n] * v_y[n] + t[5][n] * mean_z;
        w_z[n] = t[6][n] * mean_x + t[7][n] * v_y[n];
    });
    for_each_point(grid, [=](long n) {
        x[n] = keep * x[n] + 0.5 * ((t[0][n] + t[0][n + 1]) * v_x[n] + w_x[n] + w_x[n + 1]);
        z[n] = keep * z[n] + 0.5 * ((t[8][n] + t[8][n + s]) * v_z[n] + w_z[n] + w_z[n + s]);
    });
}

namespace detail {

// O = q dt B / (2 m c) of one species, averaged to the nodes.
struct RotationOnNodes {
    const double *B_x, *B_y, *B_z;
    long s;    // between rows
    double k;  // q dt / 2mc

    RotationOnNodes(const Grid& grid, const double* B, double half_kick)
        : B_x(B),
          B_y(B + grid.size()),
          B_z(B + 2 * grid.size()),
          s(grid.stride()),
          k(half_kick / c) {}
    double x(long n) const { return 0.5 * k * (B_x[n] + B_x[n - s]); }
    double y(long n) const {
        return 0.25 * k * (B_y[n] + B_y[n - 1] + B_y[n - s] + B_y[n - 1 - s]);
    }
    double z(long n) const { return 0.5 * k * (B_z[n] + B_z[n - 1]); }
};

}  // namespace detail

/// The magnetic rotation R of one species on nodes.
/// in:     B, ghosts filled; half_kick = q dt / 2m.
/// out:    rows and columns 0..N.
/// exact:  R v - (R v) x O = v, and v . R v >= 0.
/// source: [IMM-12]
inline void rotation_tensor(const Grid& grid, const double* B, double half_kick, Tensor& R) {
    const detail::RotationOnNodes O(grid, B, half_kick);
    std::array<double*, 9> r{};
    for (std::size_t a = 0; a < 9; ++a) r[a] = R.entry[a].data();
    for_each_point(grid, [=](long n) {
        const auto at_node = rotation_matrix(O.x(n), O.y(n), O.z(n));
        for (std::size_t a = 0; a < 9; ++a) r[a][n] = at_node[a];
    });
}

/// Takes the rotation in another B out of R: R becomes R A with A v = v - v x O, the inverse of
/// [IMM-12] in that B.
/// exact:  in the B of R itself this leaves the unit tensor.
inline void multiply_by_inverse_rotation(const Grid& grid, const double* B, double half_kick,
                                         Tensor& R) {
    const detail::RotationOnNodes O(grid, B, half_kick);
    for (std::size_t a = 0; a < 9; a += 3) {
        double *r_x = R.entry[a].data(), *r_y = R.entry[a + 1].data(), *r_z = R.entry[a + 2].data();
        for_each_point(grid, [=](long n) {
            const double x = O.x(n), y = O.y(n), z = O.z(n);
            const double old_x = r_x[n], old_y = r_y[n], old_z = r_z[n];
            r_x[n] = old_x + old_y * z - old_z * y;
            r_y[n] = old_y + old_z * x - old_x * z;
            r_z[n] = old_z + old_x * y - old_y * x;
        });
    }
}

/// The hatted current of one species, J - dt/2 div P on the places of E, ghosts filled: its current
/// half a step later without E.
/// exact:  d rho/dt = -div of it to second order in dt for particles in free flight.
/// source: [IMM-11, IMM-12]
inline void hatted_current(const Grid& grid, const Moments& moments, double dt, VectorField& J) {
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
    fill_ghosts(grid, felt(grid), J);
}

/// What the field equations need from the plasma.
struct PlasmaResponse {
    Field rho;                     // charge density
    VectorField J_hat_of_species;  // the hatted current of one species
    VectorField J_hat;             // of all: the current without E
    Tensor R, chi;                 // rotation of one species; susceptibility of all
    VectorField scratch;

    explicit PlasmaResponse(const Grid& grid)
        : rho(Field::Zero(grid.size())),
          J_hat_of_species(grid),
          J_hat(grid),
          R(grid),
          chi(grid),
          scratch(grid) {}
};

/// The charge, J_hat and chi of all species, with the magnetic rotation in B_theta.
/// in:     moments and q/m of each species; B, in which the moments were rotated, or null where they
///         were not, and B_theta, the same field or another one; ghosts filled.
/// out:    response, nothing of it smoothed.
/// note:   chi is the diagonal form of the exact response, in which a place also answers for the
///         places whose splines overlap with its own. It is never smaller than the exact one, which
///         is what keeps the method stable, at the price of a slow loss of energy.
inline void predict_current(const Grid& grid, const std::vector<Moments>& moments,
                            const std::vector<double>& charge_over_mass, const double* B,
                            const double* B_theta, double dt, double theta,
                            PlasmaResponse& response) {
    response.J_hat.all.setZero();
    for (Field& f : response.chi.entry) f.setZero();
    response.rho.setZero();
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const double half_kick = 0.5 * dt * charge_over_mass[k];
        response.rho += moments[k].rho;
        hatted_current(grid, moments[k], dt, response.J_hat_of_species);
        if (B_theta == B) {
            response.J_hat.all += response.J_hat_of_species.all;
        } else {
            rotation_tensor(grid, B_theta, half_kick, response.R);
            if (B != nullptr) multiply_by_inverse_rotation(grid, B, half_kick, response.R);
            apply_tensor(grid, response.R, response.J_hat_of_species.all.data(), true,
                         response.scratch, response.J_hat.all.data());
        }

        // Relativistic particles have each their own answer.
        if (moments[k].response[0].size() > 0) {
            for (std::size_t a = 0; a < 9; ++a)
                response.chi.entry[a] += 4 * pi * theta * dt * moments[k].response[a];
            continue;
        }
        rotation_tensor(grid, B_theta, half_kick, response.R);
        const double by_rho = 4 * pi * theta * dt * half_kick;
        const double* rho = moments[k].plasma_density.data();
        for (std::size_t a = 0; a < 9; ++a) {
            const double* R = response.R.entry[a].data();
            double* chi = response.chi.entry[a].data();
            for_each_point(grid, [=](long n) { chi[n] += by_rho * rho[n] * R[n]; });
        }
    }
    fill_ghosts(grid, felt(grid), response.J_hat);
}

}  // namespace implicit_moment
