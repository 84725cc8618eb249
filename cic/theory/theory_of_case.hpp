// What theory says about one mode of a case: its complex frequency omega + i gamma, from the
// dispersion relation of the species that the case file lists.
#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "cic/setup/case.hpp"
#include "cic/theory/magnetized_dispersion.hpp"
#include "cic/theory/mesh_dispersion.hpp"
#include "cic/theory/search_roots.hpp"
#include "cic/theory/smooth_distribution.hpp"
#include "common/theory/kinetic_dispersion.hpp"

namespace cic {

/// A mode in messages.
inline std::string mode_text(long mode_x, long mode_z) {
    return "mode (" + std::to_string(mode_x) + ", " + std::to_string(mode_z) + ")";
}

/// A wave vector in the plane of the mesh.
struct WaveVector {
    double x = 0, z = 0;
    double size() const { return std::hypot(x, z); }
};

/// The wave vector of a mode: the numbers of its wavelengths in the box.
inline WaveVector wave_vector(const Case& parameters, long mode_x, long mode_z) {
    WaveVector k{2 * pi * double(mode_x) / parameters.grid.x.length, 0};
    if (parameters.dimensions == 2) k.z = 2 * pi * double(mode_z) / parameters.grid.z.length;
    return k;
}

/// The mobile species as the dispersion relation wants them, along k. It has Gaussian units:
/// omega_s^2 = 4 pi n q^2/m.
inline std::vector<common::PlasmaSpecies> theory_species(const Case& parameters,
                                                         const WaveVector& k) {
    std::vector<common::PlasmaSpecies> plasma;
    const double n_x = k.x / k.size(), n_z = k.z / k.size();
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const std::array<double, 3> T = s.temperatures(parameters.axis());
        common::PlasmaSpecies p;
        p.density = s.mean_density() / (4 * pi), p.charge = s.charge, p.mass = s.mass;
        p.drift = s.drift_x * n_x + s.drift_z * n_z;
        p.temperature_along = T[0] * n_x * n_x + T[2] * n_z * n_z;
        p.gyrofrequency = s.charge * parameters.B.size() / s.mass;
        plasma.push_back(p);
    }
    return plasma;
}

/// A species in the magnetic field of the case, for one wave vector.
inline MagnetizedSpecies magnetized_species(const Case& parameters, const SpeciesCase& s,
                                            const WaveVector& k) {
    const double B = parameters.B.size();
    const std::array<double, 3> b{parameters.B.x / B, parameters.B.y / B, parameters.B.z / B},
        u = s.drift(), T = s.temperatures(parameters.axis());
    MagnetizedSpecies m;
    m.omega2 = s.mean_density() * s.charge * s.charge / s.mass;
    m.Omega = s.charge * B / s.mass;
    m.k = k.size(), m.k_along = k.x * b[0] + k.z * b[2];
    double T_along = 0, T_all = 0;
    for (std::size_t a = 0; a < 3; ++a)
        m.drift += u[a] * b[a], T_along += T[a] * b[a] * b[a], T_all += T[a];
    m.v_along = std::sqrt(T_along / s.mass);
    const double k_across = std::sqrt(std::max(0.0, m.k * m.k - m.k_along * m.k_along));
    m.harmonics =
        s.tables.speed.given()
            ? tabulated_harmonics(k_across, s.tables.speed, m.Omega)
            : maxwellian_harmonics(
                  k_across, std::sqrt(std::max(0.0, 0.5 * (T_all - T_along)) / s.mass), m.Omega);
    return m;
}

