// The results of a block between two smooth plates, whatever the scheme: pressed slowly, pressed and
// held, pressed in cycles.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/theory/compare_grains.hpp"

namespace mpm::theory {

/// The number of the plate that presses, which moves along y: theory.plate, or the first that does; that of
/// the block if there is none.
inline std::size_t pressing_plate(const PlannedCase& planned) {
    const std::string& name = planned.parameters.plate;
    for (std::size_t g = 0; g < planned.plans.size(); ++g) {
        const PlannedGrain& plan = planned.plans[g];
        const auto leaves = [&](const TravelRow& row) { return row.y != plan.table.front().y; };
        const bool moves = plan.from.velocity_y != 0 || plan.from.swing_y != 0 ||
                           std::ranges::any_of(plan.table, leaves);
        if (planned.is_rigid(plan) && moves && (name.empty() || plan.name == name)) return g;
    }
    return planned.target();
}

/// Whether the block cannot widen along x: it fills the mesh between rollers, or around a period.
inline bool is_confined(const PlannedCase& planned) {
    const Mesh mesh = planned.parameters.problem.mesh();
    const Bounds box = bounds(planned.plans[planned.target()].outline);
    return box.x_high - box.x_low > mesh.length_x() - 1e-6 * mesh.h &&
           (mesh.periodic_x ||
            (planned.has_wall(x_low, "slip") && planned.has_wall(x_high, "slip")));
}

/// Needs an upright box between two rigid plates without friction, of which one moves along y.
inline void need_press(const PlannedCase& planned) {
    planned.refuse_gravity();
    const Problem& problem = planned.parameters.problem;
    const PlannedGrain& block = planned.plans[planned.target()];
    planned.refuse(planned.free_grains() != 1 || planned.plans.size() != 3 ||
                       block.from.shape != "box" || block.from.angle != 0 ||
                       problem.has_friction() || pressing_plate(planned) == planned.target(),
                   " needs one upright box between two rigid plates without friction, of which one "
                   "moves along y");
    const Material& m = planned.material_of(block);
    planned.refuse(m.law != Law::elastic && (m.law != Law::j2 || m.hardening != 0),
                   " knows what is elastic, and what has law = \"j2\" and hardening = 0: change "
                   "[material." +
                       m.name + "]");
    const Bounds box = bounds(block.outline);
    for (const PlannedGrain& plan : planned.plans) {
        if (&plan == &block) continue;
        const Bounds plate = bounds(plan.outline);
        const double gap =
            std::min(std::fabs(plate.y_low - box.y_high), std::fabs(plate.y_high - box.y_low));
        planned.refuse(plan.from.velocity_y * (plate.y_low - box.y_low) > 0,
                       ": plate '" + plan.name + "' moves away from '" + block.name +
                           "': turn its velocity_y");
        planned.refuse(
            plate.x_low > box.x_low || plate.x_high < box.x_high || gap > 1e-6 * problem.mesh().h,
            ": plate '" + plan.name + "' does not cover a whole side of '" + block.name +
                "': make it wider, and let them touch");
    }
}

/// What the plate has done to the block, row by row.
struct Press {
    double width, height;  // of the block at the start
    double modulus;        // stress over strain while it is elastic
    std::string source;
    std::vector<double> strain, stress;  // engineering ones, positive
};

inline Press press_of(const FinishedRun& run) {
    const PlannedCase& planned = run.planned;
    const Bounds box = bounds(planned.plans[planned.target()].outline);
    const Material& m = run.material();
    const bool confined = is_confined(planned);
    Press press{box.x_high - box.x_low,
                box.y_high - box.y_low,
                confined ? moduli(m).lambda + 2 * moduli(m).G : plane_strain_modulus(m.E, m.nu),
                confined ? "lambda + 2 G" : "E/(1 - nu^2)",
                {},
                {}};
    const std::string& plate = planned.plans[pressing_plate(planned)].name;
    for (const double way : run.history.column("travel_y_" + plate))
        press.strain.push_back(std::fabs(way) / press.height);
    for (const double force : run.history.column("force_y_" + plate))
        press.stress.push_back(std::fabs(force) / press.width);
    return press;
}

/// What a wrong stress on a plate is due to. As measured: what is pressed by 0.027 has layers off by 0.03 with gimp
/// and by 0.05 with nu = 0.49, by 0.008 it has not.
inline std::string press_hint(const FinishedRun& run, const Press& press) {
    const double strain = *std::max_element(press.strain.begin(), press.strain.end()),
                 nu = run.material().nu;
    return (strain > 0.01
                ? "particles that cross lines of nodes make noise, and the block is pressed by " +
                      format(strain) +
                      (nu > 0.4 ? " with nu = " + format(nu) +
                                      ", which makes it stiff where its volume would change"
                                : "") +
                      ": press it by less than a hundredth, over many periods of its sound, with "
                      "its "
                      "surfaces on lines of nodes"
                : "plates are exact on lines of nodes: move them over many periods of the block's "
                  "sound, with its surfaces on lines of nodes, and lower time.alpha" +
                      std::string(run.parameters.shape == "gimp"
                                      ? ""
                                      : ", or take method.shape = \"gimp\"")) +
           (run.planned.scheme.implicit && run.planned.scheme.theta < 0.6
                ? "; method.theta = 0.6 damps noise"
                : "");
}

// ---- pressed slowly -----------------------------------------------------------------------------

/// Needs a press; what can yield has to be free to widen.
inline void need_billet(const PlannedCase& planned) {
    need_press(planned);
    const Material& m = planned.material_of(planned.plans[planned.target()]);
    planned.refuse(m.law == Law::j2 && is_confined(planned),
                   " knows no limit for a block that cannot widen: make it narrower than the mesh");
}

/// The mean stress along y of each layer of particles, from below, at the end: the rows of the lattice that they
/// came from, pressed as the block is. An end that is below a quarter of a row is of the next one.
inline std::vector<double> stress_of_layers(const FinishedRun& run, const Press& press) {
    const PlannedCase& planned = run.planned;
    const Grain& block = run.grain();
    const Particles& at = run.all.particles;
    const Mesh mesh = run.parameters.problem.mesh();
    const Bounds box = bounds(planned.plans[planned.target()].outline);
    const double per_row = double(run.parameters.problem.per_side) / mesh.h,
                 bottom = (box.y_low - mesh.y_low) * per_row, first = std::floor(bottom + 0.25),
                 rows = std::ceil((box.y_high - mesh.y_low) * per_row - 0.25) - first;
    double low = box.y_low;
    for (const PlannedGrain& plan : planned.plans)
        if (planned.is_rigid(plan) && plan.outline.y < low)
            low += run.history.column("travel_y_" + plan.name).back();
    const double stretch = 1 - press.strain.back();
    std::vector<double> sum(std::size_t(rows), 0.0), volume = sum;
    for (long k = block.begin; k < block.end; ++k) {
        const auto p = std::size_t(k);
        const double row = bottom + (at.y_p[p] - low) * per_row / stretch - first;
        const auto n = std::size_t(std::clamp(row, 0.0, rows - 1));
        sum[n] += at.V_p[p] * at.syy_p[p], volume[n] += at.V_p[p];
    }
    for (std::size_t n = 0; n < sum.size(); ++n)
        if (volume[n] > 0) sum[n] /= volume[n];  // what is empty bears nothing
    return sum;
}

/// Its modulus while it is elastic, and the most that it bears when it can yield but not harden.
inline void compare_billet(const FinishedRun& run, common::Summary& summary) {
    const Press press = press_of(run);
    const Material& m = run.material();
    summary.hint(press_hint(run, press));
    summary.result_info("strain", press.strain.back(), "1", "at the end");
    if (m.law == Law::j2) {
        const double limit = plane_strain_strength(m.yield_stress);
        summary.result("limit", press.stress.back() / limit, "1", 1, run.parameters.tolerance,
                       "stress on the plate at the end, over 2 Y/3^1/2, a plane block's limit");
        return;
    }
    const std::vector<double> layers = stress_of_layers(run, press);
    const std::size_t beside = std::size_t(run.parameters.problem.per_side), all = layers.size();
    double bulk = 0, off = 0;
    for (std::size_t n = 2 * beside; n + 2 * beside < all; ++n)
        bulk += layers[n] / double(all - 4 * beside);
    for (std::size_t n = 0; n < beside; ++n)
        for (const double layer : {layers[n], layers[all - 1 - n]})
            if (const double d = std::fabs(layer / bulk - 1); !(d <= off)) off = d;  // NaN, too
    // The force belongs to a time within the last step, at which the plate was not yet so far.
    const std::vector<double> times = run.history.column("time");
    const std::size_t last = times.size() - 1;
    const double rate =
        (press.strain[last] - press.strain[last - 1]) / (times[last] - times[last - 1]);
    const double across = is_confined(run.planned) ? 0 : m.nu / (1 - m.nu),
                 e = press.strain[last] -
                     (1 - run.planned.scheme.force_level) * run.scales.dt * rate,
                 exact =
                     pressed_stress(press.modulus, across, run.planned.scheme.volumes_change, e) /
                     e;
    summary.result(
        "modulus", press.stress.back() / e, "stress", exact, run.parameters.tolerance * exact,
        press.source + ": stress on the plate over strain in the last step, at finite strain");
    if (all <= 4 * beside)
        return summary.not_measured("layers_beside_plates", "the block is not five cells high");
    summary.result_at_most(
        "layers_beside_plates", off, "1", 0.02,
        "stress of the particles within a cell of a plate, over that in the bulk: "
        "largest difference of a layer at the end");
}

// ---- pressed and held ---------------------------------------------------------------------------

/// When the plate has come to rest, but for its swing; 0 for one that only swings.
inline double time_of_rest(const PlannedCase& planned) {
    const PlannedGrain& plate = planned.plans[pressing_plate(planned)];
    const double table = plate.table.empty() ? 0 : plate.table.back().t, stop = plate.from.stop;
    return plate.from.velocity_y == 0 ? table
           : stop > 0                 ? std::max(table, stop + planned.parameters.problem.rise)
                                      : 1e300;
}

/// Needs an elastic press whose plate stops in the first half of the run.
inline void need_hold(const PlannedCase& planned) {
    need_press(planned);
    const PlannedGrain& plate = planned.plans[pressing_plate(planned)];
    planned.refuse(
        planned.material_of(planned.plans[planned.target()]).law != Law::elastic ||
            plate.from.swing_y != 0 || time_of_rest(planned) > 0.5 * planned.parameters.end,
        " needs an elastic block, and a plate that has come to rest, at stop + load.rise, when "
        "half of the run is over");
}

/// The stress that holds it, and whether it stays at rest, in the second half of the run.
inline void compare_hold(const FinishedRun& run, common::Summary& summary) {
    const Press press = press_of(run);
    const auto times = run.history.column("time"), kinetic = run.history.column("kinetic"),
               elastic = run.history.column("elastic");
    double stress = 0, rows = 0, third = 0, last = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        if (times[n] < 0.5 * run.end) continue;
        stress += press.stress[n], rows += 1;
        double& quarter = times[n] < 0.75 * run.end ? third : last;
        quarter = std::max(quarter, kinetic[n] / elastic[n]);
    }
    summary.hint(press_hint(run, press));
    summary.result("modulus", stress / rows / press.strain.back(), "stress", press.modulus,
                   run.parameters.tolerance * press.modulus,
                   press.source + ": mean stress on the plate over strain");
    summary.hint(rest_hint(run));
    summary.result_at_most("kinetic_over_elastic", std::max(third, last), "1", 1e-6,
                           "at rest, in the second half of the run");
    summary.result_at_most("kinetic_grows", last - third, "1", 1e-8,
                           "over the elastic energy, the last quarter less the third");
}

