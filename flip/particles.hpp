// What a particle carries is what `pic` and `flip` differ in. Harlow's particles are mass and a
// label: velocity and energy live in the cells. FLIP's particles carry everything, and the mesh is
// a scratch pad.
#pragma once

#include <array>
#include <atomic>
#include <cstdlib>
#include <vector>

#include "common/counting_sort.hpp"
#include "common/grid.hpp"

namespace flip {

using common::Field;
using common::Grid;

/// Structure of arrays, per unit length along y; in memory row of cells by row of cells, nearly: see
/// keep_in_rows().
/// In `pic` only position, mass and material, and L_p; the rest is empty there.
struct Particles {
    std::vector<double> x_p, z_p;    // position
    std::vector<double> m_p;         // mass
    std::vector<int> material;       // which one, from 0
    std::vector<double> vx_p, vz_p;  // velocity
    std::vector<double> e_p;         // specific internal energy
    std::vector<double> V_p;         // volume, where the scheme has particles carry it
    std::vector<double> Cxx_p, Cxz_p, Czx_p,
        Czz_p;                // apic: gradient of the velocity, C_ij = dv_i/dx_j
    bool swirl = false;       // whether they turn about the axis
    std::vector<double> L_p;  // then, angular momentum per mass, r v_theta
    // Row j of cells, or one beside it, has particles [first_of_row[j], [j + 1]); empty: out of order.
    std::vector<int> first_of_row;

    long count() const { return long(x_p.size()); }
    /// Every column of numbers, in use or not.
    std::array<std::vector<double>*, 12> all() {
        return {&x_p, &z_p, &m_p, &vx_p, &vz_p, &e_p, &V_p, &Cxx_p, &Cxz_p, &Czx_p, &Czz_p, &L_p};
    }
};

/// Names the columns, for writing and for reading a checkpoint alike; L_p where the case has it.
template <class Archive>
void archive(Archive& a, Particles& particles) {
    static constexpr std::array<const char*, 12> names{"x_p",   "z_p",   "m_p",   "vx_p",
                                                       "vz_p",  "e_p",   "V_p",   "Cxx_p",
                                                       "Cxz_p", "Czx_p", "Czz_p", "L_p"};
    const auto all = particles.all();
    const std::size_t used = all.size() - (particles.swirl ? 0 : 1);
    for (std::size_t k = 0; k < used; ++k) a(names[k], *all[k]);
    a("material", particles.material);
    a("first_of_row", particles.first_of_row);
}

/// Loops over particles take so many at a time: what vectorizes is done for all of them first.
inline constexpr long batch_size = 128;

/// Whether a column is in use.
inline bool has(const std::vector<double>& column) { return !column.empty(); }

/// Removes the particles p for which gone(p) is true; the others keep their order, but not their rows.
template <class Gone>
void remove_if(Particles& particles, const Gone& gone) {
    long kept = 0;
    const auto columns = particles.all();
    for (long p = 0; p < particles.count(); ++p) {
        if (gone(p)) continue;
        if (kept != p) {
            for (std::vector<double>* column : columns)
                if (has(*column)) (*column)[kept] = (*column)[p];
            particles.material[kept] = particles.material[p];
        }
        ++kept;
    }
    for (std::vector<double>* column : columns)
        if (has(*column)) column->resize(kept);
    particles.material.resize(kept);
    particles.first_of_row.clear();
}

/// The cell that a position is in; a position on the upper end of the mesh counts to the last cell. The
/// same everywhere, so that a particle is never counted in one cell and looked for in another.
struct CellAlong {
    double low, per_cell;
    int last;
    explicit CellAlong(const common::Axis& axis)
        : low(axis.low), per_cell(1 / axis.spacing()), last(int(axis.cells) - 1) {}
    int operator()(double position) const {
        const int cell = int((position - low) * per_cell);
        return cell < last ? cell : last;
    }
};
inline long cell_along(const common::Axis& axis, double position) {
    return CellAlong(axis)(position);
}

/// Room for one permutation, kept between sorts.
struct SortScratch {
    common::SortScratch<double> numbers;
    std::vector<int> labels;
};

/// Stable sort by row of cells. Cost: particles + rows.
/// in/out: particles, every position on the mesh; first_of_row is rebuilt
/// exact:  the order depends on the positions alone, not on the number of threads
inline void sort_particles(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const CellAlong row(grid.z);
    const double* z_p = particles.z_p.data();
    common::counting_sort(
        particles.count(), grid.z.cells, [=](long p) { return row(z_p[p]); }, scratch.numbers,
        &particles.first_of_row);
    for (std::vector<double>* column : particles.all())
        if (has(*column))
            common::carry_to_place(*column, scratch.numbers.target, scratch.numbers.column);
    common::carry_to_place(particles.material, scratch.numbers.target, scratch.labels);
}

/// Whether every particle is in the row of cells that first_of_row says, or in one beside it.
inline bool near_their_rows(const Grid& grid, const Particles& particles) {
    const std::vector<int>& first = particles.first_of_row;
    if (std::ssize(first) != grid.z.cells + 1 || first.front() != 0 ||
        first.back() != particles.count() || !std::is_sorted(first.begin(), first.end()))
        return false;
    const CellAlong row(grid.z);
    const double* z_p = particles.z_p.data();
    std::atomic<bool> near{true};
    common::for_each_row(
        grid.z.cells,
        [&](long j) {
            const int here = int(j);
            int farthest = 0;
            for (long p = first[j]; p < first[j + 1]; ++p)
                farthest = std::max(farthest, std::abs(row(z_p[p]) - here));
            if (farthest > 1) near = false;
        },
        particles.count());
    return near;
}

/// Sorts particles when one of them is more than a row of cells from where first_of_row has it: a
/// sort costs a third of a step, and in most steps few of them come into another row.
/// out:    whether it has sorted
/// exact:  the order depends on the positions, now and at earlier sorts, not on the number of threads
inline bool keep_in_rows(const Grid& grid, SortScratch& scratch, Particles& particles) {
    if (near_their_rows(grid, particles)) return false;
    sort_particles(grid, scratch, particles);
    return true;
}

/// Calls work(begin, end) for the particles of each pair of rows of cells. Those at work at the
/// same time share no node and no cell: with a row on either side, in which they may be, and one more
/// of the cells around them, they write to six rows.
template <class Work>
void for_each_band(const Grid& grid, const Particles& particles, const Work& work) {
    const std::vector<int>& first = particles.first_of_row;
    common::for_each_row_colored(
        3, (grid.z.cells + 1) / 2,
        [&](long band) { work(first[2 * band], first[std::min(2 * band + 2, grid.z.cells)]); },
        particles.count());
}

}  // namespace flip
