// The results of a run: what was measured, beside the exact or the predicted value.
#pragma once

#include "flip/theory/compare_flows.hpp"
#include "flip/theory/compare_growth.hpp"
#include "flip/theory/compare_profiles.hpp"

namespace flip {

/// The results of a case.
inline void compare_with_theory(const FinishedRun& run) {
    const std::string& compare = run.w.compare;
    if (compare == "riemann") compare_riemann(run);
    if (compare == "wall_shock" || compare == "piston") compare_struck_wall(run);
    if (compare == "diffusion") compare_diffusion(run);
    if (compare == "rotation") compare_rotation(run);
    if (compare == "sedov") compare_sedov(run);
    if (compare == "noh") compare_noh(run);
    if (compare == "gresho") compare_gresho(run);
    if (compare == "wave") compare_wave(run);
    if (compare == "ringing") compare_ringing(run);
    if (compare == "rayleigh_taylor" || compare == "kelvin_helmholtz") compare_instability(run);
    if (compare == "dam_break") compare_dam(run);
    if (compare == "cavity") compare_cavity(run);
    if (compare == "impact") compare_impact(run);
}

}  // namespace flip