/// chi of a distribution by formula: f' is a sum over the steps of its table.
///   chi = -(omega_s / k)^2 int f' dv / (v - c),  c = omega / k - u
/// exact:  for the table everywhere, for a smooth f where Im c is some pieces above the real axis
inline std::complex<double> tabulated_susceptibility(const Distribution& table, double omega2,
                                                     double k, double drift,
                                                     std::complex<double> omega) {
    // In real numbers, so that many pieces are summed at a time.
    const double y = omega.imag(), x = omega.real() - k * drift;
    double re = 0, im = 0;
#pragma omp simd reduction(+ : re, im)
    for (std::size_t j = 0; j < table.rise.size(); ++j) {
        const double w = x - k * table.edge(j), part = table.rise[j] / (w * w + y * y + 1e-300);
        re += part * w, im -= part * y;
    }
    return omega2 / k * std::complex<double>(re, im);
}

/// G = int f dv / (omega - k v) of a distribution by formula, = (1 / k) int f' log(omega - k v) dv.
inline std::complex<double> tabulated_free_response(const Distribution& table, double k,
                                                    double drift, std::complex<double> omega) {
    std::complex<double> sum = 0;
    for (std::size_t j = 0; j < table.rise.size(); ++j)
        if (table.rise[j] != 0)
            sum += table.rise[j] * std::log(omega - k * (drift + table.edge(j)));
    return sum / k;
}

/// What one mobile species does in a wave.
///   D = 1 + sum_s chi_s;  G_s = int f_s dv / (omega - k v): of a seed in free particles
struct SpeciesResponse {
    std::function<std::complex<double>(std::complex<double>)> chi, G;
    bool table_only = false;  // of a distribution by formula that is not smooth: no damped waves
};

/// The response of a smooth distribution by formula, damped waves included; no value where the series
/// does not have it to 1e-3.
///   chi = -(omega_s / k)^2 dH/dc,  G = -H / k,  c = omega / k - u,  k > 0
inline SpeciesResponse smooth_response(const SmoothDistribution& f, double omega2, double k,
                                       double drift) {
    const auto at = [f, k, drift](std::complex<double> omega) { return f.at(omega / k - drift); };
    return {[=](auto omega) {
                const auto value = at(omega);
                return value.error <= 1e-3 ? -omega2 / (k * k) * value.slope : common::no_value;
            },
            [=](auto omega) { return -at(omega).H / k; }};
}

/// The table along k of a distribution by formula, where the species has one; k along an axis.
inline const Distribution& table_along(const SpeciesCase& s, const WaveVector& k) {
    return s.tables.v[k.z == 0 ? 0 : 2];
}

/// The responses of all mobile species to the waves of one wave vector.
/// in:     magnetized, the same species in a magnetic field, empty without one; grows, whether only
///         growing waves are asked for, which tables have as they are
inline std::vector<SpeciesResponse> responses_of(const Case& parameters, const WaveVector& k,
                                                 const std::vector<MagnetizedSpecies>& magnetized,
                                                 bool grows = false) {
    const auto plasma = theory_species(parameters, k);
    std::vector<SpeciesResponse> all;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const common::PlasmaSpecies p = plasma[all.size()];
        const double size = k.size(), along = k.z == 0 ? k.x : k.z;
        if (parameters.magnetized()) {
            const MagnetizedSpecies& m = magnetized[all.size()];
            all.push_back({[&m](auto omega) { return magnetized_response(m, omega).chi; },
                           [&m](auto omega) { return magnetized_response(m, omega).G; }});
        } else if (const Distribution& f = table_along(s, k); f.given()) {
            const double omega2 = s.mean_density() * s.charge * s.charge / s.mass,
                         drift = p.drift * size / along;
            const SpeciesResponse of_table{
                [&f, omega2, along, drift](auto omega) {
                    return tabulated_susceptibility(f, omega2, along, drift, omega);
                },
                [&f, along, drift](auto omega) {
                    return tabulated_free_response(f, along, drift, omega);
                },
                true};
            all.push_back(of_table);
            if (grows) continue;
            if (const SmoothDistribution smooth(f, along < 0); smooth.holds())
                all.back() = smooth_response(smooth, omega2, size, p.drift);
        } else {
            const double kv = std::numbers::sqrt2 * size * p.speed_along();
            all.push_back({[p, size](auto omega) {
                               return common::longitudinal_dispersion({&p, 1}, size, omega) - 1.0;
                           },
                           [p, size, kv](auto omega) -> std::complex<double> {
                               const std::complex<double> doppler = omega - size * p.drift;
                               if (kv == 0) return 1.0 / doppler;
                               return -common::plasma_dispersion(doppler / kv) / kv;
                           }});
        }
    }
    return all;
}