// ---- any run of one grain between plates that have come to rest ---------------------------------

/// Whether an elastic grain that plates hold keeps pressing on them: the mean of the forces on all of
/// them in the last tenth of the time that they have been at rest, over that in the first. It needs
/// tenths of three times the way there and back of sound through the grain, which is nearly at rest when
/// the plates come to rest.
inline void judge_held_grain(const FinishedRun& run, common::Summary& summary) {
    const PlannedCase& planned = run.planned;
    const Problem& problem = planned.parameters.problem;
    const PlannedGrain& held = planned.plans[planned.target()];
    if (planned.free_grains() != 1 || planned.rigid_grains() == 0 || problem.gravity_x != 0 ||
        problem.gravity_y != 0 || planned.material_of(held).law != Law::elastic)
        return;
    const auto times = run.history.column("time");
    std::vector<double> force(times.size(), 0.0);
    std::size_t rest = 0;  // the row since which no plate has moved
    long seen = 0;
    for (const PlannedGrain& plan : planned.plans) {
        if (!planned.is_rigid(plan) || ++seen > 16) continue;  // the history has columns of so many
        if (plan.from.control != "velocity") return;
        for (const char* axis : {"x_", "y_"}) {
            const auto travel = run.history.column(std::string("travel_") + axis + plan.name),
                       push = run.history.column(std::string("force_") + axis + plan.name);
            for (std::size_t n = 0; n < times.size(); ++n) {
                force[n] += std::fabs(push[n]);
                if (travel[n] != travel.back()) rest = std::max(rest, n + 1);
            }
        }
    }
    const Bounds box = bounds(held.outline);
    const double size = std::max(box.x_high - box.x_low, box.y_high - box.y_low),
                 c = sound_speed(planned.material_of(held));
    const std::size_t tenth = (times.size() - std::min(rest, times.size())) / 10;
    if (tenth < 8 || times[rest + tenth] - times[rest] < 6 * size / c) return;
    const double kinetic = run.history.column("kinetic")[rest],
                 elastic = run.history.column("elastic")[rest];
    if (!(kinetic < 0.1 * elastic)) return;
    double first = 0, last = 0;
    for (std::size_t n = 0; n < tenth; ++n)
        first += force[rest + n], last += force[force.size() - 1 - n];
    if (first == 0) return;
    summary.hint(
        "stress that is held turns into noise of the mesh where nothing damps what rings: set "
        "material.<name>.viscosity = " +
        format(0.1 * run.scales.dt) +
        ", a tenth of a step, or in mpm_implicit method.theta = 0.55");
    summary.result("held_force", last / first, "1", 1, 0.02,
                   "on plates at rest: in the last tenth of that time, over the first");
}

