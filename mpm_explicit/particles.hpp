// What a material point carries: position, velocity and mass like every particle of the family, and
// what a solid remembers: its volume, its stress, and how far it has yielded.
//
// The talk's storyline in one struct: the particles are the body, the mesh is a scratch pad. All of
// a grain's particles stand next to each other, row of cells by row of cells.
#pragma once

#include <array>
#include <vector>

namespace mpm {

/// Stress in plane strain, tension positive; zz is the out-of-plane component [E].
struct Stress {
    double xx = 0, yy = 0, xy = 0, zz = 0;
};

/// Increment of strain in the plane, xy the tensor component (half the engineering shear).
struct StrainStep {
    double xx = 0, yy = 0, xy = 0;
};

/// Structure of arrays, one entry per particle; per unit thickness.
struct Particles {
    std::vector<double> x_p, y_p;                    // position
    std::vector<double> vx_p, vy_p;                  // velocity
    std::vector<double> m_p;                         // mass
    std::vector<double> V_p;                         // volume
    std::vector<double> sxx_p, syy_p, sxy_p, szz_p;  // stress, at half time levels
    std::vector<double> yield_p;                     // accumulated plastic strain
    std::vector<double> cxx_p, cxy_p, cyx_p, cyy_p;  // affine motion; empty: none is carried

    std::vector<double> turn_p;  // of mpm_implicit: tan of half a step's turn; or empty

    long count() const { return static_cast<long>(x_p.size()); }

    std::array<std::vector<double>*, 11> all() {
        return {&x_p, &y_p, &vx_p, &vy_p, &m_p, &V_p, &sxx_p, &syy_p, &sxy_p, &szz_p, &yield_p};
    }
    std::array<std::vector<double>*, 4> affine() { return {&cxx_p, &cxy_p, &cyx_p, &cyy_p}; }
    bool has_affine() const { return !cxx_p.empty(); }
    void resize(std::size_t count) {
        for (std::vector<double>* quantity : all()) quantity->resize(count, 0.0);
    }
    Stress stress(std::size_t p) const { return {sxx_p[p], syy_p[p], sxy_p[p], szz_p[p]}; }
    void set_stress(std::size_t p, const Stress& s) {
        sxx_p[p] = s.xx, syy_p[p] = s.yy, sxy_p[p] = s.xy, szz_p[p] = s.zz;
    }
};

template <class Archive>
void archive(Archive& a, Particles& particles) {
    static constexpr std::array<const char*, 11> names{
        "x_p", "y_p", "vx_p", "vy_p", "m_p", "V_p", "sxx_p", "syy_p", "sxy_p", "szz_p", "yield_p"};
    const auto all = particles.all();
    for (std::size_t k = 0; k < all.size(); ++k) a(names[k], *all[k]);
    static constexpr std::array<const char*, 4> affine{"cxx_p", "cxy_p", "cyx_p", "cyy_p"};
    for (std::size_t k = 0; k < affine.size(); ++k) a(affine[k], *particles.affine()[k]);
    a("turn_p", particles.turn_p);
}

}  // namespace mpm
