// All particles in their grains, with the rigid motions and the bonds.
#pragma once

#include <span>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/grains/grains.hpp"

namespace mpm {

/// What a case makes at t = 0 (setup/assemble.hpp) and a step changes.
struct Assembly {
    Particles particles;
    std::vector<Grain> grains;
    std::vector<RigidMotion> rigid;  // one per grain
    std::vector<Bond> bonds;
};

/// What a grain has of momentum, and of angular momentum about the origin of the mesh, as if it had
/// not come around the ends of a periodic one.
struct Momenta {
    double x = 0, y = 0, angular = 0;
};

/// Momenta of every grain; rigid ones have none of their own.
///   sum_p m_p v_p,  sum_p m_p x_p x v_p
inline std::vector<Momenta> momenta_of(const Assembly& all) {
    std::vector<Momenta> of(all.grains.size());
    const Particles& at = all.particles;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        const Grain& grain = all.grains[g];
        for (long k = grain.begin; k < grain.end && !grain.rigid; ++k) {
            const auto p = static_cast<std::size_t>(k);
            of[g].x += at.m_p[p] * at.vx_p[p], of[g].y += at.m_p[p] * at.vy_p[p];
            of[g].angular += at.m_p[p] * (at.x_p[p] * at.vy_p[p] - at.y_p[p] * at.vx_p[p]);
        }
    }
    return of;
}

/// The mass of the particles begin ... end - 1, and its center.
struct MassCenter {
    double m = 0, x = 0, y = 0;
};
inline MassCenter center_of_mass(const Particles& at, long begin, long end) {
    MassCenter of;
    for (long p = begin; p < end; ++p)
        of.m += at.m_p[p], of.x += at.m_p[p] * at.x_p[p], of.y += at.m_p[p] * at.y_p[p];
    return {of.m, of.x / of.m, of.y / of.m};
}

/// errors: InputError for the momenta of other grains
template <class Archive>
void archive_momenta(Archive& a, std::vector<Momenta>& of) {
    std::vector<double> x, y, angular;
    for (const Momenta& one : of)
        x.push_back(one.x), y.push_back(one.y), angular.push_back(one.angular);
    a("momentum_x", x);
    of.resize(x.size()), y.resize(x.size()), angular.resize(x.size());
    std::span all_y(y), all_angular(angular);  // of this length
    a("momentum_y", all_y), a("angular_momentum", all_angular);
    for (std::size_t g = 0; g < of.size(); ++g) of[g] = {x[g], y[g], angular[g]};
}

/// errors: InputError for a checkpoint whose grains, bonds or tables are not those of the case
template <class Archive>
void archive(Archive& a, Assembly& assembly) {
    std::vector<int> ends;
    for (const Grain& grain : assembly.grains) ends.push_back(static_cast<int>(grain.end));
    const std::vector<int> expected = ends;
    a("grains", ends);
    archive(a, assembly.particles);
    std::vector<double> motion, bonds, tables;
    for (const RigidMotion& is : assembly.rigid)
        for (const TravelRow& row : is.table) tables.insert(tables.end(), {row.t, row.x, row.y});
    const std::vector<double> expected_tables = tables;
    a("motion_tables", tables);
    for (RigidMotion& is : assembly.rigid)
        for (double* value : {&is.vx, &is.vy, &is.push_x, &is.push_y, &is.travel_x, &is.travel_y})
            motion.push_back(*value);
    for (Bond& bond : assembly.bonds)
        bonds.insert(bonds.end(),
                     {bond.broken ? 1.0 : 0.0, bond.normal_stress, bond.shear_stress, bond.area});
    std::span all_motion(motion);  // of this length
    a("rigid_motion", all_motion), a("bonds", bonds);
    if (ends != expected || bonds.size() != 4 * assembly.bonds.size())
        throw common::InputError(
            "the checkpoint holds other grains or bonds than its case makes: put the files of "
            "packs back as they were when the run began");
    if (tables != expected_tables)
        throw common::InputError(
            "the checkpoint was made with other tables of motion than its case reads: put the "
            "files back as they were when the run began");
    // What a reader has put there, back where it belongs; a writer finds its own again.
    for (std::size_t k = 0; k < assembly.rigid.size(); ++k) {
        RigidMotion& is = assembly.rigid[k];
        const double* from = &motion[6 * k];
        is.vx = from[0], is.vy = from[1], is.push_x = from[2], is.push_y = from[3];
        is.travel_x = from[4], is.travel_y = from[5];
    }
    for (std::size_t k = 0; k < assembly.bonds.size(); ++k) {
        Bond& bond = assembly.bonds[k];
        const double* from = &bonds[4 * k];
        bond.broken = from[0] != 0, bond.normal_stress = from[1], bond.shear_stress = from[2];
        bond.area = from[3];
    }
}

}  // namespace mpm
