// What comparisons.hpp declares. Theory is compiled by itself, once for pic and flip.
#include "flip/theory/comparisons.hpp"

#include <array>

#include "flip/theory/compare_cavity.hpp"
#include "flip/theory/compare_collapse.hpp"
#include "flip/theory/compare_dam_break.hpp"
#include "flip/theory/compare_diffusion.hpp"
#include "flip/theory/compare_gravity_wave.hpp"
#include "flip/theory/compare_impact.hpp"
#include "flip/theory/compare_inertial_wave.hpp"
#include "flip/theory/compare_instability.hpp"
#include "flip/theory/compare_noh.hpp"
#include "flip/theory/compare_rest.hpp"
#include "flip/theory/compare_riemann.hpp"
#include "flip/theory/compare_sedov.hpp"
#include "flip/theory/compare_sound.hpp"
#include "flip/theory/compare_struck_wall.hpp"
#include "flip/theory/compare_vortex.hpp"

namespace flip {

namespace {

constexpr Comparison no_comparison{.name = "none",
                                   .frame = Frame::moves,
                                   .axisymmetric = true,
                                   .formulas = true,
                                   .vacuum = true,
                                   .swirl = true};

constexpr std::array all_comparisons{
    no_comparison,        riemann_comparison,   wall_shock_comparison,    piston_comparison,
    diffusion_comparison, rotation_comparison,  sedov_comparison,         noh_comparison,
    gresho_comparison,    wave_comparison,      ringing_comparison,       interface_comparison,
    shear_comparison,     dam_break_comparison, cavity_comparison,        impact_comparison,
    rest_comparison,      collapse_comparison,  inertial_wave_comparison, gravity_wave_comparison};

}  // namespace

std::span<const Comparison> comparisons() { return all_comparisons; }

const Comparison& comparison_of(const Case& parameters) {
    for (const Comparison& c : all_comparisons)
        if (parameters.compare == c.name) return c;
    return no_comparison;
}

void validate_comparison(const Case& parameters) {
    const Comparison& c = comparison_of(parameters);
    const Refusal refuse{sentence("theory.compare = \"", c.name, "\"")};
    refuse(c.rows == Rows::several && !parameters.plane(), " needs grid.cells_z of at least 2");
    refuse(parameters.grid.axisymmetric && !c.axisymmetric,
           " is stated for grid.geometry = \"plane\": take that, or another comparison");
    refuse((parameters.frame_x != 0 && c.frame == Frame::at_rest) ||
               (parameters.frame_z != 0 && c.frame != Frame::moves),
           " is stated in the frame of the mesh: take out theory.frame_x and frame_z");
    refuse(!c.swirl && parameters.swirls(),
           " is stated for fluid that does not turn about the axis: take out velocity_theta and "
           "angular_velocity, or theory.compare = \"none\"");
    for (const RegionCase& r : parameters.regions)
        refuse(!c.formulas && r.has_formula(), " needs numbers, and region.", r.name,
               " has a formula: write numbers, or theory.compare = \"none\"");
    for (const RegionCase& r : parameters.regions)
        refuse(!c.vacuum && r.is_vacuum(), " needs fluid, and region.", r.name,
               ".density = 0 is a vacuum: take the region out, or theory.compare = \"none\"");
    if (c.validate != nullptr) c.validate(parameters, refuse);
}

}  // namespace flip
