// What a comparison with theory is, whatever the scheme: one object with its name, what it needs of
// the case, its results, and the columns it adds to the history. Each program lists its own in its
// theory/compare_with_theory.hpp; from the list come
//     before the run:  the choices of theory.compare; what it needs, or the case is refused
//     every row:       its columns
//     after the run:   its results in summary.json
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "common/run/history.hpp"
#include "common/run/summary.hpp"
#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/setup/plan_grains.hpp"
#include "mpm_explicit/setup/scales.hpp"

namespace mpm::theory {

/// The properties of a scheme that comparisons use.
struct SchemeFacts {
    // How far the energy may change, relative; infinite for a scheme that is meant to take energy.
    double rebound_tolerance = 0, bar_tolerance = 0;
    double theta = 0.5;      // level of velocities and stresses in the step
    double force_level = 1;  // in a step of a plate, of the travel whose stress it works against
    double bond_level = 0;   // of the stress of bonds in a row, in steps from its time
    bool implicit = false, consistent_mass = false;
    bool damps_first = false;    // load.damping, before forces act: then waves see a stiffer body
    bool volumes_change = true;  // in forces, with the strain
};

/// A case with the outlines and materials of its grains.
struct PlannedCase {
    const Case& parameters;
    SchemeFacts scheme;
    std::vector<Material> materials = materials_of(parameters.problem);
    std::vector<PlannedGrain> plans = plan_grains(parameters.problem, materials);

    /// What a grain is made of, whether it is rigid, and how many are, or are not.
    const Material& material_of(const PlannedGrain& plan) const { return materials[plan.material]; }
    bool is_rigid(const PlannedGrain& plan) const { return material_of(plan).law == Law::rigid; }
    long rigid_grains() const {
        return std::count_if(plans.begin(), plans.end(), [&](auto& p) { return is_rigid(p); });
    }
    long free_grains() const { return long(plans.size()) - rigid_grains(); }

    /// Whether it is a rigid grain that stays where it is.
    bool is_fixed(const PlannedGrain& plan) const {
        const GrainCase& from = plan.from;
        return is_rigid(plan) && from.control == "velocity" && from.velocity_x == 0 &&
               from.velocity_y == 0 && from.swing_x == 0 && from.swing_y == 0 && plan.table.empty();
    }

    /// The number of the target grain: theory.grain, or the first that is not rigid.
    std::size_t target() const {
        const auto found = std::find_if(plans.begin(), plans.end(), [&](auto& plan) {
            return parameters.grain.empty() ? !is_rigid(plan) : plan.name == parameters.grain;
        });
        return found == plans.end() ? 0 : found - plans.begin();
    }

    /// Whether every grain has this profile of its velocity.
    bool has_profile(const char* name) const {
        return std::all_of(plans.begin(), plans.end(), [&](const PlannedGrain& plan) {
            return plan.from.profile == name && plan.from.amplitude != 0;
        });
    }
    /// Whether this stands at an end of the mesh.
    bool has_wall(Side side, const char* kind) const {
        return parameters.problem.walls[side] == kind;
    }

    /// errors: InputError for a grain with viscosity, where the theory is of bodies without
    void refuse_viscosity() const {
        for (const PlannedGrain& plan : plans)
            refuse(material_of(plan).viscosity > 0 && !is_rigid(plan),
                   " is with a body without viscosity: set material." + material_of(plan).name +
                       ".viscosity = 0");
    }

    /// errors: InputError for a case with gravity, where the theory is of bodies without weight
    void refuse_gravity() const {
        refuse(parameters.problem.gravity_x != 0 || parameters.problem.gravity_y != 0,
               " is with bodies without weight: take out load.gravity_x and load.gravity_y");
    }

