// The parameters of both programs: name, unit, allowed range and meaning of everything a case can say.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "implicit_moment/setup/case.hpp"
#include "implicit_moment/theory/wave_theory.hpp"

namespace implicit_moment {

namespace detail {

inline void describe_species(common::ParameterTable& table, const std::string& prefix,
                             SpeciesCase& s) {
    using common::anything, common::above, common::at_least, common::between;
    const auto real = [&](const std::string& name, double& value, const char* unit,
                          common::Range allowed, const std::string& meaning) {
        table.real(prefix + "." + name, value, unit, allowed, meaning);
    };
    real("density", s.density, "n0", above(0), "number density");
    real("charge", s.charge, "e", anything(), "charge of one particle");
    real("mass", s.mass, "m_i", above(0), "mass of one particle");
    real("drift_x", s.drift_x, "c", between(-1000, 1000), "mean velocity along x, v or gamma v");
    real("drift_y", s.drift_y, "c", between(-1000, 1000), "mean velocity out of the plane");
    real("drift_z", s.drift_z, "c", between(-1000, 1000), "mean velocity along z");
    const auto each = [&](const std::string& name, std::array<double*, 3> values, const char* unit,
                          common::Range allowed, const std::string& what, const char* of) {
        for (std::size_t a = 0; a < 3; ++a)
            real(name + "xyz"[a], *values[a], unit, allowed, what + " of v_" + "xyz"[a] + of);
    };
    const char* seeded = " in the seeded mode";
    each("temperature_", {&s.temperature_x, &s.temperature_y, &s.temperature_z}, "m_i c^2",
         at_least(0), "temperature", "");
    each("wave_", {&s.wave_x, &s.wave_y, &s.wave_z}, "c", between(-1, 1), "amplitude", seeded);
    each("phase_", {&s.phase_x, &s.phase_y, &s.phase_z}, "degree", anything(), "phase", seeded);
}

inline void describe_current_sheet(common::ParameterTable& table, Case& w) {
    using common::at_least, common::above, common::between;
    CurrentSheetCase& s = w.current_sheet;
    table.derive = [&w] {
        if (w.is_along_current()) fit_mesh_to_sheet(w);
    };
    table.group("thin current sheet, current along x (plasma.setup = current_sheet)");
    table.real("current_sheet.mass_ratio", s.mass_ratio, "", between(1, 1e6), "m_i/m_e");
    table.real("current_sheet.light_over_alfven", s.light_over_alfven, "", between(1, 1e6),
               "c/v_A; B0 is its inverse");
    table.real("current_sheet.temperature_ratio", s.temperature_ratio, "", between(1e-6, 1e6),
               "T_i/T_e");
    table.real("current_sheet.drift", s.drift, "(2 T_i/m_i)^(1/2)", above(0),
               "drift of the ions; L = rho_i/drift");
    table.real("current_sheet.background", s.background, "n0", at_least(0),
               "density of the plasma at rest");
    table.real("current_sheet.length_x", s.length_x, "L", above(0),
               "box along the current; sets grid.length_x");
    table.real("current_sheet.length_z", s.length_z, "L", between(5, 1000),
               "box across the sheet; sets grid.length_z");
    table.whole("current_sheet.particles", s.particles, "", between(2, 4e8),
                "simulation particles of both species");
}

// Mesh, time and plasma: what both programs are told.
inline void describe_plasma(common::ParameterTable& table, Case& w) {
    using common::anything, common::above, common::at_least, common::between;
    table.group("mesh: the plane (x, z), nothing depends on y");
    table.whole("grid.cells_x", w.grid.x.cells, "", between(4, 4096), "cells along x");
    table.whole("grid.cells_z", w.grid.z.cells, "", between(4, 4096), "cells along z");
    table.real("grid.length_x", w.grid.x.length, "d_i", above(0), "length of the box along x");
    table.real("grid.length_z", w.grid.z.length, "d_i", above(0), "length of the box along z");
    table.choice(
        "grid.boundary_x", w.boundary_x, {"periodic", "wall", "reflecting"},
        "ends of x; a wall conducts and reflects; reflecting: and the plasma goes on up to it, "
        "which linear splines without smoothing (explicit_em) do not see");
    table.choice("grid.boundary_z", w.boundary_z, {"periodic", "wall", "reflecting"}, "ends of z");

    table.group("time");
    table.real("time.dt", w.dt, "1/omega_pi", above(0), "time step");
    table.real("time.end", w.end, "1/omega_pi", at_least(0), "length of the run");

    table.group("plasma");
    table.choice("plasma.setup", w.setup, {"harris", "uniform", "current_sheet"},
                 "a Harris sheet across its current, a uniform plasma, or a sheet along it");
    table.choice("plasma.loading", w.loading, {"quiet", "random"},
                 "radical inverses or random numbers");
    table.whole("plasma.seed", w.seed, "", between(0, 1e9), "another number, another realization");

    table.group("Harris current sheet (plasma.setup = harris)");
    table.real("harris.mass_ratio", w.harris.mass_ratio, "", between(1, 1e6), "m_i/m_e");
    table.real("harris.light_over_alfven", w.harris.light_over_alfven, "", between(1, 1e6),
               "c/v_A; B0 is its inverse");
    table.real("harris.temperature_ratio", w.harris.temperature_ratio, "", between(1e-6, 1e6),
               "T_i/T_e");
    table.real("harris.thickness", w.harris.thickness, "d_i", above(0),
               "lambda of B_x = B0 tanh(z/lambda)");
    table.real("harris.background", w.harris.background, "n0", at_least(0),
               "density of the plasma at rest");
    table.real("harris.perturbation", w.harris.perturbation, "B0 d_i", anything(),
               "flux psi0 of the seeded island");
    table.real("harris.guide_field", w.harris.guide_field, "B0", anything(),
               "uniform B_y out of the plane, along the current");
    table.real("harris.normal_field", w.harris.normal_field, "B0", between(0, 0.5),
               "B_z across the sheet in its middle row, a tail; needs reflecting ends of x");
    table.whole("harris.particles", w.harris.particles, "", between(2, 4e8),
                "simulation particles of both species");

    detail::describe_current_sheet(table, w);

    table.group(
        "uniform plasma (plasma.setup = uniform); the seeded mode is amplitude * cos(k x + phase)");
    table.whole("uniform.particles_per_cell", w.uniform.particles_per_cell, "", between(1, 1e6),
                "of each species");
    table.real("uniform.B_x", w.uniform.B_x, "m_i c omega_pi/e", anything(),
               "uniform magnetic field along x");
    table.real("uniform.B_y", w.uniform.B_y, "m_i c omega_pi/e", anything(), "out of the plane");
    table.real("uniform.B_z", w.uniform.B_z, "m_i c omega_pi/e", anything(), "along z");
    table.real("uniform.E_x", w.uniform.E_x, "m_i c omega_pi/e", anything(),
               "uniform electric field along x at the start");
    table.real("uniform.E_y", w.uniform.E_y, "m_i c omega_pi/e", anything(), "out of the plane");
    table.real("uniform.E_z", w.uniform.E_z, "m_i c omega_pi/e", anything(), "along z");
    table.whole("uniform.mode_x", w.uniform.mode_x, "", between(-2048, 2048),
                "seeded wavelengths in length_x");
    table.whole("uniform.mode_z", w.uniform.mode_z, "", between(-2048, 2048),
                "seeded wavelengths in length_z");
    const auto field = [&](const std::string& name, double& amplitude, double& phase) {
        table.real("uniform.wave_" + name, amplitude, "m_i c omega_pi/e", anything(),
                   "amplitude of " + name + " in the seeded mode");
        table.real("uniform.phase_" + name, phase, "degree", anything(),
                   "phase of " + name + " in the seeded mode");
    };
    field("B_x", w.uniform.wave_B_x, w.uniform.phase_B_x);
    field("B_y", w.uniform.wave_B_y, w.uniform.phase_B_y);
    field("B_z", w.uniform.wave_B_z, w.uniform.phase_B_z);
    field("E_x", w.uniform.wave_E_x, w.uniform.phase_E_x);
    field("E_y", w.uniform.wave_E_y, w.uniform.phase_E_y);
    field("E_z", w.uniform.wave_E_z, w.uniform.phase_E_z);
    table.list("species", w.uniform.species, detail::describe_species,
               "a species of the uniform plasma, [species.<name>]");
}

inline void describe_smoothing(common::ParameterTable& table, Case& w, const char* meaning) {
    using common::between;
    table.whole("field.smoothing_passes", w.field.smoothing.passes, "", between(0, 100), meaning);
    table.flag("field.smoothing_compensation", w.field.smoothing.compensate,
               "last pass restores long waves to fourth order");
}

// Comparison and output.
inline void describe_results(common::ParameterTable& table, Case& w) {
    using common::at_least, common::between;
    table.group("comparison with theory (uniform plasma)");
    std::vector<std::string> names{"none"};
    for (const Wave& wave : waves()) names.push_back(wave.name);
    table.choice("theory.wave", w.wave, names,
                 "exact for the scheme in vacuum or cold plasma; kinetic dispersion relation");
    table.choice("theory.component", w.component, {"E_x", "E_y", "E_z", "B_x", "B_y", "B_z"},
                 "whose seeded mode is followed");
    table.real("theory.near", w.near, "omega_pi", at_least(0),
               "frequency near which the root is sought; 0: fastest growing (not of those that "
               "need it)");

    table.group("output");
    table.real("output.fields_interval", w.fields_interval, "1/omega_pi", at_least(0),
               "time between fields files; 0: none");
    table.real("output.particles_interval", w.particles_interval, "1/omega_pi", at_least(0),
               "time between particles files; 0: none");
    table.real("output.profile_interval", w.profile_interval, "1/omega_pi", at_least(0),
               "time between profile files of a current sheet; 0: none");
    table.flag("output.vtk", w.also.vtk, "also write .vti and .vtp for ParaView");
    table.flag("output.openpmd", w.also.openpmd, "also write .h5, HDF5 after openPMD");
    table.whole("output.checkpoint_steps", w.checkpoint_steps, "", between(0, 1e9),
                "steps between checkpoints; 0: only when stopped");
    table.may_change_on_restart({"time.end", "output."});
}

}  // namespace detail

/// The table of all parameters of implicit_moment: names, units, ranges and meanings of the fields
/// of a Case, which hold the defaults.
inline common::ParameterTable describe(Case& w) {
    using common::between;
    common::ParameterTable table;
    detail::describe_plasma(table, w);

    table.group("field equations");
    table.real("field.theta", w.field.theta, "", between(0.5, 1),
               "time level of E: 0.5 conserves energy, 1 damps fast waves");
    table.choice("field.response", w.field.response, {"moments", "mass_matrix"},
                 "current that E drives: the slide's prediction, or the particles' own, which "
                 "conserves energy for any step");
    table.choice(
        "field.rotation", w.field.rotation, {"particles", "mesh"},
        "moments: what R turns, each particle before it is deposited, or the sums, as the slide");
    table.choice("field.B_level", w.field.B_level, {"by_response", "start", "middle"},
                 "time of the B that rotates particles: t^n (moments), or t^n + dt/2, of second "
                 "order (mass_matrix)");
    table.choice("field.solver", w.field.solver, {"gmres", "newton_krylov"},
                 "newton_krylov: moments, B of the rotation at the theta level; mass_matrix, "
                 "particles felt along their whole path, which keeps Gauss's law as well");
    table.real("field.tolerance", w.field.tolerance, "", between(0, 1e-2),
               "residual over right-hand side; 0: 1e-8 with moments, 1e-12 with mass_matrix");
    table.whole("field.max_iterations", w.field.max_iterations, "", between(1, 1e5),
                "before the run ends with status 3");
    detail::describe_smoothing(table, w, "binomial passes on sources and on the pushing field");

    table.group("particle mover");
    table.real("mover.tolerance", w.mover.tolerance, "cell", between(1e-14, 0.1),
               "the midpoint is found when it moves by less");
    table.whole("mover.max_iterations", w.mover.max_iterations, "", between(2, 1000),
                "before a particle's step is halved");
    table.flag("particles.relativistic", w.mover.relativistic,
               "momentum m gamma v; false: m v at any speed");

    detail::describe_results(table, w);
    return table;
}

/// The table of explicit_em, whose defaults are the explicit run of the talk's cost slide.
inline common::ParameterTable describe_explicit(Case& w) {
    using common::between;
    w.leapfrog.chosen = true;
    w.grid.x.cells = 512, w.grid.z.cells = 256;
    w.dt = 0.03, w.end = 380;
    w.harris = w.initial_harris();
    w.field.smoothing.passes = 0;
    w.history_steps = 20;
    common::ParameterTable table;
    detail::describe_plasma(table, w);

    table.group("particles and field");
    table.whole("particles.order", w.leapfrog.order, "", between(1, 2),
                "of the spline of the charge: 1 linear, 2 quadratic");
    table.flag("particles.relativistic", w.leapfrog.relativistic,
               "momentum m gamma v; false: m v at any speed");
    detail::describe_smoothing(table, w, "binomial passes on J and on the pushing field");

    detail::describe_results(table, w);
    table.whole("output.history_steps", w.history_steps, "", between(1, 1e6),
                "steps from one row of history.dat to the next");
    return table;
}

}  // namespace implicit_moment
