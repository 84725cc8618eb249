// The Eulerian mesh of the classical method: a scratch pad, rebuilt in every step from the
// particles and the little that cells remember (velocity and internal energy, see state.hpp).
//
//     M, I, u --Lagrangian phase--> u~, I~ --particles move, Eulerian phase--> M, I, u
//
// All quantities live at centers of cells; cell (i, j) sits at grid.index(i, j). Behind the ends of
// the mesh stands one ring of ghost cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
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
    std::size_t materials = 1;
    std::vector<double> M;        // mass of each material
    Field mass, per_mass;         // of all; 1/mass, 0 in an empty cell
    Field filled;                 // 1, or 0 in an empty cell
    Field p, c;                   // pressure, speed of sound
    std::vector<double> share;    // of the work of the pressure, that each material takes
    Field q_x, q_z;               // viscous pressure on the face between cell (i, j) and the one
                                  // before it along x, along z
    std::vector<CellVelocity> v;  // u
    std::vector<CellVelocity> v_tilde;  // u~
    std::vector<double> e_tilde;        // I~ of each material

    std::vector<int> home;     // of each particle, the cell that it comes from
    std::vector<double> sums;  // what particles bring to a cell
    std::vector<double> row;   // one number per row of cells
    SortScratch sort;

    explicit PicCells(const Problem& problem) : materials(problem.materials.size()) {
        const auto size = static_cast<std::size_t>(problem.grid.size());
        for (Field* f : {&mass, &per_mass, &filled, &p, &c, &q_x, &q_z})
            *f = Field::Zero(problem.grid.size());
        for (auto* f : {&M, &share, &e_tilde}) f->assign(size * materials, 0.0);
        v.assign(size, {});
        v_tilde.assign(size, {});
        row.assign(static_cast<std::size_t>(problem.grid.z.cells), 0.0);
        sums.assign(static_cast<std::size_t>(problem.grid.x.cells * problem.grid.z.cells) *
                        (3 + 2 * materials),
                    0.0);
    }
};

/// The home of particles that have just entered: a corner that is no cell and no ghost.
inline int outside(const Grid& grid) { return static_cast<int>(grid.size()) - 1; }

/// Calls work(j) for every row of cells.
template <class Work>
void for_each_row_of_cells(const Grid& grid, const Work& work) {
    if (grid.x.cells * grid.z.cells < common::parallel_threshold) {
        for (long j = 0; j < grid.z.cells; ++j) work(j);
    } else {
        common::for_each_row(grid.z.cells, work);
    }
}

/// Sum over rows of cells, added in the order of the rows.
template <class SumOfRow>
double sum_over_rows(const Grid& grid, PicCells& cells, const SumOfRow& sum_of_row) {
    for_each_row_of_cells(grid,
                          [&](long j) { cells.row[static_cast<std::size_t>(j)] = sum_of_row(j); });
    double sum = 0;
    for (const double part : cells.row) sum += part;
    return sum;
}

/// Calls visit(ghost, inside) for every ghost cell behind one end, with the cell whose image it is.
/// note:   first the ends along x, then those along z, which take the corners with them
template <class Visit>
void for_each_ghost(const Grid& grid, Side end, const Visit& visit) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    const bool low = end == x_low || end == z_low;
    if (end == x_low || end == x_high) {
        const long ghost = low ? -1 : nx, inside = low == grid.x.periodic ? nx - 1 : 0;
        for (long j = 0; j < nz; ++j) visit(grid.index(ghost, j), grid.index(inside, j));
    } else {
        const long ghost = low ? -1 : nz, inside = low == grid.z.periodic ? nz - 1 : 0;
        for (long i = -1; i <= nx; ++i) visit(grid.index(i, ghost), grid.index(i, inside));
    }
}

/// Fills the ghosts of a velocity: images around a periodic direction; the mirror image behind a
/// wall, whose normal component is odd; the same velocity behind an open end; what comes in.
inline void fill_ghosts(const Problem& problem, std::vector<CellVelocity>& v) {
    const Inflow& in = problem.boundaries.inflow;
    for (const Side end : all_sides) {
        const bool wall = problem.boundaries.is(end, BoundaryKind::slip),
                   along_x = end == x_low || end == x_high;
        const double odd_x = wall && along_x ? -1 : 1, odd_z = wall && !along_x ? -1 : 1;
        const bool comes_in = problem.boundaries.is(end, BoundaryKind::inflow);
        for_each_ghost(problem.grid, end, [&](long ghost, long inside) {
            const CellVelocity a = v[static_cast<std::size_t>(inside)];
            v[static_cast<std::size_t>(ghost)] =
                comes_in ? CellVelocity{in.vx, in.vz} : CellVelocity{odd_x * a.x, odd_z * a.z};
        });
    }
}