// ---- any run of grains that come to rest under their weight -------------------------------------

/// Whether grains that have come to rest under their weight stay at rest: their largest kinetic energy
/// after a twentieth of the run in which it was below 1e-4 of the elastic energy, over that; "rest" has
/// narrower results. It needs plates at rest, and twentieths of three times the way there and back of sound through the mesh.
inline void judge_weight(const FinishedRun& run, common::Summary& summary) {
    const PlannedCase& planned = run.planned;
    const Problem& problem = planned.parameters.problem;
    if ((problem.gravity_x == 0 && problem.gravity_y == 0) || run.parameters.compare == "rest")
        return;
    for (const PlannedGrain& plan : planned.plans)
        if (planned.is_rigid(plan) && !planned.is_fixed(plan)) return;
    const auto times = run.history.column("time"), kinetic = run.history.column("kinetic"),
               elastic = run.history.column("elastic");
    const Mesh mesh = problem.mesh();
    const std::size_t part = times.size() / 20;
    if (part < 8 || times[part] < 6 * (mesh.y_high() - mesh.y_low) / run.scales.sound_speed) return;
    double rest = 0, after = 0;  // elastic energy of the part at rest; kinetic energy since
    for (std::size_t n = 0; n + part <= times.size(); n += part) {
        const auto largest = *std::max_element(&kinetic[n], &kinetic[n] + part);
        if (rest > 0)
            after = std::max(after, largest);
        else if (times[n] >= problem.rise && largest < 1e-4 * elastic[n])
            rest = elastic[n];
    }
    if (after == 0) return;
    summary.hint(rest_hint(run));
    summary.result_at_most("kinetic_after_rest", after / rest, "1", 1e-3,
                           "kinetic energy since grains have come to rest under their weight, over "
                           "the elastic energy");
}

