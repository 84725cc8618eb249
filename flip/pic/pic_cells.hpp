// The Eulerian mesh of the classical method: a scratch pad, rebuilt in every step from the
// particles and the little that cells remember (velocity and internal energy, see state.hpp).
//
//     M, I, u --Lagrangian phase--> u~, I~ --particles move, Eulerian phase--> M, I, u
//
//     +-------+-------+      u  cell (i, j): masses M, velocity u, energies I, pressure p, all at its
//     |       |       |         center; at grid.index(i, j)
//     |   u   q   u   |      q  face: viscous pressure between two cells, at the index of the cell
//     |       |       |         to its right, or above it
//     +-------+-------+      Around the mesh stands one ring of ghost cells.
#pragma once

#include <vector>

#include "common/parallel.hpp"
#include "flip/state.hpp"

namespace flip {

/// Both components of the velocity of a cell side by side: a particle wants both.
struct CellVelocity {
    double x = 0, z = 0;
};

/// The scratch pad. Of several materials, those of one cell lie together: [cell * materials + k].
struct PicCells {
    long materials = 1;
    bool falls = false;                 // gravity acts, or the centrifugal force
    std::vector<double> M;              // mass of each material
    Field mass, per_mass, rho;          // of all; 1/mass, 0 in an empty cell; density
    Field filled;                       // 1, or 0 in an empty cell
    Field p, c;                         // pressure, speed of sound
    std::vector<double> share;          // of the work of the pressure, that each material takes
    Field q_x, q_z;                     // viscous pressure on the faces before the cell
    Field part_x, part_z;               // of the cell before that face, in its pressure
    Field work;                         // of the pressure on the cell
    std::vector<double> ring;           // ring_length() of column i at [i + 1], ghosts like inside
    std::vector<CellVelocity> v;        // u
    std::vector<CellVelocity> v_tilde;  // u~
    std::vector<double> e_tilde;        // I~ of each material

    Field centrifugal;          // force per mass, where the fluid turns about the axis
    std::vector<double> swirl;  // of each particle: that force, then the energy that it leaves
    double fastest_swirl2 = 0;  // the largest (L/r)^2 of a cell
    std::vector<int> donor;     // of each particle, the cell that it comes from
    std::vector<double> sums;   // what particles bring to a cell
    std::vector<double> row;    // one number per row of cells
    SortScratch sort;

    explicit PicCells(const Problem& problem)
        : materials(long(problem.materials.size())),
          falls(problem.body_force.gravity_x != 0 || problem.body_force.gravity_z != 0 ||
                problem.swirl) {
        const Grid& grid = problem.grid;
        for (Field* f :
             {&mass, &per_mass, &rho, &filled, &p, &c, &q_x, &q_z, &part_x, &part_z, &work})
            f->setZero(grid.size());
        ring.assign(grid.x.cells + 2, 1.0);
        for (long i = 0; i < grid.x.cells; ++i) ring[i + 1] = ring_length(grid, double(i) + 0.5);
        ring.front() = ring[1], ring.back() = ring[grid.x.cells];
        for (auto* f : {&M, &share, &e_tilde}) f->assign(grid.size() * materials, 0.0);
        if (problem.swirl) centrifugal.setZero(grid.size());
        v.assign(grid.size(), {});
        v_tilde.assign(grid.size(), {});
        row.assign(grid.z.cells, 0.0);
        sums.assign(grid.x.cells * grid.z.cells * width_of_sums(), 0.0);
    }
    // How many sums a cell has: four of all particles and two of each material.
    long width_of_sums() const { return 4 + 2 * materials; }
};

/// Calls work(j) for every row of cells, in parallel where that pays.
template <class Work>
void for_each_row_of_cells(const Grid& grid, const Work& work) {
    common::for_each_row(grid.z.cells, work, grid.x.cells * grid.z.cells);
}

/// Sum over rows of cells, added in the order of the rows.
template <class SumOfRow>
double sum_over_rows(const Grid& grid, PicCells& cells, const SumOfRow& sum_of_row) {
    for_each_row_of_cells(grid, [&](long j) { cells.row[j] = sum_of_row(j); });
    double sum = 0;
    for (const double part : cells.row) sum += part;
    return sum;
}

namespace detail {

// Calls add(p, cell) for every particle, on as many threads as share no cell.
template <class Add>
void for_each_in_cell(const Grid& grid, const Particles& particles, const Add& add) {
    const CellAlong column(grid.x), row(grid.z);
    const double *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    const int *first = particles.first_of_row.data(), nx = int(grid.x.cells);
    const auto add_batch = [=](long begin, long end) {
        int cell[batch_size];
#pragma omp simd
        for (long p = begin; p < end; ++p) cell[p - begin] = row(z_p[p]) * nx + column(x_p[p]);
        for (long p = begin; p < end; ++p) add(p, long(cell[p - begin]));
    };
    // Three rows apart: a particle may be in the row beside its own.
    common::for_each_row_colored(
        3, grid.z.cells,
        [&](long j) {
            const auto add_here = add_batch;  // its pointers, which no write to a cell can change
            for (long p = first[j]; p < first[j + 1]; p += batch_size)
                add_here(p, std::min(p + batch_size, long(first[j + 1])));
        },
        grid.x.cells * grid.z.cells);
}

}  // namespace detail

/// Calls visit(ghost, inside) for every ghost cell beyond one side, with the cell whose image it is.
/// note:   first the sides along x, then those along z, which take the corners with them
template <class Visit>
void for_each_ghost(const Grid& grid, Side side, const Visit& visit) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    const bool low = is_low_side(side);
    if (is_x_side(side)) {
        const long ghost = low ? -1 : nx, inside = low == grid.x.periodic ? nx - 1 : 0;
        for (long j = 0; j < nz; ++j) visit(grid.index(ghost, j), grid.index(inside, j));
    } else {
        const long ghost = low ? -1 : nz, inside = low == grid.z.periodic ? nz - 1 : 0;
        for (long i = -1; i <= nx; ++i) visit(grid.index(i, ghost), grid.index(i, inside));
    }
}

