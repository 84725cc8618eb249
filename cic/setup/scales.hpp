// The scales of a case: what --dry-run says, and warnings where mesh and time step do not resolve
// them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cic/theory/comparisons.hpp"

namespace cic {

/// The scales of one species.
struct SpeciesScales {
    std::string name;
    double omega_p = 0, thermal_speed = 0, drift = 0, Omega_c = 0;
    double debye_length = 0;  // of this species alone; 0 for a cold one
    double peak = 1;          // the largest density over the mean
    long particles = 0;
};

/// The scales of a run.
struct Scales {
    std::vector<SpeciesScales> species;
    double omega_p = 0;       // of all mobile species together
    double debye_length = 0;  // of all warm ones together; 0 when all are cold
    double largest_omega_p = 0, least_debye_length = 0;  // the same where the plasma is densest
    long steps = 0, particles = 0;
    double most = 0;     // particles, with those that a source wall emits
    double bytes = 0;    // memory that the run will take, of a rank
    double seconds = 0;  // on one core
    double of_mesh = 0;  // of these, on the mesh
};

/// How many particles of a species there will be: those loaded or, of a source wall, what comes in
/// while a thermal particle crosses the box, where that is more.
inline double most_particles(const Case& parameters, const SpeciesCase& s) {
    const double crossing = parameters.grid.x.length / std::sqrt(s.emission_temperature / s.mass);
    return std::max(double(particle_count(parameters, s)), s.emission * parameters.grid.z.length *
                                                               std::min(crossing, parameters.end) /
                                                               particle_weight(parameters, s));
}

/// The scales of a case whose mesh has its boundaries.
inline Scales scales_of(const Case& parameters) {
    Scales s;
    double inverse_debye2 = 0, largest_inverse = 0;
    long components = parameters.dimensions + (parameters.magnetized() ? 3 : parameters.dimensions);
    for (const SpeciesCase& k : parameters.species) {
        if (!k.mobile()) continue;
        SpeciesScales scale;
        scale.name = k.name;
        const double omega2 = k.mean_density() * k.charge * k.charge / k.mass;
        scale.omega_p = std::sqrt(omega2);
        const std::array<double, 3> T = k.temperatures(parameters.axis());
        scale.thermal_speed = std::sqrt(std::ranges::max(T) / k.mass);
        scale.drift = std::hypot(k.drift_x, k.drift_y, k.drift_z);
        scale.Omega_c = std::fabs(k.charge) * parameters.B.size() / k.mass;
        scale.debye_length = omega2 > 0 ? scale.thermal_speed / scale.omega_p : 0;
        scale.particles = particle_count(parameters, k);
        scale.peak = k.tables.peak;
        if (scale.debye_length > 0) {
            inverse_debye2 += 1 / std::pow(scale.debye_length, 2);
            largest_inverse =
                std::max(largest_inverse, scale.peak / std::pow(scale.debye_length, 2));
        }
        if (k.profile != "point") {
            s.omega_p = std::hypot(s.omega_p, scale.omega_p);
            s.largest_omega_p = std::max(s.largest_omega_p, std::sqrt(scale.peak) * scale.omega_p);
        }
        s.particles += scale.particles;
        s.most += most_particles(parameters, k);
        s.species.push_back(scale);
    }
    s.debye_length = inverse_debye2 > 0 ? 1 / std::sqrt(inverse_debye2) : 0;
    // Species may be dense at different places: at least what one has, and all have in the mean.
    s.largest_omega_p = std::max(s.largest_omega_p, s.omega_p);
    s.least_debye_length =
        inverse_debye2 > 0 ? 1 / std::sqrt(std::max(largest_inverse, inverse_debye2)) : 0;
    s.steps = std::lround(parameters.end / parameters.dt);
    // Species are sorted one after the other.
    long sorted = 0;
    if (parameters.dimensions == 2 && parameters.sort_interval > 0)
        for (const SpeciesScales& one : s.species) sorted = std::max(sorted, one.particles);
    // A rank has the blocks of its share; what a sort gives to others comes and goes through lists.
    const int ranks = common::rank_count(), blocks = (common::block_count + ranks - 1) / ranks;
    const double share = double(blocks) / common::block_count;
    // The density of every species is deposited once more where fields are written.
    const double meshes = (blocks + 9) + (parameters.fields_interval > 0 ? blocks + 7 : 0);
    s.bytes = share * double(components) * s.most * sizeof(Real) +
              share * double(sorted) *
                  (sizeof(Real) + sizeof(int) + (ranks > 1 ? 2 * sizeof(double) : 0)) +
              double(parameters.grid.size()) * meshes * sizeof(double) +
              (ranks > 1 ? 10 * 1048576 : 0);  // of MPI
    // The factors of the matrix of a box.
    if (parameters.is_box()) {
        const double points = double(parameters.grid.size());
        s.bytes += 30 * points * std::log2(points);
    }
    s.of_mesh = double(s.steps) * 30 * double(parameters.grid.size()) / 80e6;
    s.seconds = s.of_mesh + double(s.steps) * s.most / 80e6;
    return s;
}

/// What a sentence adds to largest_omega_p where the density varies; nothing for a uniform plasma.
inline std::string where_densest(const Scales& scales) {
    return scales.largest_omega_p > 1.001 * scales.omega_p ? " where the plasma is densest" : "";
}

namespace detail {

inline long largest_prime_factor(long number) {
    long largest = 1;
    for (long factor = 2; factor * factor <= number; ++factor)
        for (; number % factor == 0; number /= factor) largest = factor;
    return std::max(largest, number);
}

// Runs in which particles fly straight on: no field acts on them for long enough, or none that they
// make together.
inline void warn_of_idleness(const Case& parameters, const Scales& scales,
                             std::vector<std::string>& warnings) {
    if (parameters.end == 0) return;
    double omega_p = 0, Omega_c = 0;
    bool cold = false, driven = false;  // from outside
    for (const SpeciesScales& s : scales.species) {
        omega_p = std::hypot(omega_p, s.omega_p);
        Omega_c = std::max(Omega_c, s.Omega_c);
        cold = cold || (s.omega_p > 0 && s.debye_length == 0);
    }
    for (const SpeciesCase& s : parameters.species) driven = driven || s.emission > 0;
    for (const WallCase& wall : parameters.walls) driven = driven || wall.potential != 0;
    common::warn(warnings, scales.steps == 0, "time.end = ", parameters.end,
                 " is below half of time.dt = ", parameters.dt, ": no step is taken");
    if (omega_p == 0 || driven || Omega_c * parameters.end > 0.1) return;
    common::warn(warnings, omega_p * parameters.end < 0.1,
                 "omega_p time.end = ", omega_p * parameters.end,
                 " is below 0.1: particles fly straight on, their field has no time to act; raise "
                 "time.end, which is in units of 1/omega_p of density 1, charge 1, mass 1");
    const Grid& grid = parameters.grid;
    const double box =
        parameters.dimensions == 2 ? std::max(grid.x.length, grid.z.length) : grid.x.length;
    common::warn(warnings, !cold && box < scales.debye_length, "the box has ",
                 box / scales.debye_length,
                 " Debye lengths, below 1: particles cross it before their field can act; make it "
                 "longer than ",
                 scales.debye_length);
}

// Cold plasma that the momentum scheme sets in motion: its force is not the gradient of an energy.
inline void warn_of_cold_plasma(const Case& parameters, const Scales& scales,
                                std::vector<std::string>& warnings) {
    if (parameters.conserving != "momentum" || parameters.gauss_sign < 0) return;
    const Grid& grid = parameters.grid;
    const bool plane = parameters.dimensions == 2;
    const double dx = plane ? std::max(grid.x.spacing(), grid.z.spacing()) : grid.x.spacing();
    double omega2 = 0, Omega_y = 0, Omega_oblique = 0;
    const MagneticField& B = parameters.B;
    for (const SpeciesScales& s : scales.species) {
        const auto own = std::ranges::find(parameters.species, s.name, &SpeciesCase::name);
        // Who crosses a tenth of a cell in 1/omega_p does not see long what grows there; ions are slow.
        if (own->profile != "uniform" || s.omega_p < 0.5 * scales.omega_p ||
            s.thermal_speed + s.drift > 0.1 * s.omega_p * dx)
            continue;
        omega2 += s.omega_p * s.omega_p;
        const double per_B = s.Omega_c / std::max(B.size(), 1e-300);
        Omega_y = std::max(Omega_y, per_B * std::fabs(B.y));
        Omega_oblique = std::max(Omega_oblique, per_B * std::min(std::fabs(B.x), std::fabs(B.z)));
    }
    const double omega_p = std::sqrt(omega2);
    // As measured; in one dimension by the matrix of the displacements of cells, (1/N)^1/2 of many.
    const double at_walls = !(parameters.boundary_x == "wall" && !parameters.turns(0)) &&
                                    !(parameters.boundary_z == "wall" && !parameters.turns(2))
                                ? 0
                            : plane
                                ? 0.5 * omega_p * parameters.end
                                : std::sqrt(0.8 / double(grid.x.cells)) * omega_p * parameters.end;
    common::warn(warnings, at_walls > 5,
                 "a cold plasma that touches walls does not rest in the momentum scheme: the field "
                 "on the nodes of a wall drives it, and noise grows as exp(",
                 at_walls, ") by time.end: take method.scheme = \"energy\"");
    const double across = std::max(std::fabs(B.x), std::fabs(B.z));
    const bool by_y = plane && Omega_y > 0.1 * omega_p && Omega_y < 1.5 * omega_p,
               oblique = plane && Omega_oblique > 0.12 * omega_p &&
                         std::min(std::fabs(B.x), std::fabs(B.z)) > 0.15 * across;
    const double in_field = (by_y ? 0.08 : oblique ? 0.06 : 0) * omega_p * parameters.end;
    common::warn(warnings, in_field > 10, by_y ? "B_y" : "B oblique to the mesh",
                 " turns forces of the momentum scheme, which on a mesh are not along k, into "
                 "growth: waves of some cells in a cold plasma grow as up to exp(",
                 in_field, ") by time.end: take method.scheme = \"energy\"");
}

// A mesh of the momentum scheme that does not resolve the Debye lengths: of all species, or of those that
// it will heat while others are resolved.
inline void warn_of_heating(const Case& parameters, const Scales& scales, double dx,
                            std::vector<std::string>& warnings) {
    // Where each kind of weighting stops heating.
    const double least =
        parameters.weighting == "ngp" ? 0.6 : (parameters.weighting == "cic" ? 1 / pi : 0.15);
    const auto too_short = [&](double length) {
        return length > 0 && length < (1 - 1e-4) * least * dx;
    };
    if (parameters.conserving != "momentum" || !too_short(scales.least_debye_length)) return;
    std::string names;
    double length = scales.least_debye_length, shortest = HUGE_VAL;
    bool resolves_one = false;
    for (const SpeciesScales& s : scales.species) {
        if (s.debye_length == 0) continue;
        const double least_length = s.debye_length / std::sqrt(s.peak);
        if (!too_short(least_length))
            resolves_one = true;
        else
            names += (names.empty() ? "" : " and ") + s.name,
                shortest = std::min(shortest, least_length);
    }
    const bool some = resolves_one && !names.empty();
    if (some) length = shortest;
    common::warn(warnings, true, "the Debye length ", some ? "of " + names + " " : "", "is ",
                 length / dx, " cells, below ", least, " for ", parameters.weighting,
                 ": the mesh will heat ", some ? names : "the plasma", "; refine it to cells of ",
                 length / least);
}

// A diode whose source emits more than its own charge lets through: what returns is emitted again.
// source: Child, Phys. Rev. 32, 492 (1911); Langmuir, Phys. Rev. 2, 450 (1913).
inline void warn_of_space_charge(const Case& parameters, std::vector<std::string>& warnings) {
    const WallCase &low = parameters.walls[x_low], &high = parameters.walls[x_high];
    const auto emits = [](const SpeciesCase& s) { return s.emission > 0; };
    if (parameters.dimensions != 1 || parameters.magnetized() || !parameters.has_walls() ||
        low.particles != "source" || low.field != "grounded" || high.field != "grounded" ||
        std::ranges::count_if(parameters.species, emits) != 1 ||
        std::ranges::any_of(parameters.species,
                            [&](const SpeciesCase& s) { return !emits(s) && s.charge != 0; }))
        return;
    const SpeciesCase& s = *std::ranges::find_if(parameters.species, emits);
    const double q = std::fabs(s.charge), V = (low.potential - high.potential) * s.charge / q;
    if (q == 0 || !(q * V > 10 * s.emission_temperature)) return;
    const double most = 4.0 / 9 * std::sqrt(2 * q / s.mass) * std::pow(V, 1.5) /
                        (q * std::pow(parameters.grid.x.length, 2));
    common::warn(warnings, s.emission > 1.1 * most, s.name, ".emission = ", s.emission,
                 " is above the space-charge limit of Child and Langmuir, "
                 "4/9 (2 q/m)^1/2 V^3/2/(q d^2) = ",
                 most,
                 ": what returns to the source is emitted again, and particles pile up there "
                 "without end; lower the emission, or raise the potential");
}

}  // namespace detail

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> resolution_warnings(const Case& parameters, const Scales& scales) {
    std::vector<std::string> warnings;
    const auto warn = [&](const auto&... pieces) { warnings.push_back(sentence(pieces...)); };
    detail::warn_of_idleness(parameters, scales, warnings);
    detail::warn_of_cold_plasma(parameters, scales, warnings);
    const Grid& grid = parameters.grid;
    const double dx = parameters.dimensions == 2 ? std::max(grid.x.spacing(), grid.z.spacing())
                                                 : grid.x.spacing();
    const double omega_dt = scales.largest_omega_p * parameters.dt;
    if (omega_dt > 0.5 && parameters.gauss_sign > 0)
        warn("omega_p dt = ", omega_dt, where_densest(scales), " is above 0.5: frequencies ",
             parameters.magnetized() ? "along B " : "", "are ",
             100 * (2 / omega_dt * std::asin(0.5 * omega_dt) - 1),
             " % too high; at 2 the leapfrog blows up, and from 0.8 or so on it heats a warm "
             "plasma without end");
    detail::warn_of_heating(parameters, scales, dx, warnings);
    detail::warn_of_space_charge(parameters, warnings);
    if (const std::string driven = likely_driven_by_mesh(parameters); !driven.empty())
        warnings.push_back(driven);
    for (const SpeciesScales& s : scales.species) {
        const auto own = std::ranges::find(parameters.species, s.name, &SpeciesCase::name);
        const double through = parameters.dimensions == 2 ? std::hypot(own->drift_x, own->drift_z)
                                                          : std::fabs(own->drift_x);
        if (s.thermal_speed == 0 && s.drift > 0 && scales.omega_p > 0) {
            const double u = s.drift / (scales.omega_p * dx);
            const double safe = cold_beam_threshold(parameters.weighting == "tsc" ? 2 : 1);
            if (parameters.conserving == "energy" && u < safe)
                warn(s.name, ": a cold beam at ", u, " omega_p dx is below ", safe,
                     ", where the energy-conserving mesh stops it; refine the mesh");
        }
        // As measured: in 1000/omega_p 13 % of the drift with one cell, 85 % with 0.2.
        if (parameters.conserving == "energy" && s.debye_length > 0 &&
            s.debye_length < (1 + 1e-4) * dx && through > 0.05 * s.thermal_speed)
            warn(s.name, ": the Debye length is ", s.debye_length / dx,
                 " cells, not above 1: in some hundred 1/omega_p the energy-conserving mesh brakes "
                 "the drift; refine it, or take method.scheme = \"momentum\"");
        if (s.drift + s.thermal_speed > 2 * dx / parameters.dt)
            warn(s.name, ": particles move ", (s.drift + s.thermal_speed) * parameters.dt / dx,
                 " cells in a step; below 2 they see the field they cross");
        if (s.Omega_c * parameters.dt > 1)
            warn(s.name, ": Omega_c dt = ", s.Omega_c * parameters.dt,
                 " is above 1: gyration is slowed by the time step to ",
                 std::atan(0.5 * s.Omega_c * parameters.dt) / (0.5 * s.Omega_c * parameters.dt),
                 " of its frequency; drifts stay right");
    }
    const auto warn_of_slow_transform = [&](const std::string& what, long count) {
        const long factor = detail::largest_prime_factor(count);
        if (factor > 200)
            warn(what, " = ", count, " has the prime factor ", factor,
                 ", above 200: its Fourier transforms take about ", factor / 20,
                 " times as long as those of a product of 2, 3 and 5");
    };
    if (grid.x.periodic) warn_of_slow_transform("grid.cells_x", grid.x.cells);
    if (grid.z.periodic) warn_of_slow_transform("grid.cells_z", grid.z.cells);
    if (parameters.spectrum)
        warn_of_slow_transform("output.spectrum: time.end / time.dt", scales.steps);
    const std::vector<std::pair<const char*, double>> intervals{
        {"output.fields_interval", parameters.fields_interval},
        {"output.particles_interval", parameters.particles_interval},
        {"output.phase_interval", parameters.phase_interval}};
    for (const auto& [name, interval] : intervals)
        if (interval > 0 && interval < parameters.dt)
            warn(name, " = ", interval, " is below time.dt = ", parameters.dt,
                 ": files are written every step");
    double emission = 0;
    bool followed = false;
    for (const SpeciesCase& s : parameters.species) {
        emission += s.emission;
        followed =
            followed || (s.ripple != 0 && std::abs(s.mode_x) == std::abs(parameters.mode_x) &&
                         s.mode_x * parameters.mode_z == s.mode_z * parameters.mode_x);
        for (const PerturbationCase& p : perturbations_of(parameters, s))
            followed = followed || p.is_of(parameters.mode_x, parameters.mode_z) ||
                       p.is_of(-parameters.mode_x, -parameters.mode_z);
    }
    if (parameters.walls[x_low].particles == "source" && emission == 0)
        warn(
            "boundary.particles_x_low = \"source\", and every emission is 0: the wall only gives "
            "back what reaches it, with emission_temperature");
    const Comparison& comparison = comparison_of(parameters);
    comparison.add_warnings(parameters, warnings);
    const bool one_mode = parameters.mode_x != 0 || parameters.mode_z != 0;
    if (comparison.follows_mode && one_mode && !followed)
        warn("no species is perturbed in the followed ",
             mode_text(parameters.mode_x, parameters.mode_z), ": only noise can start the wave");
    return warnings;
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& parameters, const Scales& scales) {
    const double dx = parameters.grid.x.spacing();
    std::string text;
    const auto line = [&](const std::string& name, const auto&... pieces) {
        const std::string gap(name.size() < 34 ? 34 - name.size() : 1, ' ');
        text += "  " + name + gap + sentence(pieces...) + "\n";
    };
    const Grid& grid = parameters.grid;
    const auto ends = [](const std::string& boundary) {
        return boundary == "wall" ? "walls" : boundary;
    };
    std::string mesh = std::to_string(grid.x.cells) + " cells of " + format(dx);
    if (parameters.dimensions == 2)
        mesh = std::to_string(grid.x.cells) + " x " + std::to_string(grid.z.cells) + " cells of " +
               format(dx) + " x " + format(grid.z.spacing());
    line("mesh", mesh, ", ", ends(parameters.boundary_x), " in x",
         (parameters.dimensions == 2 ? ", " + ends(parameters.boundary_z) + " in z" : ""));
    line("method", parameters.weighting, " weighting, ", parameters.conserving, "-conserving",
         (parameters.gauss_sign < 0 ? ", div E = -rho as the slide prints it" : ""));
    line("steps", scales.steps, " of ", parameters.dt);
    line("particles", scales.particles);
    line("unit of frequency", "omega_p of density 1, charge 1, mass 1");
    if (scales.omega_p > 0)
        line("all mobile species together", "omega_p = ", scales.omega_p,
             ", omega_p dt = ", scales.omega_p * parameters.dt,
             (scales.debye_length > 0 ? ", Debye length = " + format(scales.debye_length) + " = " +
                                            format(scales.debye_length / dx) + " dx"
                                      : ", cold"));
    for (const SpeciesScales& s : scales.species)
        line(s.name, s.particles, " particles, omega_p = ", s.omega_p, ", v_th = ", s.thermal_speed,
             ", speed of the drift = ", s.drift,
             (s.Omega_c > 0 ? ", Omega_c = " + format(s.Omega_c) : ""));
    for (const auto& [name, value] : comparison_of(parameters).describe(parameters))
        line(name, value);
    line("memory", "about ", scales.bytes / 1048576, " MiB");
    line("time", "about ", scales.seconds, " s on one core");
    return text;
}

}  // namespace cic
