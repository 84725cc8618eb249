// The layout of the sparse grid: which nodes every grain gets, when its particles are sorted.
//
// The particles of a grain are sorted by row of cells; each row is a tile. Around each tile a block
// of nodes is wide enough for particles that move by half a cell; a row of nodes reaches from the
// first to the last column of all blocks that touch it:
//
//     row 2        o---o---o           first_column[2] = 2, end_column[2] = 5
//                    x | x             a tile: the particles x between rows 1 and 2
//     row 1    o---o---o---o---o       first_column[1] = 1, end_column[1] = 6
//                x | x | x | x         another tile
//     row 0    o---o---o---o---o       dof of node (i, j) = origin[j] + i
//
// The dofs of a row, of a grain, and of all grains are consecutive; origin[j] is where column 0
// would be.
#pragma once

#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

namespace detail {

inline long cell_of(double x, double low, double h) {
    return static_cast<long>(std::floor((x - low) / h));
}

// A grain beyond the end of a periodic mesh comes back as a whole; one that reaches around it is
// cut where the mesh ends.
inline void wrap(const Mesh& mesh, const Grain& grain, int& wraps, Particles& particles) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (long p = grain.begin; p < grain.end; ++p) {
        const double x = particles.x_p[p];
        low = std::min(low, x), high = std::max(high, x);
    }
    const double length = mesh.length_x();
    wraps = wraps != 0 || high - low > length - 4 * mesh.h;
    const double center = 0.5 * (low + high) - mesh.x_low;
    const double shift = wraps != 0 ? 0 : -length * std::floor(center / length);
    for (long p = grain.begin; p < grain.end; ++p) {
        double& x = particles.x_p[p];
        if (wraps != 0) {
            const double turns = std::floor((x - mesh.x_low) / length);
            if (turns != 0) x -= turns * length;
        } else if (shift != 0) {
            x += shift;
        }
    }
}

}  // namespace detail

inline void GrainNodes::sort(const std::vector<Grain>& grains, Particles& particles,
                             GridLayout& layout) {
    layout.wraps.resize(grains.size());
    if (mesh_.periodic_x)
        for (std::size_t g = 0; g < grains.size(); ++g)
            detail::wrap(mesh_, grains[g], layout.wraps[g], particles);

    // Every grain has one tile per row of cells from its lowest to its highest.
    const std::size_t count = grains.size();
    std::vector<long> low(count), first_tile(count + 1, 0);
    layout.tiles.resize(count);
    for (std::size_t g = 0; g < count; ++g) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (long p = grains[g].begin; p < grains[g].end; ++p) {
            const double y = particles.y_p[p];
            least = std::min(least, y), most = std::max(most, y);
        }
        low[g] = detail::cell_of(least, mesh_.y_low, mesh_.h);
        const long rows = detail::cell_of(most, mesh_.y_low, mesh_.h) - low[g] + 1;
        layout.tiles[g] = static_cast<int>(rows);
        first_tile[g + 1] = first_tile[g] + rows;
    }
    std::vector<int> owner(static_cast<std::size_t>(particles.count()));
    for (std::size_t g = 0; g < count; ++g)
        std::fill(owner.begin() + grains[g].begin, owner.begin() + grains[g].end,
                  static_cast<int>(g));
    const auto tile_of = [&](long p) {
        const auto n = static_cast<std::size_t>(p);
        const auto g = static_cast<std::size_t>(owner[n]);
        const long row = detail::cell_of(particles.y_p[n], mesh_.y_low, mesh_.h) - low[g];
        return static_cast<int>(first_tile[g] + row);
    };
    common::counting_sort(particles.count(), first_tile[count], tile_of, scratch_,
                          &layout.tile_begin);
    for (std::vector<double>* quantity : particles.all())
        common::carry_to_place(*quantity, scratch_.target, scratch_.column);
    particles.surface.follow(scratch_.target);
    if (!particles.turn_p.empty())
        common::carry_to_place(particles.turn_p, scratch_.target, scratch_.column);
    for (const auto& some : {particles.from(), particles.half_sides()})
        for (std::vector<double>* quantity : some)
            if (!quantity->empty())
                common::carry_to_place(*quantity, scratch_.target, scratch_.column);
    if (particles.has_affine())
        for (std::vector<double>* quantity : particles.affine())
            common::carry_to_place(*quantity, scratch_.target, scratch_.column);

    // Rows of nodes around the tiles, wide enough for particles that move by the reach.
    layout.first_row.resize(count), layout.rows.resize(count);
    layout.first_column.clear(), layout.end_column.clear();
    const double spare = reach * mesh_.h;
    for (std::size_t g = 0; g < count; ++g) {
        struct Reach {
            long first_row, end_row, first_column, end_column;
        };
        std::vector<Reach> reaches;
        long first_row = std::numeric_limits<long>::max(),
             end_row = std::numeric_limits<long>::min();
        for (int s = 0; s < layout.tiles[g]; ++s) {
            const auto k = static_cast<std::size_t>(first_tile[g] + s);
            const int begin = layout.tile_begin[k], end = layout.tile_begin[k + 1];
            if (begin == end) continue;
            const auto [x_least, x_most] =
                std::minmax_element(particles.x_p.begin() + begin, particles.x_p.begin() + end);
            const auto [y_least, y_most] =
                std::minmax_element(particles.y_p.begin() + begin, particles.y_p.begin() + end);
            reaches.push_back(
                {detail::cell_of(*y_least - spare, mesh_.y_low, mesh_.h) - below_,
                 detail::cell_of(*y_most + spare, mesh_.y_low, mesh_.h) + above_ + 1,
                 detail::cell_of(*x_least - spare, mesh_.x_low, mesh_.h) - below_,
                 detail::cell_of(*x_most + spare, mesh_.x_low, mesh_.h) + above_ + 1});
            first_row = std::min(first_row, reaches.back().first_row);
            end_row = std::max(end_row, reaches.back().end_row);
        }
        const std::size_t table = layout.first_column.size();
        layout.first_row[g] = static_cast<int>(first_row);
        layout.rows[g] = static_cast<int>(end_row - first_row);
        layout.first_column.resize(table + static_cast<std::size_t>(end_row - first_row), 0);
        layout.end_column.resize(layout.first_column.size(), 0);
        for (const Reach& r : reaches) {
            for (long j = r.first_row; j < r.end_row; ++j) {
                const auto row = table + static_cast<std::size_t>(j - first_row);
                int &first = layout.first_column[row], &end = layout.end_column[row];
                const bool empty = first == end;
                first = empty ? static_cast<int>(r.first_column)
                              : std::min(first, static_cast<int>(r.first_column));
                end = empty ? static_cast<int>(r.end_column)
                            : std::max(end, static_cast<int>(r.end_column));
            }
        }
    }
    layout.moved = 0;
    lay_out(grains, layout);
}

