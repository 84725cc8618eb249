// What explicit_em looks at before a run starts: the limits of stability, and what it must resolve.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "implicit_moment/explicit_em/crossings.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"
#include "implicit_moment/setup/check_case.hpp"

namespace implicit_moment {

namespace detail {

// omega_p dt of all species together, at the largest density of the case.
inline double omega_p_dt(const Case& w, const Scales& scales) {
    double squared = 0;
    for (const SpeciesScales& s : scales.species) squared += s.omega_p_dt * s.omega_p_dt;
    return std::sqrt(squared * (w.is_uniform() ? 1 : 1 + harris_of(w).background));
}

}  // namespace detail

/// Refuses what is unstable: c dt >= (1/dx^2 + 1/dz^2)^(-1/2) and omega_p dt >= 2; and more ranks than tiles.
/// errors: InputError, one sentence with the numbers and the cure.
/// source: Courant, Friedrichs and Lewy (1928) for Yee's mesh; Birdsall and Langdon (1985),
///         section 4-2.
inline void refuse_unstable(const Case& w) {
    const long tiles =
        tiles_of(w.leapfrog.order == 1 ? Stencil<1>::cells(w.grid.z) : Stencil<2>::cells(w.grid.z));
    refuse(common::rank_count() > tiles, common::rank_count(), " ranks, and the mesh has ", tiles,
           " strips of ", rows_of_tile, " rows, of which each rank needs one: start fewer");
    const double limit = courant_limit(w.grid);
    refuse(!(w.dt < limit), "time.dt = ", w.dt, " is not below the limit of light on this mesh, ",
           limit, " / omega_pi (c dt < (1/dx^2 + 1/dz^2)^(-1/2)): lower time.dt to ", 0.85 * limit,
           " or use larger cells");
    const double omega_p_dt = detail::omega_p_dt(w, scales_of(w));
    refuse(!(omega_p_dt < 2), "omega_p dt = ", omega_p_dt,
           " is not below 2, the limit of leapfrogged plasma oscillations: lower time.dt to ",
           w.dt * 1.5 / omega_p_dt, " or use implicit_moment");
}

/// Warnings with the number and the limit, for choices that run but may mislead.
/// source: Birdsall and Langdon (1985), chapters 8, 9 and 15.
inline std::vector<std::string> leapfrog_warnings(const Case& w, const Scales& scales) {
    std::vector<std::string> warnings = idleness_warnings(w, scales);
    for (const std::string& warning : superluminal_warnings(w, scales)) warnings.push_back(warning);
    const double cell = std::min(w.grid.x.spacing(), w.grid.z.spacing());
    const double omega_p_dt = detail::omega_p_dt(w, scales);
    warn(warnings, omega_p_dt > 1.62, "omega_p dt = ", omega_p_dt,
         " is above 1.62, where oscillations of a warm plasma may grow: lower time.dt to ",
         w.dt * 1.5 / omega_p_dt);
    // Of light along an axis, waves of two cells are the slowest.
    const auto warn_of_cherenkov = [&](const SpeciesCase& of, const char* name, double u,
                                       double cells) {
        const double squared = of.drift_x * of.drift_x + of.drift_y * of.drift_y +
                               of.drift_z * of.drift_z,
                     v = std::fabs(u) /
                         (w.is_relativistic() ? std::sqrt(1 + squared / (c * c)) : 1),
                     slowest = 2 * cells / (pi * w.dt) * std::asin(std::min(1.0, c * w.dt / cells));
        warn(
            warnings, v > slowest && of.charge != 0 && w.field.smoothing.passes < 4, "species '",
            of.name, "' drifts along ", name, " with ", v / c,
            " c, and the shortest waves of light on this mesh with ", slowest / c,
            " c: it may feed them (numerical Cherenkov radiation); set field.smoothing_passes = 4");
    };
    for (const SpeciesCase& of : w.uniform.species) {
        if (!w.is_uniform()) break;
        warn_of_cherenkov(of, "x", of.drift_x, w.grid.x.spacing());
        warn_of_cherenkov(of, "z", of.drift_z, w.grid.z.spacing());
    }
    const CommonDrift drift = w.is_uniform() ? common_drift(w) : CommonDrift{};
    const bool drifts = drift.counts && std::hypot(drift.momentum[0], drift.momentum[2]) > 0,
               wide = w.leapfrog.order == 2, smooth = w.field.smoothing.passes >= 4;
    const double debye = drifts ? debye_cells(w) : HUGE_VAL, least = wide || smooth ? 0.2 : 0.6;
    warn(warnings, debye < least && !(wide && smooth), "the Debye length is ", debye,
         " cells, below ", least,
         ", and the plasma drifts as a whole: the mesh may brake it, watch the momentum, or set "
         "particles.order = 2 and field.smoothing_passes = 4");
    // In the outer half of the mesh a way per step is a whole number of these.
    const double digit = std::numeric_limits<ParticleReal>::epsilon() *
                         std::max(w.grid.x.length, w.grid.z.length) / 2;
    for (const SpeciesScales& s : scales.species) {
        const double way = s.thermal_speed * w.dt;
        warn(warnings, sizeof(ParticleReal) < sizeof(double) && way > 0 && way < 50 * digit, s.name,
             ": thermal particles go ", way / digit,
             " times the last digit of their positions in a step, fewer than 50, and are slower or "
             "faster than their velocities: compile with REAL=double, or raise time.dt");
        warn(warnings, !drifts && s.debye_length > 0 && s.debye_length < 0.2 * cell, s.name,
             ": the Debye length is ", s.debye_length / cell,
             " cells, below 0.2: where the plasma drifts the mesh may heat it, watch the energy");
        warn(warnings, s.Omega_c_dt > 0.5, s.name, ": Omega_c dt = ", s.Omega_c_dt,
             " is above 0.5, gyration is too slow by more than 2 %: lower time.dt to ",
             w.dt * 0.5 / s.Omega_c_dt);
    }
    return warnings;
}

}  // namespace implicit_moment