/// Fills the ghosts of a velocity: images around a periodic direction; the mirror image behind a
/// wall, whose normal component is odd; the same velocity beyond an open boundary; that of an inflow.
inline void fill_ghosts(const Grid& grid, const Boundaries& boundaries,
                        std::vector<CellVelocity>& v) {
    for (const Side side : all_sides) {
        const Inflow& in = boundaries.side[side].inflow;
        const bool wall = boundaries.is(side, BoundaryKind::slip), along_x = is_x_side(side);
        const double odd_x = wall && along_x ? -1 : 1, odd_z = wall && !along_x ? -1 : 1;
        const bool inflow = boundaries.is(side, BoundaryKind::inflow);
        for_each_ghost(grid, side, [&](long ghost, long inside) {
            const CellVelocity a = v[inside];
            v[ghost] = inflow ? CellVelocity{in.vx, in.vz} : CellVelocity{odd_x * a.x, odd_z * a.z};
        });
    }
}

/// Fills the ghosts of what find_pressure() makes.
/// note:   beyond an open boundary p is such that its mean with the cell inside is the pressure
///         outside
inline void fill_ghosts(const Grid& grid, const Boundaries& boundaries, PicCells& cells) {
    const double V = grid.cell_area();
    for (const Side side : all_sides) {
        const Inflow& in = boundaries.side[side].inflow;
        const bool open = boundaries.is(side, BoundaryKind::open),
                   inflow = boundaries.is(side, BoundaryKind::inflow);
        const double outside_pressure = boundaries.side[side].pressure;
        for_each_ghost(grid, side, [&](long ghost, long inside) {
            for (Field* f :
                 {&cells.mass, &cells.per_mass, &cells.rho, &cells.filled, &cells.p, &cells.c})
                (*f)[ghost] = (*f)[inside];
            if (open) cells.p[ghost] = 2 * outside_pressure - cells.p[inside];
            if (!inflow) return;
            cells.mass[ghost] = in.rho * V * cells.ring[column_of(grid, ghost) + 1];
            cells.per_mass[ghost] = 1 / cells.mass[ghost];
            cells.rho[ghost] = in.rho;
            cells.filled[ghost] = 1;
            cells.p[ghost] = in.p;
            cells.c[ghost] = in.c;
        });
    }
    fill_ghosts(grid, boundaries, cells.v);
}

}  // namespace flip
