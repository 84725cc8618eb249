// From the words of a case to grains made of particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/setup/plan_grains.hpp"

namespace mpm {

/// What all grains with a profile of their velocity fill together along x.
struct Stretch {
    double x_low = 0, x_high = 0;
    double length() const { return x_high - x_low; }
};
inline Stretch profile_bounds(const std::vector<PlannedGrain>& plans) {
    Stretch all{1e300, -1e300};
    for (const PlannedGrain& plan : plans) {
        if (plan.from.profile == "none") continue;
        const Bounds box = bounds(plan.outline);
        all = {std::min(all.x_low, box.x_low), std::max(all.x_high, box.x_high)};
    }
    return all;
}

namespace detail {

inline void add_particles(const PlannedGrain& plan, const Stretch& stretch, const Problem& w,
                          const Material& material, Particles& particles) {
    const Mesh mesh = w.mesh();
    for (FilledPlace at : fill(plan.outline, mesh, w.per_side)) {
        // A grain that straddles the ends of a periodic mesh stays in one piece.
        if (mesh.periodic_x)
            at.x += mesh.length_x() * std::round((plan.outline.x - at.x) / mesh.length_x());
        const GrainCase& from = plan.from;
        const double s = (at.x - stretch.x_low) / stretch.length(),
                     n = static_cast<double>(from.mode);
        const double turn = std::numbers::pi * s;
        const double profile = from.profile == "bar"    ? std::sin((n - 0.5) * turn)
                               : from.profile == "wave" ? std::sin(n * turn)
                                                        : 0;
        for (const OutlinePart& part : at.surface)
            particles.surface.add(static_cast<int>(particles.x_p.size()), part.side, part.area_x,
                                  part.area_y, part.x, part.y);
        particles.x_p.push_back(at.x), particles.y_p.push_back(at.y);
        particles.vx_p.push_back(from.velocity_x + from.amplitude * profile -
                                 from.spin * (at.y - plan.outline.y));
        particles.vy_p.push_back(from.velocity_y + from.spin * (at.x - plan.outline.x));
        particles.V_p.push_back(at.volume);
        particles.half_x_p.push_back(at.half_x), particles.half_y_p.push_back(at.half_y);
        particles.m_p.push_back(material.density * at.volume);
    }
    particles.resize(particles.x_p.size());
}

// Grains whose outlines are nearer than a quarter of a cell.
inline bool touch(const PlannedGrain& a, const PlannedGrain& b, const Mesh& mesh) {
    if (std::fabs(a.outline.y - b.outline.y) > a.outline.radius + b.outline.radius + mesh.h)
        return false;
    Outline other = b.outline;
    if (mesh.periodic_x)
        other = moved(other,
                      mesh.length_x() * std::round((a.outline.x - other.x) / mesh.length_x()), 0);
    const double gap = 0.25 * mesh.h;
    for (const auto& [dx, dy] :
         {std::pair(gap, 0.0), std::pair(-gap, 0.0), std::pair(0.0, gap), std::pair(0.0, -gap),
          std::pair(0.7 * gap, 0.7 * gap), std::pair(-0.7 * gap, 0.7 * gap),
          std::pair(0.7 * gap, -0.7 * gap), std::pair(-0.7 * gap, -0.7 * gap)})
        if (overlap_depth(a.outline, moved(other, dx, dy)) > 0) return true;
    return false;
}

}  // namespace detail

/// The bonds of a case.
/// errors: InputError for a grain that is not there, two that do not touch or are both rigid, or two
///         that are bonded twice
inline std::vector<Bond> bonds_of(const Problem& w, const std::vector<PlannedGrain>& plans,
                                  const std::vector<Material>& materials) {
    std::vector<Bond> bonds;
    const Mesh mesh = w.mesh();
    const auto is_rigid = [&](const PlannedGrain& plan) {
        return materials[static_cast<std::size_t>(plan.material)].law == Law::rigid;
    };
    for (const BondCase& from : w.bonds) {
        const auto known = [&](const std::string& name) {
            return name == "*" || std::any_of(plans.begin(), plans.end(),
                                              [&](const auto& plan) { return plan.name == name; });
        };
        for (const std::string& name : {from.a, from.b})
            if (!known(name))
                throw common::InputError("[bond." + from.name + "]: there is no grain '" + name +
                                         "'; name one of the case, or \"*\" for all");
        const std::size_t before = bonds.size();
        bool all_rigid = false;
        for (std::size_t a = 0; a < plans.size(); ++a) {
            for (std::size_t b = a + 1; b < plans.size(); ++b) {
                const auto fits = [&](const std::string& one, const std::string& two) {
                    return (one == "*" || one == plans[a].name) &&
                           (two == "*" || two == plans[b].name);
                };
                if (!fits(from.a, from.b) && !fits(from.b, from.a)) continue;
                if (!detail::touch(plans[a], plans[b], mesh)) continue;
                if (is_rigid(plans[a]) && is_rigid(plans[b])) {
                    all_rigid = true;
                    continue;
                }
                if (std::any_of(bonds.begin(), bonds.begin() + static_cast<std::ptrdiff_t>(before),
                                [&](const Bond& bond) {
                                    return bond.a == static_cast<int>(a) &&
                                           bond.b == static_cast<int>(b);
                                }))
                    throw common::InputError("[bond." + from.name + "]: '" + plans[a].name +
                                             "' and '" + plans[b].name +
                                             "' are bonded already: let one bond name both");
                Bond bond;
                bond.a = static_cast<int>(a), bond.b = static_cast<int>(b);
                bond.tension = from.tension, bond.shear = from.shear;
                const auto density = [&](const PlannedGrain& plan) {
                    return materials[std::size_t(plan.material)].density;
                };
                bond.density_ratio = density(plans[b]) / density(plans[a]);
                bonds.push_back(bond);
            }
        }
        if (bonds.size() == before)
            throw common::InputError("[bond." + from.name + "]: '" + from.a + "' and '" + from.b +
                                     (all_rigid
                                          ? "' are rigid and need no bond: take it out"
                                          : "' do not touch: put them within a quarter of a cell"));
    }
    return bonds;
}

/// Fills the grains with particles.
/// in:     sided: particles have sides of their own, where outlines cut some
/// errors: InputError for a grain that does not fit on the mesh
inline Assembly assemble(const Problem& w, bool sided = false) {
    const std::vector<Material> materials = materials_of(w);
    const std::vector<PlannedGrain> plans = plan_grains(w, materials);
    const Stretch stretch = profile_bounds(plans);
    Assembly all;
    for (const PlannedGrain& plan : plans) {
        const Material& material = materials[static_cast<std::size_t>(plan.material)];
        Grain grain;
        grain.name = plan.name, grain.material = plan.material;
        grain.rigid = material.law == Law::rigid;
        grain.begin = all.particles.count();
        detail::add_particles(plan, stretch, w, material, all.particles);
        grain.end = all.particles.count();
        grain.mass = std::accumulate(all.particles.m_p.begin() + grain.begin,
                                     all.particles.m_p.begin() + grain.end, 0.0);
        grain.has_corners = plan.outline.kind == OutlineKind::polygon;
        all.grains.push_back(grain);

        RigidMotion motion;
        motion.prescribed_vx = plan.from.velocity_x, motion.prescribed_vy = plan.from.velocity_y;
        motion.stop = plan.from.stop, motion.table = plan.table;
        motion.swing_x = plan.from.swing_x, motion.swing_y = plan.from.swing_y;
        motion.period = plan.from.period;
        motion.force_control_x = plan.from.control == "force_x";
        motion.force_control_y = plan.from.control == "force_y";
        motion.force = plan.from.force, motion.damping = plan.from.damping;
        motion.mass = material.density * area(plan.outline);
        all.rigid.push_back(motion);
    }
    const double half = 0.5 / double(w.per_side);
    bool alike = true;
    for (std::vector<double>* sides : all.particles.half_sides())
        alike = alike && std::ranges::all_of(*sides, [&](double side) { return side == half; });
    if (alike || !sided)
        for (std::vector<double>* sides : all.particles.half_sides()) *sides = {};
    all.bonds = bonds_of(w, plans, materials);
    return all;
}

}  // namespace mpm