// ---- pressed in cycles --------------------------------------------------------------------------

/// When the last whole cycle of a swing begins.
inline double last_cycle(const Case& parameters, double period) {
    return (std::floor(parameters.end * (1 - 1e-9) / period) - 1) * period;
}

/// Needs a press whose plate swings on after its preload; what can yield must not widen nor part.
inline void need_cycle(const PlannedCase& planned) {
    need_press(planned);
    planned.refuse_viscosity();
    const PlannedGrain &block = planned.plans[planned.target()],
                       &plate = planned.plans[pressing_plate(planned)];
    const Material& m = planned.material_of(block);
    const double T = plate.from.period,
                 preload = plate.from.velocity_y * plate.from.stop / block.from.height;
    planned.refuse(
        plate.from.swing_y == 0 || last_cycle(planned.parameters, T) < time_of_rest(planned) + T,
        " needs a plate with a swing_y, and two whole periods after it has come to rest "
        "otherwise");
    const Moduli c = moduli(m);
    planned.refuse(
        m.law == Law::j2 &&
            (!is_confined(planned) || preload * plate.from.swing_y <= 0 ||
             std::fabs(preload) * (c.lambda + 2.0 / 3 * c.G) < 2.0 / 3 * m.yield_stress),
        " of what yields needs a block as wide as the mesh, between rollers or periodic, and a "
        "velocity that presses it before by a stress above 2/3 of yield_stress");
}