inline void GrainNodes::lay_out(const std::vector<Grain>& grains, const GridLayout& layout) {
    const std::size_t count = grains.size();
    origin_.clear(), tiles_.clear();
    row_begin_.assign(count + 1, 0), first_of_grain_.assign(count, 0);
    dof_begin_.assign(count + 1, 0);
    long dofs = 0, row = 0;
    for (std::size_t g = 0; g < count; ++g) {
        row_begin_[g] = row, first_of_grain_[g] = row - layout.first_row[g], dof_begin_[g] = dofs;
        for (int r = 0; r < layout.rows[g]; ++r, ++row) {
            const auto k = static_cast<std::size_t>(row);
            origin_.push_back(dofs - layout.first_column[k]);
            dofs += layout.end_column[k] - layout.first_column[k];
        }
    }
    row_begin_[count] = row, dof_begin_[count] = dofs;
    const auto size = static_cast<std::size_t>(dofs);
    sums.resize(size), mass.resize(size), motion.resize(size), force.resize(size);

    // Pieces of work: so many rows that the next but one shares no node.
    constexpr long particles_per_piece = 1024;
    pieces_.assign(1, 0);
    long rows_in_piece = 0, particles_in_piece = 0;
    std::size_t cells = 0;  // rows of cells so far
    for (std::size_t g = 0; g < count; ++g) {
        for (int r = 0; r < layout.tiles[g]; ++r, ++cells) {
            const long begin = layout.tile_begin[cells], end = layout.tile_begin[cells + 1];
            const bool new_piece = pieces_.back() == static_cast<long>(tiles_.size());
            if (new_piece || tiles_.back().grain != static_cast<int>(g))
                tiles_.push_back({static_cast<int>(g), begin, begin});
            tiles_.back().end = end;
            particles_in_piece += end - begin, ++rows_in_piece;
            if (particles_in_piece < particles_per_piece || rows_in_piece < rows_apart_) continue;
            pieces_.push_back(static_cast<long>(tiles_.size()));
            particles_in_piece = rows_in_piece = 0;
        }
    }
    if (pieces_.back() < static_cast<long>(tiles_.size()))
        pieces_.push_back(static_cast<long>(tiles_.size()));
    find_ghost_nodes(grains, layout);
    find_shared_nodes(grains, layout);
    place_surface();
}

}  // namespace mpm
