// What a material point carries: position, velocity and mass like every particle of the family, and
// what a solid remembers: its volume, its stress, and how far it has yielded.
//
// The particles are the body, and the mesh is a scratch pad. A grain's particles stand next to each
// other, row of cells by row of cells.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
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

/// The outline of grains, as some particles carry it, in their order: of the parts s that a particle
/// carries on one side of a sharp corner, with area vectors A_s out of the grain, at e_s from the particle,
///   A = sum_s A_s,  M = sum_s A_s e_sT
struct Surface {
    std::vector<int> host;               // the particle
    std::vector<int> side;               // 0 or 1; it changes at a sharp corner
    std::vector<double> ax, ay;          // A [length]
    std::vector<double> xx, xy, yx, yy;  // M [length^2]

    std::size_t count() const { return host.size(); }
    std::array<std::vector<double>*, 6> all() { return {&ax, &ay, &xx, &xy, &yx, &yy}; }
    /// Adds a part to what a particle carries, which is the last one that carries any, or after it.
    void add(int particle, int of_side, double area_x, double area_y, double e_x, double e_y) {
        std::size_t k = count();
        while (k > 0 && host[k - 1] == particle && side[k - 1] != of_side) --k;
        if (k == 0 || host[k - 1] != particle) {
            k = host.size() + 1;
            host.push_back(particle), side.push_back(of_side);
            for (std::vector<double>* sum : all()) sum->push_back(0);
        }
        ax[k - 1] += area_x, ay[k - 1] += area_y;
        xx[k - 1] += area_x * e_x, xy[k - 1] += area_x * e_y;
        yx[k - 1] += area_y * e_x, yy[k - 1] += area_y * e_y;
    }
    /// Follows the particles to other places: particle p is now target[p].
    void follow(const std::vector<int>& target) {
        std::vector<std::size_t> order(count());
        std::iota(order.begin(), order.end(), std::size_t{0});
        for (int& particle : host) particle = target[particle];
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return host[a] < host[b]; });
        const auto carry = [&](auto& quantity) {
            const auto from = quantity;
            for (std::size_t k = 0; k < order.size(); ++k) quantity[k] = from[order[k]];
        };
        carry(host), carry(side);
        for (std::vector<double>* quantity : all()) carry(*quantity);
    }
};

/// Structure of arrays, one entry per particle; per unit thickness.
struct Particles {
    std::vector<double> x_p, y_p;                    // position
    std::vector<double> vx_p, vy_p;                  // velocity
    std::vector<double> m_p;                         // mass
    std::vector<double> V_p;                         // volume
    std::vector<double> sxx_p, syy_p, sxy_p, szz_p;  // stress; in mpm_explicit at half time levels
    std::vector<double> yield_p;                     // accumulated plastic strain
    std::vector<double> cxx_p, cxy_p, cyx_p, cyy_p;  // affine motion; empty: none is carried

    // From where it is to where it was before the last step, if it crossed a line of nodes, else 0
    // [length]; or empty.
    std::vector<double> from_x_p, from_y_p;

    // Of mpm_implicit with gimp: half its sides along x and y at the start, in cells, where upright boxes
    // cut some; or empty.
    std::vector<double> half_x_p, half_y_p;

    Surface surface;  // empty: contact goes by the particles themselves

    std::vector<double> turn_p;  // of mpm_implicit: tan of half a step's turn; or empty

    long count() const { return static_cast<long>(x_p.size()); }

    std::array<std::vector<double>*, 11> all() {
        return {&x_p, &y_p, &vx_p, &vy_p, &m_p, &V_p, &sxx_p, &syy_p, &sxy_p, &szz_p, &yield_p};
    }
    std::array<std::vector<double>*, 4> affine() { return {&cxx_p, &cxy_p, &cyx_p, &cyy_p}; }
    std::array<std::vector<double>*, 2> from() { return {&from_x_p, &from_y_p}; }
    std::array<std::vector<double>*, 2> half_sides() { return {&half_x_p, &half_y_p}; }
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
    a("from_x_p", particles.from_x_p), a("from_y_p", particles.from_y_p);
    a("half_x_p", particles.half_x_p), a("half_y_p", particles.half_y_p);
    a("turn_p", particles.turn_p);
    a("surface_host", particles.surface.host);
    a("surface_side", particles.surface.side);
    static constexpr std::array<const char*, 6> parts{"surface_ax", "surface_ay", "surface_xx",
                                                      "surface_xy", "surface_yx", "surface_yy"};
    for (std::size_t k = 0; k < parts.size(); ++k) a(parts[k], *particles.surface.all()[k]);
}

}  // namespace mpm
