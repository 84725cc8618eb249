// The parameters that only FLIP has, and which of them a case has changed.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "flip/setup/case.hpp"

namespace flip {

/// A parameter that does nothing unless another has a certain value.
struct FlipKey {
    std::string name, value;
    bool changed;       // not the default
    bool used;          // by this case
    std::string needs;  // what would make it used
};

/// All parameters of FLIP alone, with the values that a case gives them.
inline std::vector<FlipKey> keys_of_flip(const Case& parameters) {
    const auto key = [&](const char* name, auto member, bool used = true, const char* needs = "") {
        const Case defaults;
        const auto& value = parameters.*member;
        std::string text;
        if constexpr (std::is_same_v<decltype(member), bool Case::*>)
            text = value ? "true" : "false";
        else if constexpr (std::is_same_v<decltype(member), std::string Case::*>)
            text = sentence("\"", value, "\"");
        else
            text = sentence(value);
        return FlipKey{name, text, value != defaults.*member, used, needs};
    };
    const bool implicit = parameters.implicit(), rezones = parameters.rezone_steps > 0;
    const char *solver = "flip.pressure = \"implicit\"", *rezone = "rezone.steps above 0";
    return {
        key("flip.transfer", &Case::transfer),
        key("flip.blend", &Case::blend, parameters.transfer == "blend",
            "flip.transfer = \"blend\""),
        key("flip.xpic_order", &Case::xpic_order, parameters.transfer == "xpic",
            "flip.transfer = \"xpic\""),
        key("flip.mass", &Case::mass),
        key("flip.deficit_to_heat", &Case::deficit_to_heat),
        key("flip.density", &Case::density),
        key("flip.filling", &Case::filling, parameters.density == "particles",
            "flip.density = \"particles\""),
        key("flip.confined", &Case::confined, parameters.density == "particles",
            "flip.density = \"particles\""),
        key("flip.viscosity", &Case::viscosity),
        key("flip.pressure", &Case::pressure),
        key("flip.theta", &Case::theta, implicit, solver),
        key("flip.tolerance", &Case::tolerance, implicit, solver),
        key("flip.max_iterations", &Case::max_iterations, implicit, solver),
        key("rezone.steps", &Case::rezone_steps),
        key("rezone.min_particles", &Case::min_particles, rezones, rezone),
        key("rezone.max_particles", &Case::max_particles, rezones, rezone),
    };
}

}  // namespace flip
