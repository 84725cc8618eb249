// The parameters that say how FLIP goes about it, and which of them a case has changed.
#pragma once

#include <string>
#include <vector>

#include "flip/setup/case.hpp"

namespace flip::detail {

// Keys that do nothing unless another has a certain value.
struct IdleKey {
    std::string name, value;
    bool changed;
    bool used;
    std::string needs;
};

inline std::vector<IdleKey> keys_of_flip(const Case& w) {
    const Case d;
    const auto on_off = [](bool value) { return std::string(value ? "true" : "false"); };
    const auto whole = [](long value) { return std::to_string(value); };
    const auto quoted = [](const std::string& text) { return "\"" + text + "\""; };
    const bool implicit = w.implicit(), rezones = w.rezone_steps > 0;
    const std::string solver = "flip.pressure = \"implicit\"", rezone = "rezone.steps above 0";
    return {
        {"flip.transfer", quoted(w.transfer), w.transfer != d.transfer, true, ""},
        {"flip.blend", common::format(w.blend), w.blend != d.blend, w.transfer == "blend",
         "flip.transfer = \"blend\""},
        {"flip.xpic_order", whole(w.xpic_order), w.xpic_order != d.xpic_order, w.transfer == "xpic",
         "flip.transfer = \"xpic\""},
        {"flip.mass", quoted(w.mass), w.mass != d.mass, true, ""},
        {"flip.deficit_to_heat", on_off(w.deficit_to_heat), w.deficit_to_heat != d.deficit_to_heat,
         true, ""},
        {"flip.density", quoted(w.density), w.density != d.density, true, ""},
        {"flip.viscosity", common::format(w.viscosity), w.viscosity != d.viscosity, true, ""},
        {"flip.pressure", quoted(w.pressure), w.pressure != d.pressure, true, ""},
        {"flip.theta", common::format(w.theta), w.theta != d.theta, implicit, solver},
        {"flip.tolerance", common::format(w.tolerance), w.tolerance != d.tolerance, implicit,
         solver},
        {"flip.max_iterations", whole(w.max_iterations), w.max_iterations != d.max_iterations,
         implicit, solver},
        {"rezone.steps", whole(w.rezone_steps), w.rezone_steps != d.rezone_steps, true, ""},
        {"rezone.min_particles", whole(w.min_particles), w.min_particles != d.min_particles,
         rezones, rezone},
        {"rezone.max_particles", whole(w.max_particles), w.max_particles != d.max_particles,
         rezones, rezone},
    };
}

}  // namespace flip::detail
