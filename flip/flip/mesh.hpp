// The scratch pad of flip: what the mesh knows within one step. Velocities live on nodes, pressures
// on cells. A particle * reaches the four nodes of its cell, with weights S, and the four cells whose
// centers are around it, with weights R; see weights.hpp.
//
//     o-----------o-----------o      o  node (i, j): mass m_g, velocity v_g
//     |           |           |      f  cell (i, j): materials, pressure p_c; at index(i, j) too
//     |     f . . | . . f     |
//     |     .     | *   .     |      the nodes o of the right cell get m_p, v_p of *;
//     o-----.-----o-----.-----o      the four cells f around * get m_p, e_p
//     |     .     |     .     |
//     |     f . . | . . f     |      a cell changes its volume by what its four nodes do,
//     |           |           |      and its pressure pushes the same four nodes
//     o-----------o-----------o
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "common/parallel.hpp"
#include "flip/flip/weights.hpp"
#include "flip/particles.hpp"

namespace flip {

using Two = Eigen::Array2d;
using Four = Eigen::Array4d;

/// What the particles of one material bring to a cell: mass and internal energy, and where they carry
/// volumes C, weight_in_cell(), and its products with p_p and with K_p.
struct CellSum {
    double M = 0, U = 0;
};
struct SoftSum {
    double C = 0, Cp = 0, CK = 0;
};
/// What the particles that turn about the axis bring to a cell: m L, m r^2 and m L^2/r^3.
struct SwirlSum {
    double L = 0, inertia = 0, force = 0;
};

/// A symmetric tensor of a cell: xx, zz, xz, and around the axis.
struct CellTensor {
    double xx = 0, zz = 0, xz = 0, hoop = 0;
    double trace() const { return xx + zz + hoop; }
    CellTensor operator*(double a) const { return {a * xx, a * zz, a * xz, a * hoop}; }
};

/// The nodes; all columns grid.size() long.
struct Nodes {
    std::vector<Four> sum;         // m_g, momentum x and z, and number of particles
    Field m;                       // m_g
    Field vx, vz;                  // Favre average of the particles' velocities  [FLIP-8]
    Field vx0, vz0;                // the same, with the walls' part set
    Field fx, fz;                  // force of pressure, q and viscosity
    Field vxL, vzL;                // after the Lagrangian phase
    Field vx_bar, vz_bar;          // mean of v^0 and v^L
    Field vx_work, vz_work;        // at which pressure works, see work_on_cells()
    std::vector<Four> increment;   // of the velocity, x and z; velocity that moves particles
    std::vector<Four> filtered;    // velocity that replaces the particles' own, not in flip: v, v^L
    Field dissipated;              // specific energy that leaves the motion of the nodes
    Field centrifugal;             // force, only where the fluid turns about the axis
    Field reaction_x, reaction_z;  // consistent mass matrix: impulse of the walls,
    Field wall_dissipation;        //     and the specific energy that they dissipate
};

/// The cells; columns of grid.size(), those per material with the materials of a cell together.
struct Cells {
    std::vector<CellSum> sum;         // [cell][material]
    std::vector<double> share;        // of a change of volume
    std::vector<Two> de;              // e of a particle changes by de[0] + e de[1]
    Field M;                          // mass
    Field p;                          // pressure
    std::vector<CellTensor> q;        // artificial viscosity
    Field compressibility;            // -(dV/dp)/V; 0 in an empty cell
    Field p_step, outside;            // the pressure that acts in this step; in voids at open ends
    std::vector<char> surface;        // 1: partly void, p = 0 whatever happens
    std::vector<double> V_of_column;  // the volume that the lattice of the start fills in a cell
    // Only where particles carry volumes: sums of V_p and C; V_c div v dt, and its work, per C; room for
    // gas, and what liquid has too much of; per material, pressure above that of the cell.
    Field volume, C, strain, work, q_work, room, crowding;
    std::vector<SoftSum> soft;
    std::vector<double> excess;
    std::vector<SwirlSum> swirl;  // only where the fluid turns about the axis
    bool one_fluid = false;       // explicit, and all materials have one equation of state
};

/// The scratch pad.
struct Mesh {
    Nodes nodes;
    Cells cells;
    long materials = 1;
    // Of each particle that turns: its force in this step, then the energy that it leaves.
    std::vector<double> swirl;
};

/// What the particles of the lattice, each with its volume, bring to a cell of each column.
/// exact:  so uniform fluid on the lattice has its density in every cell, to round-off; in the plane
///         it is the area of a cell, and in rings the sum approaches the volume with more particles
inline std::vector<double> lattice_volumes(const Grid& grid, long per_cell) {
    const long nx = grid.x.cells;
    if (!grid.axisymmetric) return std::vector<double>(nx, grid.cell_area());
    const WeightScale scale(grid);
    std::vector<double> V(nx, 0.0);
    for (long n = 0; n < nx * per_cell; ++n) {
        const LatticeColumn column = lattice_column(grid, per_cell, n);
        const Weights w = weights_at(scale, column.x, grid.z.low);
        const double part = column.ring * grid.cell_area() / double(per_cell);
        for (const long side : {0, 1})
            V[std::clamp(column_of(grid, w.cell + side), 0L, nx - 1)] += part * w.R_x[side];
    }
    return V;
}

/// Makes room, once.
inline Mesh mesh_of(const Problem& problem) {
    Mesh mesh;
    const Scheme& scheme = problem.scheme;
    const long size = problem.grid.size();
    Nodes& g = mesh.nodes;
    for (Field* f : {&g.m, &g.vx, &g.vz, &g.vx0, &g.vz0, &g.fx, &g.fz, &g.vxL, &g.vzL, &g.vx_bar,
                     &g.vz_bar, &g.vx_work, &g.vz_work, &g.dissipated})
        f->setZero(size);
    g.sum.assign(size, Four::Zero());
    g.increment.assign(size, Four::Zero());
    if (scheme.consistent_mass)
        for (Field* f : {&g.reaction_x, &g.reaction_z, &g.wall_dissipation}) f->setZero(size);
    if (!scheme.transfer.flip) g.filtered.assign(size, Four::Zero());
    Cells& c = mesh.cells;
    mesh.materials = long(problem.materials.size());
    c.sum.assign(size * mesh.materials, {});
    c.share.assign(size * mesh.materials, 0), c.de.assign(size * mesh.materials, Two::Zero());
    c.surface.assign(size, 0);
    c.V_of_column = lattice_volumes(problem.grid, problem.per_cell_x);
    for (Field* f : {&c.M, &c.p, &c.compressibility, &c.p_step}) f->setZero(size);
    c.q.assign(size, {});
    if (scheme.particle_volumes) {
        for (Field* f : {&c.volume, &c.C, &c.strain, &c.work, &c.q_work, &c.room, &c.crowding})
            f->setZero(size);
        c.soft.assign(size * mesh.materials, {});
        const Material& first = problem.materials.front();
        c.one_fluid =
            !scheme.implicit && std::ranges::all_of(problem.materials, [&](const Material& a) {
                return a.gamma == first.gamma && a.p_infinity == first.p_infinity;
            });
        c.excess.assign(size * mesh.materials, 0);
    }
    if (problem.swirl) {
        c.swirl.assign(size, {});
        g.centrifugal.setZero(size);
    }
    return mesh;
}

/// Copies nodes to their periodic images; what is beyond a boundary stays as it is.
template <class Number>
void fill_nodes(const Grid& grid, Number* f) {
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    const auto images = [](long cells, const auto& copy) {  // copy(to, from)
        copy(cells, 0L);
        copy(-1L, cells - 1);
        copy(cells + 1, cells > 1 ? 1L : 0L);
    };
    if (grid.x.periodic)
        for (long j = 0; j <= nz; ++j)
            images(nx, [&](long to, long from) { f[grid.index(to, j)] = f[grid.index(from, j)]; });
    if (grid.z.periodic)
        images(nz, [&](long to, long from) {
            std::copy_n(f + grid.index(-1, from), stride, f + grid.index(-1, to));
        });
}

/// Adds what was deposited on the last node of a periodic direction to the first, which it is; then
/// fills the images.
template <class Number>
void fold_nodes(const Grid& grid, Number* f) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    if (grid.x.periodic)
        for (long j = 0; j <= nz; ++j) f[grid.index(0, j)] += f[grid.index(nx, j)];
    if (grid.z.periodic)
        for (long i = -1; i <= nx + 1; ++i) f[grid.index(i, 0)] += f[grid.index(i, nz)];
    fill_nodes(grid, f);
}

