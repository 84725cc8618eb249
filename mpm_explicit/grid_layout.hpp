// How a grain's nodes are laid out around its particles, what walls and rings make of them, and which
// nodes several grains share: the members of GrainNodes that a sort calls.
#pragma once

#include "mpm_explicit/grain_nodes.hpp"

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
        const double x = particles.x_p[static_cast<std::size_t>(p)];
        low = std::min(low, x), high = std::max(high, x);
    }
    const double length = mesh.length_x();
    wraps = wraps != 0 || high - low > length - 4 * mesh.h;
    const double center = 0.5 * (low + high) - mesh.x_low;
    const double shift = wraps != 0 ? 0 : -length * std::floor(center / length);
    for (long p = grain.begin; p < grain.end; ++p) {
        double& x = particles.x_p[static_cast<std::size_t>(p)];
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
            const double y = particles.y_p[static_cast<std::size_t>(p)];
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
        common::carry_to_place(*quantity, scratch_);

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
    sums.resize(size), motion.resize(size), force.resize(size);

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
}

inline void GrainNodes::find_ghost_nodes(const std::vector<Grain>& grains,
                                         const GridLayout& layout) {
    ghosts_.clear(), fixed_x_.clear(), fixed_y_.clear();
    const long nx = mesh_.cells_x, ny = mesh_.cells_y;
    std::vector<GhostNode> along_y;
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const int g = static_cast<int>(k);
        for_each_dof(g, layout, [&](long dof, long i, long j) {
            if (layout.wraps[k] != 0 && has_dof(g, layout, i - nx, j))
                ghosts_.push_back({dof, dof - nx, 1, 1, false, false, mesh_.length_x()});
            if (grains[k].rigid) return;
            const auto meet = [&](Side side, long beyond, long mirror, bool is_x) {
                const Boundary kind = mesh_.boundary[static_cast<std::size_t>(side)];
                if (beyond < 0 || kind == Boundary::open || kind == Boundary::frictional) return;
                if (beyond == 0) {
                    if (is_x || kind == Boundary::stick) fixed_x_.push_back(dof);
                    if (!is_x || kind == Boundary::stick) fixed_y_.push_back(dof);
                    return;
                }
                const long i_of = is_x ? mirror : i, j_of = is_x ? j : mirror;
                if (beyond > 1 || !has_dof(g, layout, i_of, j_of)) return;
                const double tangential = kind == Boundary::stick ? -1 : 1;
                const double wall = side == x_low    ? mesh_.x_low
                                    : side == x_high ? mesh_.x_high()
                                    : side == y_low  ? mesh_.y_low
                                                     : mesh_.y_high();
                (is_x ? ghosts_ : along_y)
                    .push_back({dof, origin(g, j_of) + i_of, is_x ? -1 : tangential,
                                is_x ? tangential : -1, is_x, !is_x, 2 * wall});
            };
            if (!mesh_.periodic_x) {
                meet(x_low, -i, -i, true);
                meet(x_high, i - nx, 2 * nx - i, true);
            }
            meet(y_low, -j, -j, false);
            meet(y_high, j - ny, 2 * ny - j, false);
        });
    }
    ghosts_.insert(ghosts_.end(), along_y.begin(), along_y.end());
    boundary_ghosts_ = ghosts_.size();
    free_.assign(sums.size(), 1);
    for (std::size_t g = 0; g < grains.size(); ++g)
        if (grains[g].rigid)
            std::fill(free_.begin() + dof_begin_[g], free_.begin() + dof_begin_[g + 1],
                      static_cast<unsigned char>(0));
    fixed_.assign(sums.size(), 0);
    for (const long dof : fixed_x_) fixed_[static_cast<std::size_t>(dof)] |= 1;
    for (const long dof : fixed_y_) fixed_[static_cast<std::size_t>(dof)] |= 2;
}

inline void GrainNodes::find_shared_nodes(const std::vector<Grain>& grains,
                                          const GridLayout& layout) {
    members_.clear(), shared_begin_.assign(1, 0);
    // How many have a dof at each node, and where their list begins.
    const long nx = mesh_.cells_x, ny = mesh_.cells_y, margin = 4, width = nx + 2 * margin,
               height = ny + 2 * margin;
    const long first_i = mesh_.periodic_x ? 0 : -margin,
               end_i = mesh_.periodic_x ? nx : nx + margin;
    const auto wall = [&](Side side) {
        return Member{-1, static_cast<int>(side), side == x_low ? mesh_.x_low : mesh_.x_high(),
                      side == y_low ? mesh_.y_low : mesh_.y_high()};
    };
    const auto node_of = [&](long i, long j) -> long {
        const long column = mesh_.periodic_x ? ((i % nx) + nx) % nx : i;
        const long a = column + margin, b = j + margin;
        return a < 0 || a >= width || b < 0 || b >= height ? -1 : b * width + a;
    };
    std::vector<int> place(static_cast<std::size_t>(width * height) + 1, 0);
    const auto stands = [&](Side side) { return mesh_.has(side, Boundary::frictional); };
    // Grains first, in their order, then walls; copies of wraps columns and mirrored nodes not.
    const auto for_each_member = [&](const auto& visit) {
        for (std::size_t k = 0; k < grains.size(); ++k) {
            const int g = static_cast<int>(k);
            for_each_dof(g, layout, [&](long dof, long i, long j) {
                const bool copy = layout.wraps[k] != 0 && has_dof(g, layout, i - nx, j);
                const bool behind_x =
                    !mesh_.periodic_x && ((i < 0 && !stands(x_low)) || (i > nx && !stands(x_high)));
                const bool behind_y = (j < 0 && !stands(y_low)) || (j > ny && !stands(y_high));
                const long node = node_of(i, j);
                if (copy || behind_x || behind_y || node < 0) return;
                visit(static_cast<std::size_t>(node),
                      Member{dof, g, mesh_.x_of(static_cast<double>(i)),
                             mesh_.y_of(static_cast<double>(j))});
            });
        }
        for (long deep = 0; deep < margin; ++deep) {
            for (long j = -margin; j < ny + margin && !mesh_.periodic_x; ++j) {
                if (stands(x_low)) visit(static_cast<std::size_t>(node_of(-deep, j)), wall(x_low));
                if (stands(x_high))
                    visit(static_cast<std::size_t>(node_of(nx + deep, j)), wall(x_high));
            }
            for (long i = first_i; i < end_i; ++i) {
                if (stands(y_low)) visit(static_cast<std::size_t>(node_of(i, -deep)), wall(y_low));
                if (stands(y_high))
                    visit(static_cast<std::size_t>(node_of(i, ny + deep)), wall(y_high));
            }
        }
    };
    for_each_member([&](std::size_t node, const Member&) { ++place[node]; });
    // Shared nodes in the order in which their first grain has them, for the sake of the cache; a
    // node that has begun keeps -1 - (where its next member goes).
    int next = 0;
    for_each_member([&](std::size_t node, const Member& member) {
        int& at = place[node];
        if (at == 1) return;
        if (at > 1) {
            const int begin = next;
            next += at, at = -1 - begin;
            shared_begin_.push_back(next);
            members_.resize(static_cast<std::size_t>(next));
        }
        members_[static_cast<std::size_t>(-1 - at)] = member;
        --at;
    });
}

}  // namespace mpm
