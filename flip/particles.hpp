// What a particle carries is what `pic` and `flip` differ in. Harlow's particles are mass and a
// label: velocity and energy live in the cells. FLIP's particles carry everything, and the mesh is
// a scratch pad.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/counting_sort.hpp"
#include "common/grid.hpp"

namespace flip {

using common::Field;
using common::Grid;

/// Structure of arrays, per unit length along y; in memory row of cells by row of cells.
/// In `pic` only position, mass and material; the rest is empty there.
struct Particles {
    std::vector<double> x_p, z_p;    // position
    std::vector<double> m_p;         // mass
    std::vector<int> material;       // which one, from 0
    std::vector<double> vx_p, vz_p;  // velocity
    std::vector<double> e_p;         // specific internal energy
    std::vector<double> V_p;         // volume, where the scheme has particles carry it
    std::vector<double> Cxx_p, Cxz_p, Czx_p,
        Czz_p;                      // apic: gradient of the velocity, C_ij = dv_i/dx_j
    std::vector<int> first_of_row;  // row j of cells has particles [first_of_row[j], [j + 1])

    long count() const { return static_cast<long>(x_p.size()); }
    /// Every column of numbers, in use or not.
    std::array<std::vector<double>*, 11> all() {
        return {&x_p, &z_p, &m_p, &vx_p, &vz_p, &e_p, &V_p, &Cxx_p, &Cxz_p, &Czx_p, &Czz_p};
    }
};

/// Names the columns, for writing and for reading a checkpoint alike.
template <class Archive>
void archive(Archive& a, Particles& particles) {
    static constexpr std::array<const char*, 11> names{
        "x_p", "z_p", "m_p", "vx_p", "vz_p", "e_p", "V_p", "Cxx_p", "Cxz_p", "Czx_p", "Czz_p"};
    const auto all = particles.all();
    for (std::size_t k = 0; k < all.size(); ++k) a(names[k], *all[k]);
    a("material", particles.material);
}

/// Whether a column is in use.
inline bool has(const std::vector<double>& column) { return !column.empty(); }

/// Removes the particles p for which gone(p) is true; the others keep their order.
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
}

/// The cell that a position is in; a position on the upper end of the mesh counts to the last cell.
inline long cell_along(const common::Axis& axis, double position) {
    const long cell = static_cast<long>((position - axis.low) / axis.spacing());
    return cell < axis.cells ? cell : axis.cells - 1;
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
    const double *z_p = particles.z_p.data(), z_low = grid.z.low, per_dz = 1 / grid.z.spacing();
    const int last = static_cast<int>(grid.z.cells) - 1;
    common::counting_sort(
        particles.count(), grid.z.cells,
        [=](long p) {
            const int row = static_cast<int>((z_p[p] - z_low) * per_dz);
            return row < last ? row : last;
        },
        scratch.numbers, &particles.first_of_row);
    for (std::vector<double>* column : particles.all())
        if (has(*column)) common::carry_to_place(*column, scratch.numbers);
    common::carry_to_place(particles.material, scratch.numbers.target, scratch.labels);
}

}  // namespace flip