/// Copies cells to the ghosts around the mesh: periodic images, or beyond any other boundary the
/// nearest cell; `width` numbers per cell.
inline void fill_cells(const Grid& grid, double* f, long width = 1) {
    const long nx = grid.x.cells, nz = grid.z.cells, row = width * grid.stride();
    const auto at = [&](long i, long j) { return f + width * grid.index(i, j); };
    for (long j = 0; j < nz; ++j) {
        std::copy_n(at(grid.x.periodic ? nx - 1 : 0, j), width, at(-1, j));
        std::copy_n(at(grid.x.periodic ? 0 : nx - 1, j), width, at(nx, j));
    }
    std::copy_n(at(-1, grid.z.periodic ? nz - 1 : 0), row, at(-1, -1));
    std::copy_n(at(-1, grid.z.periodic ? 0 : nz - 1), row, at(-1, nz));
}

/// Adds what was deposited on ghosts to the cells that they are images of; the transpose of
/// fill_cells(), without filling.
inline void fold_cells(const Grid& grid, double* f, long width = 1) {
    const long nx = grid.x.cells, nz = grid.z.cells, row = width * grid.stride();
    const auto at = [&](long i, long j) { return f + width * grid.index(i, j); };
    const auto add = [](const double* from, double* to, long count) {
        for (long k = 0; k < count; ++k) to[k] += from[k];
    };
    add(at(-1, -1), at(-1, grid.z.periodic ? nz - 1 : 0), row);
    add(at(-1, nz), at(-1, grid.z.periodic ? 0 : nz - 1), row);
    for (long j = 0; j < nz; ++j) {
        add(at(-1, j), at(grid.x.periodic ? nx - 1 : 0, j), width);
        add(at(nx, j), at(grid.x.periodic ? 0 : nx - 1, j), width);
    }
}

