// What the tests of any scheme of the material point method share: random numbers, loose clouds of
// particles on a mesh, and cases made without files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/transfer.hpp"
#include "tests/support/any_numbers.hpp"

namespace facts {

using namespace mpm;

using Random = UnitRandom;

inline const std::array<std::string, 3> shape_names{"linear", "gimp", "quadratic"};

/// Calls work(shape, name) for every shape function.
template <class Work>
void for_each_shape(const Work& work) {
    work(LinearShape{}, std::string("linear"));
    work(QuadraticShape{}, std::string("quadratic"));
    for (const double half : {1.0 / 2, 1.0 / 4, 1.0 / 6})
        work(GimpShape{half}, "gimp " + std::to_string(half));
}

// ---- particles and their nodes ------------------------------------------------------------------

/// Grains made of particles anywhere, not of a lattice.
struct Cloud {
    Mesh mesh;
    Particles particles;
    std::vector<Grain> grains;
    std::vector<RigidMotion> rigid;
    GridLayout layout;

    explicit Cloud(const Mesh& where) : mesh(where) {}

    void begin_grain(bool is_rigid = false) {
        Grain grain;
        grain.name = "g" + std::to_string(grains.size());
        grain.rigid = is_rigid;
        grain.begin = grain.end = particles.count();
        grains.push_back(grain), rigid.emplace_back();
    }
    /// One more particle of the last grain; its yield_p counts particles.
    void add(double x, double y, double m = 1, double vx = 0, double vy = 0, double V = 1) {
        Particles& p = particles;
        p.x_p.push_back(x), p.y_p.push_back(y), p.vx_p.push_back(vx), p.vy_p.push_back(vy);
        p.m_p.push_back(m), p.V_p.push_back(V);
        p.resize(p.x_p.size());
        p.yield_p.back() = real(p.count() - 1);
        grains.back().end = p.count();
    }
    /// A grain of particles anywhere in a box.
    void add_anywhere(long count, double x_low, double x_high, double y_low, double y_high,
                      Random& random) {
        begin_grain();
        for (long p = 0; p < count; ++p) {
            const double x = random(x_low, x_high), y = random(y_low, y_high), m = random(0.5, 1.5),
                         vx = random(-1, 1), vy = random(-1, 1);
            add(x, y, m, vx, vy, random(0.5, 1.5));
        }
    }
    /// Sorts, and puts the sums on nodes; and their velocities.
    template <class Shape>
    GrainNodes on_nodes(const Shape& shape, double least_mass = 0) {
        GrainNodes nodes(mesh, Shape::width, least_mass);
        nodes.sort(grains, particles, layout);
        particles_to_grid(shape, particles, nodes);
        nodal_velocity(grains, rigid, nodes);
        return nodes;
    }
};

/// By how much the particles differ from those most like them among others; stress in units of 1e4.
inline double unlike(const Particles& some, const Particles& others) {
    double most = 0;
    for (std::size_t k = 0; k < some.x_p.size(); ++k) {
        double nearest = 1e300;
        for (std::size_t l = 0; l < others.x_p.size(); ++l)
            nearest = std::min(nearest, worst({std::fabs(some.x_p[k] - others.x_p[l]),
                                               std::fabs(some.y_p[k] - others.y_p[l]),
                                               std::fabs(some.vx_p[k] - others.vx_p[l]),
                                               std::fabs(some.vy_p[k] - others.vy_p[l]),
                                               1e-4 * std::fabs(some.sxx_p[k] - others.sxx_p[l])}));
        most = worst({most, nearest});
    }
    return most;
}

inline Mesh mesh_of(long cells_x, long cells_y, double h, double x_low = 0, double y_low = 0) {
    Mesh mesh;
    mesh.cells_x = cells_x, mesh.cells_y = cells_y, mesh.h = h;
    mesh.x_low = x_low, mesh.y_low = y_low;
    return mesh;
}

/// Calls visit(grain, i, j, dof) for all nodes of all grains.
template <class Visit>
void for_each_dof(const GrainNodes& nodes, const GridLayout& layout, const Visit& visit) {
    std::size_t row = 0;
    for (std::size_t g = 0; g < layout.rows.size(); ++g)
        for (int r = 0; r < layout.rows[g]; ++r, ++row)
            for (long i = layout.first_column[row]; i < layout.end_column[row]; ++i) {
                const long j = layout.first_row[g] + r;
                visit(static_cast<int>(g), i, j,
                      static_cast<std::size_t>(nodes.origin(static_cast<int>(g), j) + i));
            }
}

// ---- cases --------------------------------------------------------------------------------------

/// A mesh of square cells with one elastic material, E = 1e4, nu = 0.3, density 1000.
inline Case case_on(long cells_x, long cells_y, double length_x) {
    Case c;
    c.problem.cells_x = cells_x, c.problem.cells_y = cells_y, c.problem.length_x = length_x;
    return c;
}
inline GrainCase disk_at(const std::string& name, double x, double y, double radius, double vx = 0,
                         double vy = 0) {
    GrainCase g;
    g.name = name, g.x = x, g.y = y, g.radius = radius, g.velocity_x = vx, g.velocity_y = vy;
    return g;
}
inline GrainCase box_at(const std::string& name, double x, double y, double width, double height,
                        double vx = 0, double vy = 0) {
    GrainCase g = disk_at(name, x, y, 1, vx, vy);
    g.shape = "box", g.width = width, g.height = height;
    return g;
}
inline void add_material(Case& c, const std::string& name, const std::string& law,
                         const Material& of) {
    MaterialCase m;
    m.name = name, m.law = law, m.material = of;
    c.problem.materials.push_back(m);
}

}  // namespace facts