/// What theory says about a mode, and where it comes from.
struct Theory {
    std::complex<double> omega;
    std::string source;
    long mode_x = 0, mode_z = 0;
    double seed = 0;        // amplitude with which the field of this root starts; 0: not known
    bool mirrored = false;  // -conj(omega) is a root as well, of the wave that goes the other way
    std::vector<double> others;       // frequencies of other undamped waves, where they are known
    std::complex<double> hidden = 0;  // a root that decays hardly faster than a damped one; 0: none
    std::complex<double> in_plasma = 0;  // omega where the plasma of the wave has no drift

    /// What errors are measured by: drifts of the whole plasma change a frequency, and nothing else.
    double scale(double frequency) const {
        return std::min(std::fabs(frequency), std::abs(in_plasma));
    }
};

/// omega - k u of the species that respond to the wave, chi a tenth of the largest or more: the
/// largest, so that one which drifts with the wave leaves that of the others.
inline std::complex<double> frequency_in_plasma(const Case& parameters, const WaveVector& k,
                                                std::complex<double> omega,
                                                const std::vector<SpeciesResponse>& responses) {
    std::vector<std::pair<double, std::complex<double>>> found;
    double most = 0;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const Distribution &x = s.tables.v[0], &z = s.tables.v[2];
        const double ku = k.x * (s.drift_x + (x.given() ? x.mean() : 0)) +
                          k.z * (s.drift_z + (z.given() ? z.mean() : 0));
        found.push_back({std::abs(responses[found.size()].chi(omega)), omega - ku});
        most = std::max(most, found.back().first);
    }
    std::complex<double> largest = 0;
    for (const auto& [chi, moved] : found)
        if (!(chi < 0.1 * most) && std::abs(moved) > std::abs(largest)) largest = moved;
    return largest;
}

/// The part of the seeded field that belongs to one root of D: the residue of the initial-value
/// problem.
///   E_k = |sum_s q_s n_s A_s G_s / (k D'(omega))|
/// in:     uniformly, whether all charge is perturbed alike, for modes that no species seeds
/// exact:  for standing perturbations, in linear theory; 0 for traveling ones
/// source: Landau, J. Phys. USSR 10, 25 (1946).
template <class Dispersion>
double seeded_field(const Case& parameters, const Theory& theory,
                    const std::vector<SpeciesResponse>& responses, const Dispersion& D,
                    bool uniformly = false) {
    const double k = wave_vector(parameters, theory.mode_x, theory.mode_z).size();
    const std::complex<double> omega = theory.omega, aside = 1e-8 * std::abs(omega);
    const std::complex<double> slope = (D(omega + aside) - D(omega - aside)) / (2.0 * aside);
    std::complex<double> charge = 0;
    auto response = responses.begin();
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        double seed = uniformly ? std::fabs(s.charge) * s.mean_density() : 0;
        for (const PerturbationCase& p : perturbations_of(parameters, s)) {
            if (uniformly || !p.is_of(theory.mode_x, theory.mode_z)) continue;
            if (p.wave == "traveling") return 0;
            seed += s.charge * s.mean_density() * p.amplitude;
        }
        if (seed != 0) charge += seed * response->G(omega);
        ++response;
    }
    return std::abs(charge / slope) / k;
}