namespace detail {

// Calls work(i, j, index) on columns [0, nx) and rows [0, nz), blocks of rows in parallel.
template <class Work>
void for_each_point(const Grid& grid, long nx, long nz, const Work& work) {
    common::for_each_block(
        nz,
        [&](int, long begin, long end) {
            const Work own = work;  // what it has captured by value no write can change
            for (long j = begin; j < end; ++j)
                for (long i = 0, n = grid.index(0, j); i < nx; ++i, ++n) own(i, j, n);
        },
        grid.size());
}

}  // namespace detail

/// Calls work(i, j, index) for every cell, in parallel.
template <class Work>
void for_each_cell(const Grid& grid, const Work& work) {
    detail::for_each_point(grid, grid.x.cells, grid.z.cells, work);
}
/// The same for every node, periodic images of the first ones included.
template <class Work>
void for_each_node(const Grid& grid, const Work& work) {
    detail::for_each_point(grid, grid.x.cells + 1, grid.z.cells + 1, work);
}
/// Calls visit(i, j, index) once for every node that is not the image of another, row by row.
template <class Visit>
void for_own_nodes(const Grid& grid, const Visit& visit) {
    const long nx = grid.x.cells - (grid.x.periodic ? 1 : 0),
               nz = grid.z.cells - (grid.z.periodic ? 1 : 0);
    for (long j = 0; j <= nz; ++j)
        for (long i = 0; i <= nx; ++i) visit(i, j, grid.index(i, j));
}

}  // namespace flip
