// What theory says about one mode of a case: its complex frequency omega + i gamma, from the
// dispersion relation of the species that the case file lists.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "cic/setup/case.hpp"
#include "cic/theory/mesh_dispersion.hpp"
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
        common::PlasmaSpecies p;
        p.density = s.density / (4 * pi), p.charge = s.charge, p.mass = s.mass;
        p.drift = s.drift_x * n_x + s.drift_z * n_z;
        p.temperature_along = s.temperature_x * n_x * n_x + s.temperature_z * n_z * n_z;
        plasma.push_back(p);
    }
    return plasma;
}

/// Longitudinal waves of a cold magnetized plasma at rest, B at an angle alpha with k.
///   D = 1 - sum_s omega_s^2 [cos^2 alpha / omega^2 + sin^2 alpha / (omega^2 - Omega_s^2)]
/// source: Stix, Waves in Plasmas (1992), chapter 2, the limit of large k.
inline std::complex<double> cold_magnetized_dispersion(const Case& parameters, const WaveVector& k,
                                                       std::complex<double> omega) {
    const double along =
        (k.x * parameters.B.x + k.z * parameters.B.z) / (k.size() * parameters.B.size());
    const double cos2 = along * along;
    std::complex<double> D = 1;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const double omega2_s = s.density * s.charge * s.charge / s.mass,
                     Omega_s = s.charge * parameters.B.size() / s.mass;
        D -= omega2_s * (cos2 / (omega * omega) + (1 - cos2) / (omega * omega - Omega_s * Omega_s));
    }
    return D;
}

/// What theory says about a mode, and where it comes from.
struct Theory {
    std::complex<double> omega;
    std::string source;
    long mode_x = 0, mode_z = 0;
    double seed = 0;  // amplitude with which the field of this root starts; 0: not known
    bool mirrored =
        false;  // whether -conj(omega) is a root as well, of the wave that goes the other way
};

/// The part of the seeded field that belongs to one root of D: the residue of the initial-value
/// problem.
///   E_k = |sum_s q_s n_s A_s G_s / (k D'(omega))|,  G_s = int f_s dv / (omega - k v)
///       = 1/(omega - k u_s) for a cold species, and -Z(zeta_s) / (2^1/2 k v_s) for a Maxwellian
/// exact:  for standing perturbations, in linear theory; 0 for traveling ones
/// source: Landau, J. Phys. USSR 10, 25 (1946).
template <class Dispersion>
double seeded_field(const Case& parameters, const Theory& theory, const Dispersion& D) {
    const WaveVector k = wave_vector(parameters, theory.mode_x, theory.mode_z);
    const auto plasma = theory_species(parameters, k);
    const std::complex<double> omega = theory.omega, aside = 1e-4 * std::abs(omega);
    const std::complex<double> slope = (D(omega + aside) - D(omega - aside)) / (2.0 * aside);
    std::complex<double> charge = 0;
    auto along_k = plasma.begin();
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const common::PlasmaSpecies& p = *along_k++;
        if (s.mode_x != theory.mode_x || s.mode_z != theory.mode_z) continue;
        if (s.amplitude != 0 && s.wave == "traveling") return 0;
        const std::complex<double> doppler = omega - k.size() * p.drift;
        const double kv = std::numbers::sqrt2 * k.size() * p.speed_along();
        charge += s.charge * s.density * s.amplitude *
                  (kv == 0 ? 1.0 / doppler : -common::plasma_dispersion(doppler / kv) / kv);
    }
    return std::abs(charge / slope) / k.size();
}

/// The root of the dispersion relation for one mode.
/// errors: InputError when no root is found
/// note:   with the law as the slide prints it, gauss_sign = -1, omega_s^2 changes its sign.
inline Theory theory_of_wave(const Case& parameters, long mode_x, long mode_z) {
    const WaveVector k = wave_vector(parameters, mode_x, mode_z);
    const auto plasma = theory_species(parameters, k);
    const common::Axis& axis = mode_x != 0 ? parameters.grid.x : parameters.grid.z;
    const MeshScheme scheme{axis.spacing(), parameters.dt, parameters.scheme().order,
                            parameters.scheme().energy_conserving};
    const bool on_mesh = parameters.model == "mesh";
    const auto D = [&](std::complex<double> omega) {
        if (on_mesh) return mesh_dispersion(plasma, k.size(), scheme, omega);
        if (parameters.magnetized()) return cold_magnetized_dispersion(parameters, k, omega);
        // 1 + chi, and 1 - chi where like charges attract.
        return 1.0 + parameters.gauss_sign *
                         (common::longitudinal_dispersion(plasma, k.size(), omega) - 1.0);
    };

    Theory theory;
    theory.mode_x = mode_x, theory.mode_z = mode_z;
    theory.source = on_mesh ? "dispersion relation on this mesh, " + parameters.weighting + ", " +
                                  parameters.conserving + "-conserving"
                    : parameters.magnetized()   ? "cold magnetized plasma"
                    : parameters.gauss_sign > 0 ? "kinetic dispersion relation"
                                                : "dispersion relation with div E = -rho";
    const common::DispersionRoot root =
        parameters.near != 0 ? common::root_near(D, {parameters.near, 1e-3 * parameters.near})
        : on_mesh            ? fastest_growing_on_mesh(plasma, k.size(), scheme)
                  : common::fastest_growing_root(D, common::fan_of_guesses(plasma, k.size()));
    if (!root.found)
        throw common::InputError(sentence(
            "no root of the dispersion relation was found for ", mode_text(mode_x, mode_z),
            ": give theory.near a frequency to look at, or set theory.compare = \"none\""));
    // What is only round-off is zero.
    const double least = 1e-9 * std::abs(root.omega);
    theory.omega = {std::fabs(root.omega.real()) < least ? 0 : root.omega.real(),
                    std::fabs(root.omega.imag()) < least ? 0 : root.omega.imag()};
    const std::complex<double> mirror = -std::conj(root.omega);
    const common::DispersionRoot other = common::root_near(D, mirror);
    theory.mirrored = other.found && std::abs(other.omega - mirror) < 1e-6 * std::abs(mirror);
    if (!on_mesh && !parameters.magnetized()) theory.seed = seeded_field(parameters, theory, D);
    return theory;
}

/// The same for the followed mode of the case; mode (0, 0) is the fastest growing along x.
inline Theory theory_of_wave(const Case& parameters) {
    if (parameters.mode_x != 0 || parameters.mode_z != 0)
        return theory_of_wave(parameters, parameters.mode_x, parameters.mode_z);
    Theory best;
    for (long m = 1; 2 * m < parameters.grid.x.cells; ++m) {
        const Theory theory = theory_of_wave(parameters, m, 0);
        if (m == 1 || theory.omega.imag() > best.omega.imag()) best = theory;
    }
    return best;
}

}  // namespace cic