/// Guesses for the roots of a magnetized plasma: as without a field, and between the harmonics.
inline std::vector<std::complex<double>> guesses_in_field(
    const std::vector<common::PlasmaSpecies>& plasma, const WaveVector& k,
    const std::vector<MagnetizedSpecies>& magnetized) {
    auto guesses = common::fan_of_guesses(plasma, k.size());
    for (const MagnetizedSpecies& s : magnetized)
        for (int n = 0; n <= 8; ++n)
            for (const double part : {0.02, 0.3, 0.6, 0.9})
                for (const double growth : {-0.02, 0.1, 0.5})
                    guesses.push_back(s.k_along * s.drift +
                                      std::fabs(s.Omega) * std::complex<double>(n + part, growth));
    return guesses;
}

/// The waves of a magnetized plasma. Which of its many roots the run is compared with:
///   1. with theory.near, the one nearest to it
///   2. the fastest growing
///   3. where nothing grows, the one that has most of the seeded field during the run: the largest
///      E_k^2 / max(2 |gamma|, 1 / time.end)
/// errors: InputError when no root is found
template <class Dispersion>
void find_magnetized_wave(const Case& parameters, const WaveVector& k,
                          const std::vector<MagnetizedSpecies>& plasma,
                          const std::vector<SpeciesResponse>& responses, const Dispersion& D,
                          const std::vector<std::complex<double>>& guesses, Theory& theory) {
    bool bernstein = std::fabs(plasma.front().k_along) <= 1e-12 * k.size();
    for (const SpeciesCase& s : parameters.species)
        bernstein = bernstein && !s.tables.speed.given();
    std::vector<std::complex<double>> roots;
    if (bernstein) {
        for (const double omega : bernstein_roots(plasma)) roots.push_back(omega);
    } else {
        roots = all_roots(D, guesses);
    }
    refuse(roots.empty(), "no root of the dispersion relation was found for ",
           mode_text(theory.mode_x, theory.mode_z), ": set theory.compare = \"none\"");
    bool seeded = false, grows = false;
    const auto is_growing = [](std::complex<double> omega) {
        return omega.imag() > 1e-6 * std::abs(omega);
    };
    for (const std::complex<double> root : roots) {
        theory.omega = root;
        seeded = seeded || seeded_field(parameters, theory, responses, D) > 0;
        grows = grows || is_growing(root);
    }
    const auto merit = [&](std::complex<double> root) {
        if (parameters.near != 0) return -apart(root, parameters.near);
        const double forward = root.real() > 0 ? 1 : 0.999;  // of two that mirror each other
        if (grows) return root.imag() * forward;
        theory.omega = root;
        const double E = seeded_field(parameters, theory, responses, D, !seeded);
        return E * E / std::max(2 * std::fabs(root.imag()), 1 / parameters.end) * forward;
    };
    std::complex<double> best = roots.front();
    double most = merit(best);
    for (const std::complex<double> root : roots)
        if (const double value = merit(root); value > most) best = root, most = value;
    theory.omega = best;
    theory.source = bernstein ? "Bernstein mode" : "dispersion relation in a magnetic field";
    theory.source += parameters.near != 0 ? ", nearest to theory.near"
                     : grows              ? ", fastest growing"
                                          : ", the one that is seeded most";
    if (bernstein)
        for (const std::complex<double> root : roots)
            if (root != best) theory.others.push_back(root.real());
}

/// Of other roots of a damped wave the one that decays most slowly, where that is less than 1.5 times as fast;
/// a mirror image is no other. out: 0 where there is none
inline std::complex<double> decays_hardly_faster(const std::vector<std::complex<double>>& roots,
                                                 std::complex<double> omega) {
    std::complex<double> slowest = 0;
    for (const std::complex<double> root : roots) {
        const std::complex<double> here(std::fabs(root.real()), root.imag());
        const bool same =
            std::abs(here - std::complex<double>(std::fabs(omega.real()), omega.imag())) <
            1e-6 * std::abs(omega);
        if (!same && here.imag() > 1.5 * omega.imag() &&
            (slowest == 0.0 || here.imag() > slowest.imag()))
            slowest = here;
    }
    return slowest;
}

