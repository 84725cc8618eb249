// The energy of the field that a warm plasma of particles always has.
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "cic/theory/comparison.hpp"
#include "common/theory/plasma_dispersion.hpp"

namespace cic {

/// A Maxwellian species at rest, as the noise of its particles needs it.
struct NoisySpecies {
    double noise;           // n_s q_s times the charge of one of its particles
    double inverse_debye2;  // n_s q_s^2 / T_s
    double speed;           // (T_s / m_s)^1/2
};

/// Energy of the field of particles that all have the others around them as a screen.
///   (1/2) sum_(k /= 0) A/K^2 sum_s noise_s int f_s dv / |eps|^2,   A = sum_p S(k_p)^2
///   eps = 1 + A/K^2 chi,  chi = sum_s [1 + z_s Z(z_s)] / lambda_s^2,  z_s = v / (2^1/2 v_s)
/// in:     dx; cells in the box; order of the weights
/// exact:  for the energy-conserving scheme, in the limit of many particles in a Debye length.
///         sum_s 1/lambda_s^2 int f_s dv / |eps|^2 = 1/(lambda^2 + A/K^2): where all particles have
///         the same noise per T, each of N modes has T/2, screened.
/// note:   The momentum scheme comes close where the Debye length is resolved. A has a closed form:
///         1 for ngp, (2 + C)/3 for cic, (33 + 26 C + cos 2 k dx)/60 for tsc, C = cos k dx. One
///         species of points in a continuous field has arctan(pi l) / (pi l N_c) of its kinetic
///         energy, l = lambda_D/dx, N_c particles per cell.
/// source: Rostoker, Nucl. Fusion 1, 101 (1961).
inline double thermal_noise(const std::vector<NoisySpecies>& plasma, double dx, long cells,
                            int order) {
    double inverse_debye2 = 0, slowest = HUGE_VAL, fastest = 0;
    for (const NoisySpecies& s : plasma) {
        inverse_debye2 += s.inverse_debye2;
        slowest = std::min(slowest, s.speed), fastest = std::max(fastest, s.speed);
    }
    // Phase velocities, evenly in their logarithm, and f dv of both directions there.
    struct Phase {
        std::complex<double> chi = 0;
        double noise = 0, screen = 0;  // sums of f dv
    };
    std::vector<Phase> phases(1000);
    const double low = 1e-3 * slowest, step = std::log(12 * fastest / low) / double(phases.size());
    for (std::size_t j = 0; j < phases.size(); ++j)
        for (const NoisySpecies& s : plasma) {
            const double v = low * std::exp(double(j + 1) * step), z = v / s.speed / std::sqrt(2.0),
                         f_dv = 2 * z * std::exp(-z * z) / std::sqrt(pi) * step;
            phases[j].chi += s.inverse_debye2 * (1.0 + z * common::plasma_dispersion(z));
            phases[j].noise += s.noise * f_dv, phases[j].screen += s.inverse_debye2 * f_dv;
        }
    double sum = 0;
    for (long m = 1; m < cells; ++m) {
        const double theta = 2 * pi * double(m) / double(cells);
        const double K2 = (2 - 2 * std::cos(theta)) / (dx * dx);
        const double A = order == 0   ? 1
                         : order == 1 ? (2 + std::cos(theta)) / 3
                                      : (33 + 26 * std::cos(theta) + std::cos(2 * theta)) / 60;
        const auto eps2 = [c = A / K2](const Phase& at) { return std::norm(1.0 + c * at.chi); };
        // The waves themselves, which no step of v could resolve, have the exact sum.
        const Phase& wave = *std::ranges::min_element(phases, {}, eps2);
        const double ratio = wave.noise / wave.screen;
        double integral = ratio / (1 / inverse_debye2 + A / K2);
        for (const Phase& at : phases) integral += (at.noise - ratio * at.screen) / eps2(at);
        sum += 0.5 * A / K2 * integral;
    }
    return sum;
}

/// How a warm plasma does without a wave: the energy of its noise, and how fast the mesh heats it.
/// A common drift is no heat.
inline void compare_heating(const Case& parameters, const History& history, Summary& summary) {
    const common::Axis& x = parameters.grid.x;
    const auto momentum = history.column("momentum_x");
    std::vector<double> kinetic(momentum.size(), 0.0);
    std::vector<NoisySpecies> plasma;
    double mass = 0, inverse_debye2 = 0;  // the latter at the end
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile()) mass += s.mean_density() * s.mass * x.length;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const double count = s.mean_density() * x.length, charge = s.mean_density() * s.charge;
        auto own = history.column("kinetic_" + s.name);
        for (std::size_t n = 0; n < own.size(); ++n) {
            own[n] -= 0.5 * count * s.mass * std::pow(momentum[n] / mass, 2);
            kinetic[n] += own[n];
        }
        const double T = 2 * mean_of_last_half(own) / count;
        plasma.push_back({charge * charge * x.spacing() / double(s.particles_per_cell),
                          charge * s.charge / T, std::sqrt(T / s.mass)});
        inverse_debye2 += charge * s.charge * count / (2 * own.back());
    }
    summary.result_info("kinetic_over_initial", kinetic.back() / kinetic.front(), "",
                        "measured, without the drift");
    summary.result_info("debye_length_over_dx", 1 / std::sqrt(inverse_debye2) / x.spacing(), "",
                        "at the end");
    const double mean = mean_of_last_half(kinetic),
                 expected =
                     thermal_noise(plasma, x.spacing(), x.cells, parameters.scheme().order) / mean;
    const common::Measured field = fluctuating_mean(history.column("field"));
    const double debye_lengths = x.length * std::sqrt(inverse_debye2);
    const bool random = std::ranges::any_of(
        parameters.species, [](const SpeciesCase& s) { return s.loading == "random"; });
    const bool too_low = field.value < expected * mean;
    summary.hint(
        random && !too_low && debye_lengths > 20
            ? "a random start has more noise than equilibrium, and its waves longer than some "
              "twenty Debye lengths keep it: take loading = \"quiet\""
        : too_low && !random
            ? "a quiet start has less noise than equilibrium, and takes long to come to it: raise "
              "time.end"
            : "noise fluctuates, and more of it comes from a mesh that does not resolve the Debye "
              "length: raise time.end or grid.cells_x");
    summary.result("field_over_kinetic", {field.value / mean, field.error / mean}, "", expected,
                   parameters.growth_tolerance * expected, "thermal noise on this mesh");
}

