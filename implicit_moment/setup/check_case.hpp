// What is looked at before a run starts: combinations that cannot run, scales that are not
// resolved, and the closure of the method.  [IMM-13]
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "implicit_moment/output/sheet_diagnostics.hpp"
#include "implicit_moment/setup/case.hpp"
#include "implicit_moment/setup/cost.hpp"
#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/theory/wave_theory.hpp"

namespace implicit_moment {

/// The kinetic scales of one species in a case.
struct SpeciesScales {
    std::string name;
    double thermal_speed = 0;  // sqrt(T/m), the largest direction [c]
    double omega_p_dt = 0;     // plasma frequency
    double Omega_c_dt = 0;     // gyrofrequency at the largest B
    double debye_length = 0;   // [d_i]
    double beyond_c = 0;       // part of its particles that is faster than light
};

/// The part of a drifting Maxwellian that is faster than light.
///     mean over directions d of  erfc(r/2^1/2) + (2/pi)^1/2 r exp(-r^2/2),  |u + r v d| = c
/// in:     drift u and thermal speeds v, by component
inline double part_beyond_c(const Eigen::Array3d& u, const Eigen::Array3d& v) {
    const int rings = 32, around = 64;
    if (u.square().sum() >= c * c) return v.square().sum() > 0 ? 1 : 0;
    double part = 0;
    for (int n = 0; n < rings * around; ++n) {
        const double up = 2 * (n / around + 0.5) / rings - 1,
                     angle = 2 * pi * (n % around + 0.5) / around, flat = std::sqrt(1 - up * up);
        const Eigen::Array3d spread =
            v * Eigen::Array3d(flat * std::cos(angle), flat * std::sin(angle), up);
        const double a = spread.square().sum(), b = (u * spread).sum(),
                     r = (-b + std::sqrt(b * b + a * (c * c - u.square().sum()))) / a;
        if (a > 0)
            part += std::erfc(r / std::sqrt(2.0)) + std::sqrt(2 / pi) * r * std::exp(-0.5 * r * r);
    }
    return part / (rings * around);
}

/// What a case comes to: scales of its species, and the size of the run.
struct Scales {
    std::vector<SpeciesScales> species;
    double B = 0;  // largest B at the start
    long steps = 0, particles = 0;
    double bytes = 0;                 // memory that the run will take, each rank
    double seconds = 0, of_mesh = 0;  // on one core; of these, what is done on the mesh
};

/// The scales of a case, with densities in the middle of a sheet, or of its background where that is denser.
inline Scales scales_of(const Case& w) {
    Scales s;
    const auto add = [&](const std::string& name, double density, double charge, double mass,
                         double T) {
        SpeciesScales scale;
        scale.name = name;
        const double omega_p = std::sqrt(4 * pi * n0 * density * charge * charge / mass);
        scale.thermal_speed = std::sqrt(T / mass);
        scale.omega_p_dt = omega_p * w.dt;
        scale.Omega_c_dt = std::fabs(charge) * s.B / (mass * c) * w.dt;
        scale.debye_length = omega_p > 0 ? scale.thermal_speed / omega_p : 0;
        s.species.push_back(scale);
    };
    if (!w.is_uniform()) {
        const HarrisCase h = harris_of(w);
        const HarrisSheet sheet = harris_sheet(h);
        // A tail is F^2 times as dense at its end, and B is F times as strong.
        const double F = tail_of(h).F(0.5 * w.grid.x.length);
        s.B = std::hypot(F * sheet.B0, h.guide_field * sheet.B0);
        const double density = std::max(F * F, h.background);
        add("ions", density, 1, 1, sheet.T_i);
        add("electrons", density, -1, 1 / h.mass_ratio, sheet.T_e);
        for (SpeciesScales& k : s.species) {
            const double drift = k.name == "ions" ? sheet.u_i : sheet.u_e;
            k.beyond_c = part_beyond_c({0, drift, 0}, Eigen::Array3d::Constant(k.thermal_speed));
        }
        s.particles = 2 * (h.particles / 2);
    } else {
        const UniformCase& u = w.uniform;
        s.B = std::hypot(u.B_x, u.B_y, u.B_z);
        for (const SpeciesCase& k : u.species) {
            add(k.name, k.density, k.charge, k.mass,
                std::max({k.temperature_x, k.temperature_y, k.temperature_z}));
            const Eigen::Array3d T(k.temperature_x, k.temperature_y, k.temperature_z);
            s.species.back().beyond_c =
                part_beyond_c({k.drift_x, k.drift_y, k.drift_z}, (T / k.mass).sqrt());
            if (w.is_relativistic())
                s.species.back().Omega_c_dt /= std::sqrt(
                    1 + k.drift_x * k.drift_x + k.drift_y * k.drift_y + k.drift_z * k.drift_z);
        }
        s.particles =
            long(u.species.size()) * u.particles_per_cell * w.grid.x.cells * w.grid.z.cells;
    }
    s.steps = std::lround(w.end / w.dt);
    const double krylov = 45 * 3 * 8, tensors = 40 * 8, waves = 30 * 8;
    const bool follow = w.field.uses_mass_matrix() && w.field.solver == "newton_krylov";
    const double ranks = double(common::rank_count()), share = double(s.particles) / ranks;
    // As measured; where particles go to other ranks they are there twice for a moment, and MPI is large.
    s.bytes = (ranks > 1 ? 72 : 60) * share + (ranks > 1 ? 22 * 1048576 : 0) +
              double(w.grid.size()) * (krylov + tensors + waves);
    if (w.leapfrog.chosen) {
        // As measured: the particles and room to sort or to hand over, the mesh and its snapshots, the program.
        const double moments = w.fields_interval > 0 ? 85 : 60;
        s.bytes = (ranks > 1 ? 51 : 46) * share + 8 * moments * double(w.grid.size()) +
                  (common::has_ranks ? 22 : 10) * 1048576;
    }
    if (w.field.uses_mass_matrix()) s.bytes += double(w.grid.size()) * (detail::offsets + 10) * 8;
    // Paths, and currents of blocks with room for Anderson's acceleration.
    if (follow) s.bytes += 32 * share + double(w.grid.size()) * (48 + 75) * 8;
    const double per_second = w.leapfrog.chosen                   ? 40e6
                              : !w.field.uses_mass_matrix()       ? 15e6
                              : w.field.solver == "newton_krylov" ? 4e5
                                                                  : 7e6;
    s.of_mesh = double(s.steps) * 10 * double(w.grid.size()) / per_second;
    s.seconds = s.of_mesh + double(s.steps) * double(s.particles) / per_second;
    return s;
}

namespace detail {

inline void refuse_tail(const Case& w) {
    const HarrisCase h = harris_of(w);
    if (h.normal_field == 0) return;
    refuse(w.grid.x.periodic, "harris.normal_field = ", h.normal_field,
           " B0 makes a tail, which has two ends: set grid.boundary_x = \"reflecting\"");
    const TailSheet tail = tail_of(h);
    const double opens = 0.5 * h.normal_field * w.grid.z.length / h.thickness,
                 thick = h.thickness / tail.F(-0.5 * w.grid.x.length);
    refuse(opens > 1, "the field lines of the tail are turned by ", opens,
           " at the walls, more than 1: lower harris.normal_field or grid.length_z");
    refuse(thick > 0.25 * w.grid.z.length, "the tail is ", thick,
           " d_i thick at one end and does not fit between walls ", w.grid.z.length,
           " d_i apart: lower harris.normal_field or grid.length_x");
}

// The modes along the current have to fit.
inline void refuse_current_sheet(const Case& w) {
    refuse(w.grid.x.cells < least_cells_along_current, "grid.cells_x = ", w.grid.x.cells,
           ": the first 4 modes along the current are compared, so take ",
           least_cells_along_current, " or more");
}

inline void refuse_reconnection(const Case& w) {
    refuse(w.grid.z.cells % 2 != 0, "grid.cells_z = ", w.grid.z.cells,
           " is odd: the flux is measured on the row z = 0, so make it even");
}

inline void validate_sheet(const Case& w) {
    const HarrisCase h = harris_of(w);
    refuse(w.is_along_current() && w.boundary_x != "periodic",
           "a sheet along its current needs grid.boundary_x = \"periodic\"");
    refuse(w.boundary_z != "wall", "the Harris sheet needs grid.boundary_z = \"wall\"");
    refuse(h.thickness > 0.25 * w.grid.z.length, "harris.thickness = ", h.thickness,
           " d_i does not fit between walls ", w.grid.z.length,
           " d_i apart: at most a quarter of grid.length_z");
    refuse_tail(w);
    w.is_along_current() ? refuse_current_sheet(w) : refuse_reconnection(w);
    const HarrisSheet sheet = harris_sheet(h);
    const double fastest = std::max({sheet.u_i, std::fabs(sheet.u_e), sheet.v_e, sheet.v_i});
    refuse(fastest >= 1, "the sheet has speeds of ", fastest, " c (drift or thermal speed): raise ",
           w.setup, ".light_over_alfven above ", h.light_over_alfven * fastest);
    if (!w.uniform.species.empty()) {
        refuse(true, "[species.", w.uniform.species.front().name,
               "] belongs to plasma.setup = \"uniform\"; the Harris sheet makes its own ions and "
               "electrons");
    }
    refuse(wave_of(w) != nullptr, "theory.wave = \"", w.wave,
           "\" needs plasma.setup = \"uniform\"");
    // Pressure and current balance hold by construction; a wrong edit of harris_sheet ends
    // here.
    const double pressure = n0 * (sheet.T_i + sheet.T_e) / (sheet.B0 * sheet.B0 / (8 * pi));
    const double current_balance =
        n0 * (sheet.u_i - sheet.u_e) / (c * sheet.B0 / (4 * pi * h.thickness));
    refuse(!(std::fabs(pressure - 1) < 1e-12 && std::fabs(current_balance - 1) < 1e-12),
           "the Harris sheet is out of balance: pressure ", pressure, ", current ",
           current_balance);
}

// A wave of two cells that has its zeros where the mesh has the field or the current of its seed is none.
inline void refuse_seeds_at_zeros(const Case& w) {
    const UniformCase& u = w.uniform;
    const bool shortest_x = 2 * std::labs(u.mode_x) == w.grid.x.cells,
               shortest_z = 2 * std::labs(u.mode_z) == w.grid.z.cells;
    if (!((shortest_x || u.mode_x == 0) && (shortest_z || u.mode_z == 0))) return;
    const auto look = [&](const std::string& section, const std::string& field,
                          const VectorKind& kind, const std::array<double, 3>& seed,
                          const std::array<double, 3>& phase) {
        for (std::size_t a = 0; a < 3; ++a) {
            const int right =
                (shortest_x && kind.place[a].half_x) != (shortest_z && kind.place[a].half_z) ? 90
                                                                                             : 0;
            const std::string name = field + "xyz"[a];
            refuse(seed[a] != 0 && std::fabs(std::cos((phase[a] - right) * pi / 180)) < 0.01,
                   section, ".wave_", name,
                   " seeds a wave of two cells with its zeros where the mesh would see it: set ",
                   section, ".phase_", name, " = ", right);
        }
    };
    look("uniform", "E_", electric, {u.wave_E_x, u.wave_E_y, u.wave_E_z},
         {u.phase_E_x, u.phase_E_y, u.phase_E_z});
    look("uniform", "B_", magnetic, {u.wave_B_x, u.wave_B_y, u.wave_B_z},
         {u.phase_B_x, u.phase_B_y, u.phase_B_z});
    for (const SpeciesCase& s : u.species)
        look("species." + s.name, "", current, {s.wave_x, s.wave_y, s.wave_z},
             {s.phase_x, s.phase_y, s.phase_z});
}

inline void validate_uniform(const Case& w) {
    const UniformCase& u = w.uniform;
    const bool uniform_E = u.E_x != 0 || u.E_y != 0 || u.E_z != 0;
    const bool seeded = uniform_E || u.wave_B_x != 0 || u.wave_B_y != 0 || u.wave_B_z != 0 ||
                        u.wave_E_x != 0 || u.wave_E_y != 0 || u.wave_E_z != 0;
    const bool walls = w.boundary_x != "periodic" || w.boundary_z != "periodic";
    refuse(seeded && walls,
           "seeded fields need periodic boundaries: take out uniform.E_*, uniform.wave_E_*, "
           "uniform.wave_B_* or the walls");
    refuse(w.boundary_x == "wall" && u.B_x != 0, "uniform.B_x = ", u.B_x,
           " would cross the conducting walls normal to x: make it 0");
    refuse(w.boundary_z == "wall" && u.B_z != 0, "uniform.B_z = ", u.B_z,
           " would cross the conducting walls normal to z: make it 0");
    const double k_x = double(u.mode_x) / w.grid.x.length, k_z = double(u.mode_z) / w.grid.z.length;
    refuse(u.mode_x == 0 && u.mode_z == 0,
           "uniform.mode_x and uniform.mode_z are both 0: a mode needs a wave number");
    refuse(2 * std::labs(u.mode_x) > w.grid.x.cells || 2 * std::labs(u.mode_z) > w.grid.z.cells,
           "the seeded mode (", u.mode_x, ", ", u.mode_z,
           ") has more than one wavelength per two cells: refine the mesh or lower the mode");
    // Components in the plane that have one phase, or opposite ones: the sign of the second. Else 0.
    const auto in_step = [](double a, double b, double phase_a, double phase_b) {
        const double apart = std::fabs(std::remainder(phase_a - phase_b, 360));
        const double round_off = 1e-9;
        if (a == 0 || b == 0 || apart < round_off) return 1;
        return apart > 180 - round_off ? -1 : 0;
    };
    const auto turned = [](int sign) {
        return std::string(sign < 0 ? "; phases 180 apart turn the sign of one component" : "");
    };
    const int sign_B = in_step(u.wave_B_x, u.wave_B_z, u.phase_B_x, u.phase_B_z),
              sign_E = in_step(u.wave_E_x, u.wave_E_z, u.phase_E_x, u.phase_E_z);
    refuse(
        sign_B == 0 || sign_E == 0,
        "the two components in the plane of a wave at an angle to x and z have different phases: "
        "make uniform.phase_B_x and phase_B_z equal or 180 apart, and phase_E_x and phase_E_z");
    const double size_B = std::hypot(u.wave_B_x, u.wave_B_z) * std::hypot(k_x, k_z);
    refuse(std::fabs(k_x * u.wave_B_x + sign_B * k_z * u.wave_B_z) > 1e-9 * size_B,
           "the seeded B is not divergence-free: k . B must be 0, so keep uniform.wave_B across "
           "the mode" +
               turned(sign_B));
    const double size_E = std::hypot(u.wave_E_x, u.wave_E_z) * std::hypot(k_x, k_z);
    refuse(std::fabs(k_x * u.wave_E_x + sign_E * k_z * u.wave_E_z) > 1e-9 * size_E,
           "the seeded E has a part along k: that part follows from the charge, so seed it with "
           "the species' wave_x and wave_z" +
               turned(sign_E));
    for (const SpeciesCase& s : u.species) {
        const double T = std::max({s.temperature_x, s.temperature_y, s.temperature_z});
        const double drift = std::hypot(s.drift_x, s.drift_y, s.drift_z),
                     seed = std::hypot(s.wave_x, s.wave_y, s.wave_z);
        const double fastest = std::max({drift, seed, std::sqrt(T / s.mass)});
        refuse(
            fastest >= 1 && !w.is_relativistic(), "species '", s.name, "' has speeds of ", fastest,
            " c (drift, seed or thermal speed): lower them, or set particles.relativistic = true");
    }
    refuse(u.species.empty() && !seeded,
           "an empty uniform plasma: add a [species.<name>] or seed a field with uniform.wave_E_y");
    refuse_wave(w);
    refuse_seeds_at_zeros(w);
}

}  // namespace detail

/// Refuses what cannot run. errors: InputError, one sentence with the numbers and the cure.
inline void validate(Case& w) {
    common::require_formats(w.also);
    w.grid.x.periodic = w.boundary_x == "periodic", w.grid.x.mirrors = w.boundary_x == "reflecting";
    w.grid.z.periodic = w.boundary_z == "periodic", w.grid.z.mirrors = w.boundary_z == "reflecting";
    if (w.is_along_current()) fit_mesh_to_sheet(w);
    w.grid.x.low = -0.5 * w.grid.x.length;
    w.grid.z.low = -0.5 * w.grid.z.length;
    refuse(w.end / w.dt > 1e9, "time.end / time.dt is ", w.end / w.dt,
           " steps, more than 1e9: raise time.dt or lower time.end");

    refuse(w.field.B_level != "by_response" && w.field.solver == "newton_krylov",
           "field.solver = \"newton_krylov\" takes B at the level theta: take out field.B_level");
    refuse(w.field.uses_mass_matrix() && w.field.rotates_on_mesh(),
           "field.rotation = \"mesh\" turns moments: it needs field.response = \"moments\"");
    refuse(w.mover.relativistic && w.field.rotates_on_mesh(),
           "field.rotation = \"mesh\" turns the sums of all particles by one angle, and "
           "relativistic particles turn each by its own: take field.rotation = \"particles\"");
    refuse(w.mover.relativistic && !w.field.uses_mass_matrix() && w.field.solver == "newton_krylov",
           "field.solver = \"newton_krylov\" turns moments by one angle, and relativistic "
           "particles turn each by its own: take \"gmres\", or field.response = \"mass_matrix\"");
    refuse(w.field.tolerance > 0 && w.field.tolerance < 1e-13,
           "field.tolerance = ", w.field.tolerance,
           " is below 1e-13, what round-off leaves: raise it, or 0 for the default");
    w.is_uniform() ? detail::validate_uniform(w) : detail::validate_sheet(w);
}

/// Warnings of sections that the set-up does not read, of seeds and charges that walls do not let be, and of runs in which
/// particles fly straight on, because time or box are too short for any field to act on them. Where light is
/// seeded, it may be light that is followed.
inline std::vector<std::string> idleness_warnings(const Case& w, const Scales& scales) {
    std::vector<std::string> warnings;
    const auto unread = [&](const char* section, bool changed) {
        warn(warnings, w.setup != section && changed, "[", section,
             "] has no effect with plasma.setup = \"", w.setup, "\": take out what is there");
    };
    unread("harris", w.harris != w.initial_harris());
    unread("current_sheet", w.current_sheet != CurrentSheetCase{});
    unread("uniform", w.uniform != UniformCase{});
    for (const SpeciesCase& s : w.is_uniform() ? w.uniform.species : std::vector<SpeciesCase>{}) {
        const auto look = [&](const char* name, const common::Axis& axis, long mode, long other,
                              double wave, double phase) {
            const bool across = mode != 0 && other == 0,
                       moves = across ? std::fabs(std::cos(phase * pi / 180)) > 0.01
                                      : mode != 0 || wave_of(w) == nullptr;
            warn(warnings, !axis.periodic && wave != 0 && moves, "the seed of species '", s.name,
                 "' moves particles through the walls across ", name,
                 " and is no wave between them: ",
                 across
                     ? sentence("set its phase_", name, " = 90")
                     : sentence("take a mode along ", name, " alone, or its wave_", name, " = 0"));
        };
        look("x", w.grid.x, w.uniform.mode_x, w.uniform.mode_z, s.wave_x, s.phase_x);
        look("z", w.grid.z, w.uniform.mode_z, w.uniform.mode_x, s.wave_z, s.phase_z);
    }
    double charge = 0;
    if (w.is_uniform())
        for (const SpeciesCase& s : w.uniform.species) charge += s.density * s.charge;
    warn(warnings, std::fabs(charge) > 1e-9 && !(w.grid.x.periodic && w.grid.z.periodic),
         "the species together have a charge of ", charge,
         " e n0, and between walls nothing makes it neutral: add a species of the other charge");
    if (w.end == 0) return warnings;
    double omega_p = 0, Omega_c = 0, inverse_debye = 0;
    for (const SpeciesScales& s : scales.species) {
        omega_p = std::hypot(omega_p, s.omega_p_dt / w.dt);
        Omega_c = std::max(Omega_c, s.Omega_c_dt / w.dt);
        if (s.omega_p_dt > 0) inverse_debye = std::hypot(inverse_debye, 1 / s.debye_length);
    }
    const UniformCase& u = w.uniform;
    const double k = std::hypot(2 * pi * double(u.mode_x) / w.grid.x.length,
                                2 * pi * double(u.mode_z) / w.grid.z.length),
                 field = std::hypot(std::hypot(u.wave_B_x, u.wave_B_y, u.wave_B_z),
                                    std::hypot(u.wave_E_x, u.wave_E_y, u.wave_E_z)),
                 light = w.is_uniform() && field > 0 ? c * k : 0;
    warn(warnings, scales.steps == 0, "time.end = ", w.end, " is below half of time.dt = ", w.dt,
         ": no step is taken");
    if (std::max(Omega_c, light) * w.end > 0.1) return warnings;
    const bool acts = omega_p > 0 || light > 0;
    const bool none = scales.species.empty();
    warn(warnings, !acts && !none,
         "no species has a charge, and no field acts on any: give one a charge");
    warn(warnings, !acts && none,
         "there is no species for fields to act on: add a [species.<name>]");
    warn(warnings, acts && omega_p * w.end < 0.1, "omega_p time.end = ", omega_p * w.end,
         " and Omega_c time.end = ", Omega_c * w.end,
         " are below 0.1: fields have no time to act; raise time.end, which is in units of "
         "1/omega_pi");
    const double box = std::max(w.grid.x.length, w.grid.z.length) * inverse_debye;
    warn(warnings, inverse_debye > 0 && box < 1, "the box has ", box,
         " Debye lengths, below 1: particles cross it before their field can act; make it longer "
         "than ",
         1 / inverse_debye);
    return warnings;
}

/// Warnings of what is faster than light at the start, how many particles, of a drift E x B that would be, and of
/// sheets whose heat is relativistic.
inline std::vector<std::string> superluminal_warnings(const Case& w, const Scales& scales) {
    std::vector<std::string> warnings;
    const double each = double(scales.particles) / std::max(1.0, double(scales.species.size()));
    for (const SpeciesScales& s : scales.species) {
        warn(warnings, s.beyond_c * each >= 1, s.name, ": about ", std::round(s.beyond_c * each),
             " of ", each, " particles, ", 100 * s.beyond_c, " %, are loaded ",
             w.is_relativistic()
                 ? "with u = gamma v above c: temperatures and drifts are those of u"
                 : "faster than light, and the push is not relativistic");
    }
    if (const std::string why = no_balance(w); !why.empty()) warnings.push_back(why);
    if (!w.is_uniform()) return warnings;
    const UniformCase& u = w.uniform;
    const Eigen::Vector3d E(u.E_x, u.E_y, u.E_z), B(u.B_x, u.B_y, u.B_z);
    const double fast = B.norm() > 0 ? E.cross(B).norm() / B.squaredNorm() : 0;
    warn(warnings, w.is_relativistic() && !u.species.empty() && fast > 0.05 && fast < 1,
         "the drift c E/B would be ", fast,
         " c, above 0.05, and its theory has no Lorentz factor: lower uniform.E");
    warn(warnings, fast >= 1, "uniform.E across B is ", fast, " of B, and the drift E x B ",
         w.is_relativistic() ? "needs less than 1: particles run away"
                             : "would be that many times as fast as light",
         "; lower it, or raise uniform.B");
    return warnings;
}

/// Warnings with the number and the limit, for choices that run but may mislead.
/// source: [IMM-13] and its lower bound.
/// note:   the slide asks for v_th dt/dx < 1, so that a particle stays within what the fluid
///         equations can predict; in the plane, by the shortest wave along both directions. Plasmas
///         at rest, of omega_p dt = 25, burst at 0.96 and not at 0.85. Below about 1/20, where
///         omega_p dt > 1/2 and the Debye length is not resolved, the mesh does not damp what it
///         cannot resolve, and the finite-grid instability of all momentum-conserving methods may
///         heat the plasma.
inline std::vector<std::string> closure_warnings(const Case& w, const Scales& scales) {
    std::vector<std::string> warnings = idleness_warnings(w, scales);
    for (const std::string& warning : superluminal_warnings(w, scales)) warnings.push_back(warning);
    const double dx = w.grid.x.spacing(), dz = w.grid.z.spacing();
    for (const SpeciesScales& s : scales.species) {
        const double most = s.thermal_speed * w.dt / std::min(dx, dz);
        const bool moments = !w.field.uses_mass_matrix() || w.leapfrog.chosen;
        const bool far = most > 1 + 1e-6;  // but for round-off
        warn(warnings, far && !moments && w.field.solver == "gmres", s.name,
             ": v_th dt/dx = ", most,
             " is above 1: a particle deposits its current far from most of its path, watch the "
             "Gauss residual or lower time.dt to ",
             w.dt / most);
        const double in_plane = s.thermal_speed * w.dt * std::hypot(1 / dx, 1 / dz);
        warn(warnings, in_plane > 0.9 && moments, s.name,
             ": v_th dt (1/dx^2 + 1/dz^2)^1/2 = ", in_plane,
             " is above 0.9, where the moment closure fails [IMM-13]: lower time.dt to ",
             0.9 * w.dt / in_plane, " or take fewer cells");
        const bool unresolved = s.debye_length > 0 && s.debye_length < 0.3 * std::min(dx, dz);
        warn(warnings, most < 0.05 && unresolved && s.thermal_speed > 0 && s.omega_p_dt > 0.5,
             s.name, ": v_th dt/dx = ", most, " is below 0.05 and the Debye length is ",
             s.debye_length / std::min(dx, dz),
             moments ? " cells: finite-grid heating is possible, watch the energy"
                     : " cells: the mesh may turn drifts into heat, watch kinetic_" + s.name +
                           " and the momentum");
    }
    if (w.is_along_current()) {
        for (const std::string& warning : sheet_warnings(w)) warnings.push_back(warning);
    }
    const HarrisCase h = w.is_uniform() ? HarrisCase{} : harris_of(w);
    const double across = h.thickness / tail_of(h).F(0.5 * w.grid.x.length) / dz;
    warn(warnings, !w.is_uniform() && across < 1, "the sheet has ", 2 * across,
         " cells across its whole thickness", w.is_tail() ? " at its thin end" : "",
         ", below 2, and is not resolved: raise grid.cells_z, or lower ",
         w.is_along_current() ? "current_sheet" : "grid", ".length_z",
         w.is_tail() ? " or harris.normal_field" : "");
    for (const SpeciesScales& s : scales.species) {
        warn(warnings, s.Omega_c_dt > 2 * pi, s.name, ": Omega_c dt = ", s.Omega_c_dt,
             " is above 2 pi, gyration is not followed");
    }
    return warnings;
}

/// Refuses more ranks than implicit_moment has rows for.
inline void refuse_ranks(const Case& w) {
    const long rows = nodes_z(w.grid);
    refuse(common::rank_count() > std::max(1L, rows / rows_of_rank), common::rank_count(),
           " ranks, and the mesh has ", rows,
           " rows of nodes, of which each rank needs two: start fewer");
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& w, const Scales& scales) {
    const double dx = w.grid.x.spacing(), dz = w.grid.z.spacing();
    std::string text;
    const auto line = [&](const std::string& name, const auto&... pieces) {
        const std::string gap(name.size() < 34 ? 34 - name.size() : 1, ' ');
        text += sentence("  ", name, gap, pieces..., "\n");
    };
    line("mesh", w.grid.x.cells, " x ", w.grid.z.cells, " cells of ", dx, " x ", dz, " d_i, ",
         w.boundary_x, " in x, ", w.boundary_z, " in z");
    line("steps", scales.steps, " of ", w.dt, " / omega_pi, c dt/dx = ", c * w.dt / dx,
         ", c dt/dz = ", c * w.dt / dz);
    line("particles", scales.particles, ", ",
         double(scales.particles) / double(w.grid.x.cells * w.grid.z.cells), " per cell");
    if (scales.B > 0)
        line("magnetic field", scales.B, " m_i c omega_pi/e, Omega_ci dt = ", scales.B * w.dt);
    for (const SpeciesScales& s : scales.species)
        line(s.name, "omega_p dt = ", s.omega_p_dt, ", Omega_c dt = ", s.Omega_c_dt,
             ", v_th = ", s.thermal_speed, " c, v_th dt/dx = ", s.thermal_speed * w.dt / dx,
             " and ", s.thermal_speed * w.dt / dz, ", Debye length = ", s.debye_length, " d_i");
    if (w.is_uniform() && w.grid.x.periodic && w.grid.z.periodic) {
        double charge = 0;
        for (const SpeciesCase& s : w.uniform.species) charge += s.density * s.charge;
        if (std::fabs(charge) > 1e-12)
            line("fixed background", "of charge ", -charge,
                 " e n0, which makes the periodic box neutral");
    }
    if (!w.is_uniform() && !w.leapfrog.chosen)
        line("explicit instead", "about ", cost_ratio(harris_of(w).mass_ratio, 2),
             " times the time, by the slide's formula [COST]");
    line("memory", "about ", scales.bytes / 1048576, " MiB");
    line("time", "about ", scales.seconds, " s on one core");
    return text;
}

}  // namespace implicit_moment