/// No root is known of a mode whose distributions by formula are smooth: it is damped, and too much for
/// their series.
struct DampedWave : common::InputError {
    using InputError::InputError;
};

/// Refuses a root at which some distribution by formula that is not smooth has particles that move
/// with the wave: the integral over its table is not continued below the real axis.
inline void refuse_resonance(const Case& parameters, const WaveVector& k, const Theory& theory,
                             const std::vector<SpeciesResponse>& responses) {
    auto response = responses.begin();
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile() || !(response++)->table_only) continue;
        const Distribution& f = table_along(s, k);
        const double along = k.z == 0 ? k.x : k.z;
        const std::complex<double> c = theory.omega / along - (k.z == 0 ? s.drift_x : s.drift_z);
        bool resonant = theory.omega.imag() < 0;
        for (std::size_t j = 0; j < f.rise.size(); ++j)
            resonant = resonant || (f.rise[j] != 0 && std::abs(c.real() - f.edge(j)) < 4 * f.step);
        const double least = 4 * f.step * std::fabs(along);
        refuse(resonant && theory.omega.imag() < least, "theory of species.", s.name,
               ", whose distribution by formula has steps or steep slopes, or is cut before it is "
               "1e-8 of its largest, is for waves that grow faster than ",
               least, " or have no particles at their phase velocity, and the one of ",
               mode_text(theory.mode_x, theory.mode_z), " has omega = ", theory.omega.real(),
               ", growth = ", theory.omega.imag(),
               ": raise distribution_max where it is cut, or set theory.compare = \"none\"");
    }
}