/// Fills the ghosts of what share_pressure() makes.
/// note:   behind an open end p is such that its mean with the cell inside is the pressure outside
inline void fill_ghosts(const Problem& problem, PicCells& cells) {
    const Inflow& in = problem.boundaries.inflow;
    const double V = problem.grid.cell_area();
    for (const Side end : all_sides) {
        const bool open = problem.boundaries.is(end, BoundaryKind::open),
                   comes_in = problem.boundaries.is(end, BoundaryKind::inflow);
        const double outside_pressure = problem.boundaries.side[end].pressure;
        for_each_ghost(problem.grid, end, [&](long ghost, long inside) {
            for (Field* f : {&cells.mass, &cells.per_mass, &cells.filled, &cells.p, &cells.c})
                (*f)[ghost] = (*f)[inside];
            if (open) cells.p[ghost] = 2 * outside_pressure - cells.p[inside];
            if (comes_in) {
                cells.mass[ghost] = in.rho * V;
                cells.per_mass[ghost] = 1 / cells.mass[ghost];
                cells.filled[ghost] = 1;
                cells.p[ghost] = in.p;
                cells.c[ghost] = in.c;
            }
        });
    }
    fill_ghosts(problem, cells.v);
}

/// Column of cells of a position along x, and of its row along z; the same everywhere, so that a
/// particle is never counted in one cell and looked for in another.
struct Columns {
    double low, per_dx;
    int last;
    explicit Columns(const common::Axis& axis)
        : low(axis.low), per_dx(1 / axis.spacing()), last(static_cast<int>(axis.cells) - 1) {}
    int operator()(double x) const {
        const int i = static_cast<int>((x - low) * per_dx);
        return i < last ? i : last;
    }
};

/// Sums over the cells.
/// in: cells whose mass belongs to the state: after repartition() or weigh_cells()
inline Totals totals_of(const Problem& problem, const State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const long nx = grid.x.cells;
    const std::size_t K = cells.materials;
    const double x_middle = grid.x.low + 0.5 * grid.x.length,
                 z_middle = grid.z.low + 0.5 * grid.z.length;
    const auto sum = [&](const auto& of_cell) {
        return sum_over_rows(grid, cells, [&](long j) {
            double part = 0;
            for (long i = 0; i < nx; ++i) part += of_cell(grid.index(i, j), i, j);
            return part;
        });
    };
    const Field &M = cells.mass, &vx = state.cells.vx, &vz = state.cells.vz;
    const double x_first = grid.x.at(0.5) - x_middle, z_first = grid.z.at(0.5) - z_middle,
                 dx = grid.x.spacing(), dz = grid.z.spacing();
    Totals t;
    t.mass = sum([&](long n, long, long) { return M[n]; });
    t.momentum_x = sum([&](long n, long, long) { return M[n] * vx[n]; });
    t.momentum_z = sum([&](long n, long, long) { return M[n] * vz[n]; });
    t.angular_momentum = sum([&](long n, long i, long j) {
        const double x = x_first + dx * static_cast<double>(i),
                     z = z_first + dz * static_cast<double>(j);
        return M[n] * (x * vz[n] - z * vx[n]);
    });
    t.kinetic =
        sum([&](long n, long, long) { return 0.5 * M[n] * (vx[n] * vx[n] + vz[n] * vz[n]); });
    t.internal = sum([&](long n, long, long) {
        double U = 0;
        for (std::size_t k = 0; k < K; ++k)
            U += cells.M[static_cast<std::size_t>(n) * K + k] * state.cells.e[k][n];
        return U;
    });
    return t;
}

/// The fluid on the cells.
/// in:  cells after share_pressure()
/// out: fields, zero in empty cells; reused from step to step
inline void fields_of(const Problem& problem, const State& state, const PicCells& cells,
                      CellFields& fields) {
    const Grid& grid = problem.grid;
    const std::size_t K = cells.materials;
    const double per_V = 1 / grid.cell_area();
    if (fields.rho.size() != grid.size()) {
        for (Field* f : {&fields.rho, &fields.vx, &fields.vz, &fields.p, &fields.e})
            *f = Field::Zero(grid.size());
        fields.rho_of.assign(K, fields.rho);
    }
    for_each_row_of_cells(grid, [&](long j) {
        for (long n = grid.index(0, j); n < grid.index(grid.x.cells, j); ++n) {
            fields.rho[n] = cells.mass[n] * per_V;
            fields.vx[n] = state.cells.vx[n];
            fields.vz[n] = state.cells.vz[n];
            fields.p[n] = cells.p[n];
            double U = 0;
            for (std::size_t k = 0; k < K; ++k) {
                const double M = cells.M[static_cast<std::size_t>(n) * K + k];
                fields.rho_of[k][n] = M * per_V;
                U += M * state.cells.e[k][n];
            }
            fields.e[n] = U * cells.per_mass[n];
        }
    });
}

}  // namespace flip
