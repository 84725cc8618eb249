// What theory says about one mode of a case: its complex frequency omega + i gamma, from the
// dispersion relation of the species that the case file lists.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "cic/case.hpp"
#include "cic/mesh_dispersion.hpp"
#include "common/kinetic_dispersion.hpp"

namespace cic {

/// A wave vector, from the number of wave lengths in the box.
struct WaveVector {
    double x = 0, z = 0;
    double size() const { return std::hypot(x, z); }
};
inline WaveVector wave_vector(const Case& w, long mode_x, long mode_z) {
    WaveVector k{2 * pi * static_cast<double>(mode_x) / w.grid.x.length, 0};
    if (w.dimensions == 2) k.z = 2 * pi * static_cast<double>(mode_z) / w.grid.z.length;
    return k;
}

/// The mobile species as the dispersion relation wants them, along k. It is in Gaussian units, where
/// omega_s^2 = 4 pi n q^2/m.
inline std::vector<common::PlasmaSpecies> theory_species(const Case& w, const WaveVector& k) {
    std::vector<common::PlasmaSpecies> plasma;
    const double n_x = k.x / k.size(), n_z = k.z / k.size();
    for (const SpeciesCase& s : w.species) {
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
inline std::complex<double> cold_magnetized_dispersion(const Case& w, const WaveVector& k,
                                                       std::complex<double> omega) {
    const double along = (k.x * w.B.x + k.z * w.B.z) / (k.size() * w.B.size());
    const double cos2 = along * along;
    std::complex<double> D = 1;
    for (const SpeciesCase& s : w.species) {
        if (!s.mobile()) continue;
        const double omega2_s = s.density * s.charge * s.charge / s.mass,
                     Omega_s = s.charge * w.B.size() / s.mass;
        D -= omega2_s * (cos2 / (omega * omega) + (1 - cos2) / (omega * omega - Omega_s * Omega_s));
    }
    return D;
}

/// What theory says about a mode, and where it comes from.
struct Theory {
    std::complex<double> omega;
    std::string source;
    long mode_x = 0, mode_z = 0;
};

/// The root of the dispersion relation for the followed mode.
/// errors: InputError when no root is found
/// note:   with the law as the slide prints it, gauss_sign = -1, omega_s^2 changes its sign.
inline Theory theory_of_wave(const Case& w, long mode_x, long mode_z) {
    const WaveVector k = wave_vector(w, mode_x, mode_z);
    auto plasma = theory_species(w, k);
    Theory theory;
    theory.mode_x = mode_x, theory.mode_z = mode_z;
    common::DispersionRoot root;
    const auto find = [&](const auto& D) {
        root = w.near != 0
                   ? common::root_near(D, {w.near, 1e-3 * w.near})
                   : common::fastest_growing_root(D, common::fan_of_guesses(plasma, k.size()));
    };
    if (w.model == "mesh") {
        const bool along_x = mode_x != 0;
        const common::Axis& axis = along_x ? w.grid.x : w.grid.z;
        const MeshScheme scheme{axis.spacing(), w.dt, w.scheme().order,
                                w.scheme().energy_conserving};
        if (w.near != 0)
            find([&](std::complex<double> omega) {
                return mesh_dispersion(plasma, k.size(), scheme, omega);
            });
        else
            root = fastest_growing_on_mesh(plasma, k.size(), scheme);
        theory.source = "dispersion relation on this mesh, " + w.weighting + ", " + w.conserving +
                        "-conserving";
    } else if (w.magnetized()) {
        find([&](std::complex<double> omega) { return cold_magnetized_dispersion(w, k, omega); });
        theory.source = "cold magnetized plasma";
    } else {
        find([&](std::complex<double> omega) {
            // 1 + chi, and 1 - chi where like charges attract.
            return 1.0 +
                   w.gauss_sign * (common::longitudinal_dispersion(plasma, k.size(), omega) - 1.0);
        });
        theory.source = w.gauss_sign > 0 ? "kinetic dispersion relation"
                                         : "dispersion relation with div E = -rho";
    }
    if (!root.found)
        throw common::InputError("no root of the dispersion relation was found for mode (" +
                                 std::to_string(mode_x) + ", " + std::to_string(mode_z) +
                                 "): give theory.near a frequency to look at, or set "
                                 "theory.compare = \"none\"");
    // What is only round-off is zero.
    const double least = 1e-9 * std::abs(root.omega);
    theory.omega = {std::fabs(root.omega.real()) < least ? 0 : root.omega.real(),
                    std::fabs(root.omega.imag()) < least ? 0 : root.omega.imag()};
    return theory;
}

/// The same for the followed mode of the case; mode (0, 0) means the one along x that grows fastest.
inline Theory theory_of_wave(const Case& w) {
    if (w.mode_x != 0 || w.mode_z != 0) return theory_of_wave(w, w.mode_x, w.mode_z);
    Theory best;
    for (long m = 1; 2 * m < w.grid.x.cells; ++m) {
        const Theory theory = theory_of_wave(w, m, 0);
        if (m == 1 || theory.omega.imag() > best.omega.imag()) best = theory;
    }
    return best;
}

}  // namespace cic
