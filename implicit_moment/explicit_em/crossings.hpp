// Particles on their way from one cell to another.
//
// In a step one particle in ten leaves its cell. The push takes those out of their cells: they wait here,
// and the others of a cell close ranks. sort_by_cell then moves whole cells and puts those that wait
// into the cells that they have come to; nothing is sorted anew.
#pragma once

#include <array>
#include <vector>

#include "implicit_moment/explicit_em/stencil.hpp"
#include "implicit_moment/ranks/division.hpp"

namespace implicit_moment {

/// Rows of cells that one thread works on at a time, a tile: what crosses between cells is kept by the
/// tile that it leaves, and a cell is in tile cell / cells_of_tile.
inline constexpr long rows_of_tile = 4;
inline long tiles_of(long rows) { return (rows + rows_of_tile - 1) / rows_of_tile; }
template <int l>
inline long cells_of_tile(const Grid& grid) {
    return rows_of_tile * Stencil<l>::cells(grid.x);
}
/// The same for either order of the splines.
inline long cells_of_tile(const Grid& grid, long order) {
    return order == 1 ? cells_of_tile<1>(grid) : cells_of_tile<2>(grid);
}

/// Of one species, between the push and sort_by_cell.
struct Crossings {
    struct OfTile {
        std::vector<int> to_cell;                             // one entry per particle that crosses
        std::vector<std::array<ParticleReal, 5>> quantities;  // in the order of Particles::all()
        std::array<std::vector<ParticleReal>, 5> below, above;  // room for sort_by_cell

        void clear() { to_cell.clear(), quantities.clear(); }
    };
    std::vector<OfTile> tiles;
    Division of_ranks;            // the tiles of each rank
    std::vector<int> staying;     // [cell] particles that have stayed: the first of the cell
    std::vector<int> first_next;  // [cell] where it begins after the step; one more for the end

    /// Empties it: no particle crosses.
    void clear(long cells, long per_tile, const Division& division) {
        of_ranks = division;
        tiles.resize(std::size_t((cells + per_tile - 1) / per_tile));
        for (OfTile& tile : tiles) tile.clear();
        staying.assign(std::size_t(cells), 0);
    }
};

}  // namespace implicit_moment