/// The root of the dispersion relation for one mode.
/// in:     rate; a root is wanted that grows faster
/// out:    mode_x = mode_z = 0 where it is known that none does
/// errors: InputError when no root is found
/// note:   with the law as the slide prints it, gauss_sign = -1, omega_s^2 changes its sign.
inline Theory theory_of_wave(const Case& parameters, long mode_x, long mode_z,
                             double rate = -HUGE_VAL) {
    const WaveVector k = wave_vector(parameters, mode_x, mode_z);
    const auto plasma = theory_species(parameters, k);
    std::vector<MagnetizedSpecies> magnetized;
    for (const SpeciesCase& s : parameters.species)
        if (parameters.magnetized() && s.mobile())
            magnetized.push_back(magnetized_species(parameters, s, k));
    const common::Axis& axis = mode_x != 0 ? parameters.grid.x : parameters.grid.z;
    const MeshScheme scheme{axis.spacing(), parameters.dt, parameters.scheme().order,
                            parameters.scheme().energy_conserving};
    const bool on_mesh = parameters.model == "mesh";
    const auto relation = [&](const std::vector<SpeciesResponse>& all) {
        return [&](std::complex<double> omega) {
            if (on_mesh) return mesh_dispersion(plasma, k.size(), scheme, omega);
            // 1 + chi, and 1 - chi where like charges attract.
            std::complex<double> chi = 0;
            for (const SpeciesResponse& s : all) chi += s.chi(omega);
            return 1.0 + parameters.gauss_sign * chi;
        };
    };
    auto guesses = on_mesh ? guesses_on_mesh(plasma, k.size(), scheme)
                           : guesses_in_field(plasma, k, magnetized);
    if (parameters.near != 0) guesses.push_back({parameters.near, 1e-3 * parameters.near});

    Theory theory;
    // Below the real axis only warm Maxwellians have no poles.
    bool warm = !parameters.magnetized() && !parameters.has_distributions();
    for (const common::PlasmaSpecies& s : plasma) warm = warm && s.temperature_along > 0;
    if (rate > (warm ? -HUGE_VAL : 0)) {
        const auto growing = responses_of(parameters, k, magnetized, true);
        if (!may_grow_faster(relation(growing), rate, guesses)) return theory;
    }
    const auto responses = responses_of(parameters, k, magnetized);
    const auto D = relation(responses);
    theory.mode_x = mode_x, theory.mode_z = mode_z;
    if (parameters.magnetized()) {
        find_magnetized_wave(parameters, k, magnetized, responses, D, guesses, theory);
    } else {
        theory.source = on_mesh ? "dispersion relation on this mesh, " + parameters.weighting +
                                      ", " + parameters.conserving + "-conserving"
                        : parameters.gauss_sign > 0 ? "kinetic dispersion relation"
                                                    : "dispersion relation with div E = -rho";
        common::DispersionRoot root = parameters.near != 0
                                          ? nearest_root(D, guesses, parameters.near)
                                          : common::fastest_growing_root(D, guesses);
        // On a mesh every wave has aliases. Where none grows, the one is meant that is there without it.
        if (on_mesh && parameters.near == 0 && root.found &&
            !(root.omega.imag() > 1e-6 * std::abs(root.omega))) {
            Case without = parameters;
            without.model = "plasma";
            const double frequency = theory_of_wave(without, mode_x, mode_z).omega.real();
            root = nearest_root(D, guesses, frequency);
        }
        if (!root.found) {
            const bool table_only = std::ranges::any_of(responses, &SpeciesResponse::table_only);
            const std::string why = sentence(
                "no root of the dispersion relation was found for ", mode_text(mode_x, mode_z),
                table_only
                    ? ", and where a distribution by formula has steps or steep slopes, or is "
                      "cut before it is 1e-8 of its largest, none that is damped is known: "
                      "raise distribution_max where it is cut"
                    : sentence(": give theory.near ", parameters.near != 0 ? "another" : "a",
                               " frequency to look at"),
                ", or set theory.compare = \"none\"");
            if (parameters.has_distributions() && !table_only) throw DampedWave(why);
            throw common::InputError(why);
        }
        theory.omega = root.omega;
    }
    // What is only round-off is zero.
    const double least = 1e-9 * std::abs(theory.omega);
    theory.omega = {std::fabs(theory.omega.real()) < least ? 0 : theory.omega.real(),
                    std::fabs(theory.omega.imag()) < least ? 0 : theory.omega.imag()};
    const std::complex<double> mirror = -std::conj(theory.omega);
    const common::DispersionRoot other = common::root_near(D, mirror);
    theory.mirrored = other.found && std::abs(other.omega - mirror) < 1e-6 * std::abs(mirror);
    theory.in_plasma = theory.mirrored
                           ? theory.omega
                           : frequency_in_plasma(parameters, k, theory.omega, responses);
    if (!parameters.magnetized() &&
        theory.omega.imag() < -1e-3 * theory.scale(std::abs(theory.omega)))
        theory.hidden = decays_hardly_faster(all_roots(D, guesses), theory.omega);
    if (!on_mesh) refuse_resonance(parameters, k, theory, responses);
    if (!on_mesh) theory.seed = seeded_field(parameters, theory, responses, D);
    return theory;
}

/// The same for the followed mode of the case; mode (0, 0) is the fastest growing along x.
inline Theory theory_of_wave(const Case& parameters) {
    if (parameters.mode_x != 0 || parameters.mode_z != 0 || parameters.fastest_x != 0)
        return theory_of_wave(parameters, parameters.mode_x + parameters.fastest_x,
                              parameters.mode_z);
    Theory best;
    for (long m = 1; 2 * m < parameters.grid.x.cells; ++m) try {
            const Theory theory =
                theory_of_wave(parameters, m, 0, best.mode_x == 0 ? -HUGE_VAL : best.omega.imag());
            if (theory.mode_x == 0) continue;
            if (best.mode_x == 0 || theory.omega.imag() > best.omega.imag()) best = theory;
            if (!best.others.empty()) break;  // Bernstein modes do not grow
        } catch (const DampedWave&) {
            // It does not grow fastest; one at least is known.
            if (best.mode_x == 0 && 2 * m + 2 >= parameters.grid.x.cells) throw;
        }
    return best;
}

}  // namespace cic
