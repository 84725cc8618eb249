// The force between two clouds, averaged over where on the mesh the pair is: what is left of
// Coulomb's law when both charges are clouds and the field lives on nodes.
//
// Cloud 1 at x_1 gives each node the charge q_1 S(x_g - x_1), cloud 2 at x_1 + r feels the field of
// each node with the weight S(x_g - x_1 - r). In Fourier space every wave k of the mesh is then a
// sum over the aliases p of the deposit and over those of the gather, k_p = k + 2 pi p / dx in each
// direction. Averaging over x_1 keeps the terms where both are the same,
//     F(r) = q_1 q_2 / A  sum_(k /= 0) (-i kappa / K^2) sum_p S(k_p)^2 exp(i k_p r)
//     K^2 = K_x^2 + K_z^2,  K_x = (2 / dx) sin(k_x dx / 2),  kappa_x = sin(k_x dx) / dx
// with A the area of the periodic box. The sum over p needs no end: S^(l)(k)^2 is the transform of
// S^(l) convolved with itself, which is the spline S^(2l+1), so that by Poisson's sum formula
//     sum_p S(k_p)^2 exp(i k_p r) = sum_g S^(2l+1)(r - x_g) exp(i k x_g)
// Hence: the mean force is the field of one unit charge on one node, interpolated between the nodes
// with the product of two splines of order 2l+1. That is 1 for ngp, 3 for cic, 5 for tsc.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cic/theory/comparison.hpp"
#include "common/grid.hpp"
#include "common/splines.hpp"
#include "common/theory/measure_modes.hpp"

namespace cic {

/// Two clouds of the same shape on a periodic mesh, of unit charge each, with a uniform background
/// that makes the box neutral; momentum-conserving scheme.
struct CloudPair {
    common::Axis x, z;
    int order = 1;        // of the weights S: 0 ngp, 1 cic, 2 tsc
    Eigen::MatrixXd phi;  // on node (i, j), of a unit charge on node (0, 0), eps0 = 1
};

namespace detail {

/// S^(order) of any order, by the recurrence of B-splines.
///   order S^(l)(s) = (h + s) S^(l-1)(s + 1/2) + (h - s) S^(l-1)(s - 1/2),  h = (order + 1) / 2
inline double spline(int order, double s) {
    if (order <= 3) return common::spline(order, s);
    const double h = 0.5 * (order + 1);
    return ((h + s) * spline(order - 1, s + 0.5) + (h - s) * spline(order - 1, s - 0.5)) / order;
}

/// The same, or its derivative (at a kink, from the right).
inline double spline(int order, double s, bool derivative) {
    if (!derivative) return spline(order, s);
    return spline(order - 1, s + 0.5) - spline(order - 1, s - 0.5);
}

/// cos(k x_i) for all nodes i and all waves k of an axis, and K^2 of the waves.
struct Waves {
    Eigen::MatrixXd cosine;
    Eigen::VectorXd K_squared;

