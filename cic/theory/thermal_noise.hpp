// The energy of the field that a warm plasma of particles always has.
#pragma once

#include <cmath>

#include "cic/theory/comparison.hpp"

namespace cic {

/// Energy of the field in a plasma in thermal equilibrium, per kinetic energy.
///   (1/N_c N) sum_(k /= 0) A / (A + K^2 lambda_D^2),   A = sum_p S(k_p)^2
/// in:     lambda_D/dx; N_c particles per cell; N cells; order of the weights
/// exact:  for the energy-conserving scheme, in the limit of many particles in a Debye length: each
///         of N modes has T/2, screened; [CIC-1] leaves A of the noise of points
/// note:   The momentum scheme comes close where the Debye length is resolved. A has a closed form:
///         1 for ngp, (2 + C)/3 for cic, (33 + 26 C + cos 2 k dx)/60 for tsc, C = cos k dx. For
///         points and a continuous field the sum is arctan(pi l) / (pi l N_c), l = lambda_D/dx.
inline double thermal_noise(double debye_over_dx, double per_cell, long cells, int order) {
    double sum = 0;
    for (long m = 1; m < cells; ++m) {
        const double theta = 2 * pi * double(m) / double(cells);
        const double K2 = 2 - 2 * std::cos(theta);
        const double A = order == 0   ? 1
                         : order == 1 ? (2 + std::cos(theta)) / 3
                                      : (33 + 26 * std::cos(theta) + std::cos(2 * theta)) / 60;
        sum += A / (A + K2 * debye_over_dx * debye_over_dx);
    }
    return sum / (per_cell * double(cells));
}

/// How a warm plasma at rest does: the energy of its noise, and how fast the mesh heats it.
inline void compare_heating(const Case& parameters, const History& history, Summary& summary) {
    const auto kinetic = history.column("kinetic"), field = history.column("field");
    const double ratio = kinetic.back() / kinetic.front();
    summary.result_info("kinetic_over_initial", ratio, "", "measured");
    double inverse_debye2 = 0, per_cell = 0;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        inverse_debye2 += s.mean_density() * s.charge * s.charge / s.temperature_x;
        per_cell += double(s.particles_per_cell);
    }
    const double at_start = 1 / std::sqrt(inverse_debye2) / parameters.grid.x.spacing();
    const double mean = mean_of_last_half(kinetic);
    const double then = at_start * std::sqrt(mean / kinetic.front());
    summary.result_info("debye_length_over_dx", at_start * std::sqrt(ratio), "", "at the end");
    const double expected =
        thermal_noise(then, per_cell, parameters.grid.x.cells, parameters.scheme().order);
    summary.result("field_over_kinetic", mean_of_last_half(field) / mean, "", expected,
                   parameters.growth_tolerance * expected, "thermal noise on this mesh");
}

/// Refuses a case that is not a uniform warm plasma in one periodic dimension.
inline void validate_heating(const Case& parameters) {
    refuse(parameters.has_walls() || parameters.dimensions != 1, asked_for(parameters),
           " needs a warm plasma in one periodic dimension");
    for (const SpeciesCase& s : parameters.species)
        refuse(s.mobile() && (s.profile != "uniform" || s.charge == 0 || s.temperature_x == 0),
               asked_for(parameters), " needs uniform, charged, warm species, and '", s.name,
               "' has profile \"", s.profile, "\", charge ", s.charge, " and temperature_x ",
               s.temperature_x);
}

/// The comparison of a warm plasma at rest.
inline constexpr Comparison heating_comparison{
    .name = "heating", .validate = validate_heating, .add_results = compare_heating};

}  // namespace cic