    /// errors: InputError 'theory.compare = "..."' with the sentence, where it is impossible
    void refuse(bool impossible, const std::string& sentence) const {
        mpm::refuse(impossible, "theory.compare = \"" + parameters.compare + "\"" + sentence);
    }
};

/// The energy that the center of mass has and keeps, which no verdict on energy counts: none where anything but the
/// grains themselves changes their momentum, or where there is hardly another motion.
inline double energy_of_drift(const common::History& history, const Assembly& all) {
    const auto x = history.column("momentum_x"), y = history.column("momentum_y");
    double m = 0;
    for (const Grain& grain : all.grains)
        for (long p = grain.begin; p < grain.end && !grain.rigid; ++p) m += all.particles.m_p[p];
    const double allowed = 1e-6 * std::sqrt(2 * m * history.largest("kinetic"));
    for (std::size_t n = 0; n < x.size(); ++n)
        if (std::hypot(x[n] - x[0], y[n] - y[0]) > allowed) return 0;
    const double drift = m > 0 && !x.empty() ? 0.5 * (x[0] * x[0] + y[0] * y[0]) / m : 0;
    return drift < (1 - 1e-4) * history.first("energy") ? drift : 0;
}

/// A run that has ended.
struct FinishedRun {
    const PlannedCase& planned;
    const Scales& scales;
    const Assembly& all;
    const common::History& history;
    double end;  // time
    const Case& parameters = planned.parameters;

    /// By how much stiffer: exp(c dt/2).
    double stiffening() const {
        return planned.scheme.damps_first ? std::exp(0.5 * parameters.problem.damping * scales.dt)
                                          : 1;
    }
    /// The target grain, its material, mass, and momentum along x in every row.
    const Grain& grain() const { return all.grains[planned.target()]; }
    const Material& material() const { return planned.materials[grain().material]; }
    double mass() const {
        double m = 0;
        for (long p = grain().begin; p < grain().end; ++p) m += all.particles.m_p[p];
        return m;
    }
    std::vector<double> momentum_x() const { return history.column("momentum_x_" + grain().name); }
};

/// One comparison. What it does not have is null.
struct Comparison {
    const char* name;
    void (*needs)(const PlannedCase&) = nullptr;  // refuses a case that it cannot be made for
    void (*result)(const FinishedRun&, common::Summary&) = nullptr;
    void (*columns)(const PlannedCase&, const Assembly&, common::Row&) = nullptr;
};

/// The choices of theory.compare.
inline std::vector<std::string> names_of(std::span<const Comparison> comparisons) {
    std::vector<std::string> names{"none"};
    for (const Comparison& comparison : comparisons) names.emplace_back(comparison.name);
    return names;
}

/// The comparison that a case asks for; null for none.
inline const Comparison* comparison_of(const Case& parameters,
                                       std::span<const Comparison> comparisons) {
    for (const Comparison& comparison : comparisons)
        if (comparison.name == parameters.compare) return &comparison;
    return nullptr;
}

/// Refuses a case that cannot be compared as it asks.
/// errors: InputError with what is missing
inline void validate_comparison(const PlannedCase& planned, const Scales& scales,
                                std::span<const Comparison> comparisons) {
    const Case& parameters = planned.parameters;
    const Comparison* comparison = comparison_of(parameters, comparisons);
    if (comparison == nullptr) return;
    for (const auto& [key, name, rigid] : {std::tuple("theory.grain", parameters.grain, false),
                                           std::tuple("theory.plate", parameters.plate, true)}) {
        if (name.empty()) continue;
        const std::string place = std::string(key) + ": ";
        const auto found = std::find_if(planned.plans.begin(), planned.plans.end(),
                                        [&, &n = name](auto& plan) { return plan.name == n; });
        mpm::refuse(found == planned.plans.end(), place + "there is no grain '" + name + "'");
        mpm::refuse(
            planned.is_rigid(*found) != rigid,
            place + "'" + name + "' is " + (rigid ? "not " : "") + "rigid: name another grain");
    }
    if (comparison->needs != nullptr) comparison->needs(planned);
    const long rows = scales.steps / parameters.history_steps;
    planned.refuse(rows < 10,
                   " needs at least 10 rows of history, and there would be " +
                       std::to_string(rows) + ": raise time.end or lower " +
                       (parameters.history_steps > 1 ? "output.history_steps" : "time.alpha"));
}

}  // namespace mpm::theory
