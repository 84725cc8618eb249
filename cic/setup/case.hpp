// Everything a case file of cic can say: plain values with their defaults. The plasma has none: its
// species are in the case file. What each value means stands in describe_case.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "cic/gather_field.hpp"
#include "cic/move_particles.hpp"
#include "cic/poisson.hpp"
#include "cic/setup/distribution.hpp"
#include "common/run/formula.hpp"
#include "common/run/output_file.hpp"
#include "common/run/sentence.hpp"

namespace cic {

using common::format, common::refuse, common::sentence;

/// A perturbation of the density in one mode.
struct PerturbationCase {
    std::string name, species;
    long mode_x = 1, mode_z = 0;
    double amplitude = 0;
    std::string wave = "standing";  // or traveling

    /// Whether it is of this mode; a standing wave is one of the opposite mode as well.
    bool is_of(long x, long z) const {
        return (mode_x == x && mode_z == z) ||
               (wave != "traveling" && mode_x == -x && mode_z == -z);
    }
};

/// What read_formulas() has made of the formulas of a species.
struct Tables {
    Distribution x;                     // of positions, and
    std::vector<Distribution> z;        // in two dimensions, for every piece of x
    double mean_density = 0, peak = 1;  // the largest mean over a cell, in mean densities
    std::array<Distribution, 3> v;      // of the velocities along x, y and z
    Distribution speed;                 // of the one across an axis
};

/// One species; the components of a vector are _x, _y, _z.
struct SpeciesCase {
    std::string name;
    common::Formula density = 1;
    double charge = -1, mass = 1;
    std::string motion = "mobile";    // or fixed: a uniform background without particles
    std::string profile = "uniform";  // or layer, disk, point
    double center_x = 0, center_z = 0, half_width = 0;
    long particles_per_cell = 64;
    std::string loading = "quiet";  // or random, lattice
    double drift_x = 0, drift_y = 0, drift_z = 0;
    double temperature_x = 0, temperature_y = 0, temperature_z = 0;
    // Of the velocity without the drift, in place of a Maxwellian: of each direction, or of the speed
    // across B, without a field across y.
    common::Formula distribution_x, distribution_y, distribution_z, distribution_across;
    double distribution_max = 0;
    std::string start = "drift";  // or ExB: the drift in the field at t = 0
    long mode_x = 1, mode_z = 0;
    double amplitude = 0, ripple = 0;
    std::string wave = "standing";  // or traveling
    double emission = 0, emission_temperature = 1;
    Tables tables;

    bool mobile() const { return motion == "mobile"; }
    double mean_density() const {
        return density.is_number() ? double(density) : tables.mean_density;
    }
    std::array<double, 3> drift() const { return {drift_x, drift_y, drift_z}; }
    bool at_rest() const { return drift_x == 0 && drift_y == 0 && drift_z == 0; }
    bool has_distribution() const {
        return tables.speed.given() || tables.v[0].given() || tables.v[1].given() ||
               tables.v[2].given();
    }
    /// The temperatures, m times the mean squares, along x, y and z, also of formulas.
    /// in:     axis, the one that distribution_across is across
    std::array<double, 3> temperatures(std::size_t axis) const {
        std::array<double, 3> T{temperature_x, temperature_y, temperature_z};
        for (std::size_t a = 0; a < 3; ++a) {
            if (tables.v[a].given()) T[a] = mass * tables.v[a].mean_square(tables.v[a].mean());
            if (tables.speed.given() && a != axis) T[a] = 0.5 * mass * tables.speed.mean_square(0);
        }
        return T;
    }
};

/// What meets a wall.
struct WallCase {
    std::string field = "grounded";    // or floating
    std::string particles = "absorb";  // or reflect, and at x_low source
    double potential = 0;
};

/// A complete input; see units.hpp.
struct Case {
    common::Grid grid{{128, 0, 2 * pi / 0.6123724356957945, true}, {1, 0, 1, true}};
    long dimensions = 1;
    std::string boundary_x = "periodic", boundary_z = "periodic";
    std::array<WallCase, 4> walls;

    double dt = 0.1, end = 60;
    double energy_limit = 10;

    std::string weighting = "cic", conserving = "momentum", stencil = "five_point";
    double gauss_sign = 1;
    MagneticField B;
    long sort_interval = 25;
    long seed = 1;
    std::vector<SpeciesCase> species;
    std::vector<PerturbationCase> perturbations;
    std::vector<common::Constant> constants;  // of formulas

    // What the run is compared with.
    std::string compare = "none";  // see theory/comparisons.hpp
    std::string model = "plasma";  // or mesh
    long mode_x = 1, mode_z = 0;
    long fastest_x = 0;  // that mode_x = mode_z = 0 stands for; found by validate()
    double near = 0;
    double growth_tolerance = 0.01, frequency_tolerance = 0.005;

    // How often, in 1/omega_p; 0: never.
    double fields_interval = 0, particles_interval = 0, phase_interval = 0;
    long modes = 0;
    long phase_bins_x = 128, phase_bins_v = 128;
    double phase_v_max = 0;
    bool spectrum = false;
    common::FileFormats also;
    long checkpoint_steps = 0;

    /// The weighting, the scheme and the dimensions as numbers.
    Scheme scheme() const {
        return {weighting == "ngp" ? 0 : (weighting == "cic" ? 1 : 2), conserving == "energy",
                int(dimensions)};
    }
    bool magnetized() const { return B.size() > 0; }
    /// Whether the magnetic field turns what moves along x, axis 0, or along z, axis 2.
    bool turns(std::size_t axis) const { return B.y != 0 || (axis == 0 ? B.z : B.x) != 0; }
    /// Whether some species has its velocities by formula.
    bool has_distributions() const {
        return std::ranges::any_of(species, &SpeciesCase::has_distribution);
    }
    /// The axis of gyration, 0, 1 or 2: the largest component of B, and y without a field.
    std::size_t axis() const {
        const double x = std::fabs(B.x), y = std::fabs(B.y), z = std::fabs(B.z);
        return x > y && x >= z ? 0 : z > y ? 2 : 1;
    }
    bool is_box() const { return boundary_x == "wall" && boundary_z == "wall"; }
    bool has_walls() const { return boundary_x == "wall" || boundary_z == "wall"; }
};

/// The perturbations of a species: its own and those of the list.
inline std::vector<PerturbationCase> perturbations_of(const Case& parameters,
                                                      const SpeciesCase& s) {
    std::vector<PerturbationCase> all;
    if (s.amplitude != 0)
        all.push_back({"species." + s.name, s.name, s.mode_x, s.mode_z, s.amplitude, s.wave});
    for (const PerturbationCase& p : parameters.perturbations) {
        if (p.species != s.name) continue;
        all.push_back(p);
        all.back().name = "perturbation." + p.name;
    }
    return all;
}

}  // namespace cic