/// Refuses a case that is not a uniform warm plasma in one periodic dimension.
inline void validate_heating(const Case& parameters) {
    refuse(parameters.has_walls() || parameters.dimensions != 1, asked_for(parameters),
           " needs a warm plasma in one periodic dimension");
    refuse(parameters.magnetized(), asked_for(parameters),
           " needs the energy of v_x alone, and with a magnetic field the history has that of all "
           "directions: take out plasma.B_x, B_y and B_z");
    double drift = NAN;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        refuse(s.profile != "uniform" || s.charge == 0 || s.temperature_x == 0,
               asked_for(parameters), " needs uniform, charged, warm species, and '", s.name,
               "' has profile \"", s.profile, "\", charge ", s.charge, " and temperature_x ",
               s.temperature_x);
        refuse(s.drift_x != drift && !std::isnan(drift), asked_for(parameters),
               " needs species that drift together, and '", s.name, "' has drift_x = ", s.drift_x,
               ", another ", drift);
        drift = s.drift_x;
        refuse(!perturbations_of(parameters, s).empty(), asked_for(parameters),
               " is for the noise of particles, and the perturbation of '", s.name,
               "' is a wave beside it: take it out");
    }
}

/// The comparison of a warm plasma without a wave.
inline constexpr Comparison heating_comparison{
    .name = "heating", .validate = validate_heating, .add_results = compare_heating};

}  // namespace cic