/// The work that the block keeps in the last whole cycle, and its stiffness.
inline void compare_cycle(const FinishedRun& run, common::Summary& summary) {
    const Press press = press_of(run);
    const Material& m = run.material();
    const GrainCase& plate = run.planned.plans[pressing_plate(run.planned)].from;
    const double begin = last_cycle(run.parameters, plate.period), end = begin + plate.period;
    const auto times = run.history.column("time");
    const auto gain = [&](const char* name) {
        const auto values = run.history.column(name);
        const auto at = [&](double t) {
            const auto n = std::max<std::size_t>(
                1, std::lower_bound(times.begin(), times.end() - 1, t) - times.begin());
            const double s = (t - times[n - 1]) / (times[n] - times[n - 1]);
            return values[n - 1] + s * (values[n] - values[n - 1]);
        };
        return at(end) - at(begin);
    };
    const SchemeFacts& scheme = run.planned.scheme;
    summary.hint((scheme.implicit && scheme.theta > 0.5
                      ? "method.theta = " + format(scheme.theta) +
                            " takes energy in every cycle: lower it, or time.alpha; "
                      : std::string()) +
                 press_hint(run, press));
    const double volume = press.width * press.height,
                 range = std::fabs(plate.swing_y) / press.height,
                 low = std::fabs(plate.velocity_y) * plate.stop / press.height;
    const std::string source = "in the last whole cycle";
    if (m.law == Law::j2) {
        const double exact = uniaxial_loop_area(m.yield_stress, moduli(m).G, range),
                     tolerance = run.parameters.tolerance * exact;
        summary.result("loop_area", gain("external") / volume, "stress", exact, tolerance,
                       "work of the plate per volume " + source + ": (4/3) Y (range - Y/G)");
        summary.result("plastic_work", gain("plastic") / volume, "stress", exact, tolerance,
                       "per volume " + source + ": all that it keeps");
        return;
    }
    const double stored = press.modulus * range * (low + 0.5 * range);
    // Between two rows the work of the plate is taken as linear, where its velocity changes sign.
    const double share = run.scales.dt * double(run.parameters.history_steps) / plate.period;
    summary.result("loop_area", gain("external") / (volume * stored), "1",
                   cycle_loss(press.modulus, range, run.planned.scheme.force_level,
                              run.scales.dt / plate.period) /
                       stored,
                   1e-4 + 2 * share * share,
                   "work of the plate " + source +
                       ", over what it stores: all comes back but (f - 1/2) pi^2/2 M range^2 dt/T");
    double softest = 1e300, hardest = 0;
    for (std::size_t n = 0; n < times.size(); ++n)
        if (times[n] >= begin && times[n] <= end)
            softest = std::min(softest, press.stress[n]),
            hardest = std::max(hardest, press.stress[n]);
    summary.result("modulus", (hardest - softest) / range, "stress", press.modulus,
                   run.parameters.tolerance * press.modulus,
                   press.source + ": range of the stress over that of the strain " + source);
}

}  // namespace mpm::theory