    explicit Waves(const common::Axis& axis)
        : cosine(axis.cells, axis.cells), K_squared(axis.cells) {
        const long n = axis.cells;
        const double angle = 2.0 * std::numbers::pi / double(n);
        for (long m = 0; m < n; ++m) {
            const double K = 2.0 / axis.spacing() * std::sin(0.5 * angle * double(m));
            K_squared[m] = K * K;
            for (long i = 0; i < n; ++i) cosine(i, m) = std::cos(angle * double(i * m % n));
        }
    }
};

/// phi between the nodes, or one of its derivatives.
///   Phi(r) = sum_g S^(2l+1)(r - x_g) phi_g
inline double potential(const CloudPair& pair, double r_x, double r_z, bool derivative_x = false,
                        bool derivative_z = false) {
    const int order = 2 * pair.order + 1;
    const double s_x = r_x / pair.x.spacing(), s_z = r_z / pair.z.spacing();
    const long at_x = std::lround(std::floor(s_x)), at_z = std::lround(std::floor(s_z));
    const auto wrap = [](long i, long n) { return (i % n + n) % n; };
    double sum = 0.0;
    for (long j = at_z - pair.order; j <= at_z + pair.order + 1; ++j) {
        double row = 0.0;
        for (long i = at_x - pair.order; i <= at_x + pair.order + 1; ++i)
            row += spline(order, s_x - double(i), derivative_x) *
                   pair.phi(wrap(i, pair.x.cells), wrap(j, pair.z.cells));
        sum += row * spline(order, s_z - double(j), derivative_z);
    }
    if (derivative_x) sum /= pair.x.spacing();
    if (derivative_z) sum /= pair.z.spacing();
    return sum;
}

}  // namespace detail

/// The potential of one node, from which all forces follow.
///   K^2 phi_k = rho_k, the five-point Laplacian;  phi_(k = 0) = 0
/// in:     both axes periodic; one cell across makes the clouds sheets
/// note:   two small matrix products; with a few hundred cells per direction that is no work.
inline CloudPair make_cloud_pair(const common::Axis& x, const common::Axis& z, int order) {
    const detail::Waves along_x(x), along_z(z);
    Eigen::MatrixXd phi_k(x.cells, z.cells);
    for (long n = 0; n < z.cells; ++n)
        for (long m = 0; m < x.cells; ++m)
            phi_k(m, n) =
                m == 0 && n == 0
                    ? 0.0
                    : 1.0 / ((along_x.K_squared[m] + along_z.K_squared[n]) * x.length * z.length);
    return {x, z, order, along_x.cosine * phi_k * along_z.cosine.transpose()};
}

/// How fast the force rises when two clouds are pulled apart from r = 0.
/// out:    (dF_x/dr_x, dF_z/dr_z) at r = 0, per q_1 q_2; by symmetry there are no others
/// exact:  for square cells in a large box, in units of 1 / dx^2, 1/2 - 1/pi = 0.1817 with ngp,
///         1/4 - 1/(3 pi) = 0.1439 with cic; about 0.1148 with tsc
/// note:   A pair that stays at one place of the mesh has a slope of its own: there, from 0.125 to
///         0.182 with cic, from 0.103 to 0.135 with tsc, and zero with ngp.
inline Eigen::Vector2d mean_force_slope(const CloudPair& pair) {
    using detail::potential;
    const double dx = pair.x.spacing(), dz = pair.z.spacing();
    const auto along_x = [&](double r_x) { return potential(pair, r_x, 0.0, true, false); };
    const auto along_z = [&](double r_z) { return potential(pair, 0.0, r_z, false, true); };
    return {(along_x(-dx) - along_x(dx)) / (2.0 * dx), (along_z(-dz) - along_z(dz)) / (2.0 * dz)};
}

/// Squares of the frequencies at which two overlapping clouds swing through each other.
///   omega^2 = - q_1 q_2 (1 / m_1 + 1 / m_2) dF/dr
/// out:    along x and z; negative for like charges, which leave each other at the rate |omega|
inline Eigen::Vector2d overlap_frequency_squared(const CloudPair& pair, double q_1, double m_1,
                                                 double q_2, double m_2) {
    return -q_1 * q_2 * (1.0 / m_1 + 1.0 / m_2) * mean_force_slope(pair);
}

/// Two clouds of opposite charge swing through each other along x.
inline void compare_clouds(const Case& parameters, const History& history, Summary& summary) {
    const SpeciesCase &a = parameters.species[0], &b = parameters.species[1];
    const auto separation = history.column("separation_x");
    const CloudPair pair =
        make_cloud_pair(parameters.grid.x, parameters.grid.z, parameters.scheme().order);
    const double expected = std::sqrt(std::max(
        0.0, overlap_frequency_squared(pair, a.mean_density() * a.charge, a.mean_density() * a.mass,
                                       b.mean_density() * b.charge, b.mean_density() * b.mass)[0]));
    if (expected == 0) {
        summary.result_info("largest_separation", std::ranges::max(separation), "length",
                            "measured");
        return;
    }
    const common::MeasuredMode seen = common::measure_mode(history.column("time"), separation,
                                                           {.expected = {expected, -expected}});
    const double cells = std::max(std::fabs(a.drift_x) / parameters.grid.x.spacing(),
                                  std::fabs(a.drift_z) / parameters.grid.z.spacing()) *
                         2 * pi / expected;
    summary.hint(cells < 1 ? sentence("the pair drifts ", cells,
                                      " cells in a swing, and a pair that stays at one place of "
                                      "the mesh has a force of its own: give both the same "
                                      "drift_x and drift_z, of a cell or more in a swing, ",
                                      2 * pi / expected)
                           : "the pair may swing beyond the linear part of the force: bring the "
                             "clouds closer together, or lower time.dt");
    if (!seen.found) return summary.not_measured("omega_over_theory", seen.reason);
    summary.result("omega_over_theory",
                   {seen.frequency() / expected, seen.frequency_error() / expected}, "", 1,
                   parameters.frequency_tolerance,
                   "linear force of overlapping clouds, mean over all places on the mesh");
    summary.result_info("omega", {seen.frequency(), seen.frequency_error()}, omega_p_unit,
                        "measured " + seen.window);
    summary.result_info("misfit", std::sqrt(std::max(0.0, 1 - seen.share)), "",
                        "rms of what is not harmonic");
}

/// Refuses a case that is not two points in a periodic plane.
inline void validate_clouds(const Case& parameters) {
    refuse(parameters.species.size() != 2 || count_with_profile(parameters, "point") != 2 ||
               parameters.dimensions != 2 || parameters.has_walls() || parameters.magnetized() ||
               parameters.conserving != "momentum" || parameters.stencil != "five_point",
           asked_for(parameters),
           " needs two species with profile = \"point\" in a periodic plane, the momentum scheme "
           "and the five-point stencil, and no magnetic field");
    refuse(
        parameters.species[0].center_x == parameters.species[1].center_x, asked_for(parameters),
        " needs clouds apart along x, and both have center_x = ", parameters.species[0].center_x);
}

/// Adds the distance of the two clouds along x, to the nearest image.
inline void add_separation(const Case& parameters, const std::vector<Particles>& species,
                           common::Row& row) {
    const auto x_of = [&](std::size_t k) {  // with the rank that has it
        return gather_with_all({species[k].x_p.begin(), species[k].x_p.end()})[0];
    };
    const double length = parameters.grid.x.length, d = x_of(1) - x_of(0);
    row.add("separation_x", "length", d - length * std::floor(d / length + 0.5));
}

/// The comparison of two clouds.
inline constexpr Comparison clouds_comparison{.name = "clouds",
                                              .validate = validate_clouds,
                                              .add_columns = add_separation,
                                              .add_results = compare_clouds};

}  // namespace cic
