// What is refused of a state that was read from a file: what no run of the case can have.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/grid/grain_nodes.hpp"
#include "mpm_explicit/setup/grain_shapes.hpp"

namespace mpm {

namespace detail {

// Refuses tables of a layout that do not belong together, or reach farther than the grains.
inline void validate_layout(const Mesh& mesh, const Assembly& all, const GridLayout& layout) {
    const std::size_t count = all.grains.size();
    const auto in_tables = [&](const std::vector<int>& of_grain, int least) {
        return of_grain.size() == count && common::all_within(of_grain, least, 1e5);
    };
    const auto sum = [](const std::vector<int>& all_of) {
        std::size_t total = 0;
        for (const int one : all_of) total += static_cast<std::size_t>(one);
        return total;
    };
    bool fits = in_tables(layout.first_row, -100000) && in_tables(layout.rows, 1) &&
                in_tables(layout.tiles, 1) && in_tables(layout.wraps, 0) &&
                common::all_within(layout.wraps, 0, mesh.periodic_x ? 1 : 0) &&
                layout.first_column.size() == sum(layout.rows) &&
                layout.end_column.size() == sum(layout.rows) &&
                layout.tile_begin.size() == sum(layout.tiles) + 1 && layout.moved >= 0 &&
                std::is_sorted(layout.tile_begin.begin(), layout.tile_begin.end());
    // A sort comes before a particle has crossed the mesh.
    fits = fits && layout.moved <= mesh.length_x() + mesh.y_high() - mesh.y_low;
    refuse(!fits, "the tables of its nodes do not belong together");

    const Particles& at = all.particles;
    std::size_t tile = 0, row = 0;
    for (std::size_t g = 0; g < count; ++g) {
        const Grain& grain = all.grains[g];
        const auto [left, right] =
            std::minmax_element(at.x_p.begin() + grain.begin, at.x_p.begin() + grain.end);
        const auto [low, high] =
            std::minmax_element(at.y_p.begin() + grain.begin, at.y_p.begin() + grain.end);
        // Half a cell was spared, particles may have moved, and a shape reaches two nodes far.
        const long margin = 4 + static_cast<long>(std::min(layout.moved / mesh.h, 1e5));
        const auto before = [&](double x, double end) { return cell_of(x, end, mesh.h) - margin; };
        const auto behind = [&](double x, double end) { return cell_of(x, end, mesh.h) + margin; };
        fits = fits && layout.tile_begin[tile] == grain.begin &&
               layout.first_row[g] >= before(*low, mesh.y_low) &&
               layout.first_row[g] + layout.rows[g] <= behind(*high, mesh.y_low) + 2;
        for (const std::size_t end = row + static_cast<std::size_t>(layout.rows[g]); row < end;
             ++row) {
            const int first = layout.first_column[row], last = layout.end_column[row];
            fits = fits && ((first == 0 && last == 0) ||
                            (first < last && first >= before(*left, mesh.x_low) &&
                             last <= behind(*right, mesh.x_low) + 2));
        }
        tile += static_cast<std::size_t>(layout.tiles[g]);
        fits = fits && layout.tile_begin[tile] == grain.end;
    }
    refuse(!fits, "the tables of its nodes are not those of its grains");
}

// Refuses particles that may leave the nodes of their grain before they are sorted again.
inline void validate_tiles(const Mesh& mesh, int width, const Assembly& all,
                           const GridLayout& layout) {
    const double spare = GrainNodes::sorted_within(mesh) - layout.moved;
    if (spare < 0) return;  // they are sorted before the next step
    const Particles& at = all.particles;
    const auto first_node = [&](double x, double from) {
        return width == 2 ? cell_of(x, from, mesh.h) : cell_of(x + 0.5 * mesh.h, from, mesh.h) - 1;
    };
    bool fits = true;
    std::size_t tile = 0, table = 0;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        for (int s = 0; s < layout.tiles[g]; ++s, ++tile) {
            for (int k = layout.tile_begin[tile]; k < layout.tile_begin[tile + 1]; ++k) {
                const auto p = static_cast<std::size_t>(k);
                const double x = at.x_p[p], y = at.y_p[p];
                const long first = first_node(y - spare, mesh.y_low) - layout.first_row[g],
                           last = first_node(y + spare, mesh.y_low) + width - layout.first_row[g],
                           left = first_node(x - spare, mesh.x_low),
                           right = first_node(x + spare, mesh.x_low) + width;
                // The first row of cells is that of the nodes, or one above it.
                const long above = cell_of(y, mesh.y_low, mesh.h) - layout.first_row[g] - s;
                fits = fits && above >= width - 3 && above <= width && first >= 0 &&
                       last <= layout.rows[g];
                for (long r = first; fits && r < last; ++r) {
                    const std::size_t row = table + static_cast<std::size_t>(r);
                    fits = layout.first_column[row] <= left && layout.end_column[row] >= right;
                }
            }
        }
        table += static_cast<std::size_t>(layout.rows[g]);
    }
    refuse(!fits, "a particle is not where the nodes of its grain are");
}

}  // namespace detail

/// Refuses particles and nodes that no run on this mesh can have.
/// in:     width of the shape function in nodes; affine, turns: particles carry affine motion, or
///         turns; momenta of each grain
/// errors: InputError, one sentence
inline void validate_state(const Mesh& mesh, int width, bool affine, bool turns, Assembly& all,
                           const GridLayout& layout, const std::vector<Momenta>& momenta) {
    Particles& p = all.particles;
    const auto count = static_cast<std::size_t>(all.grains.back().end);
    for (const std::vector<double>* column : p.all())
        refuse(column->size() != count, "its particles are not as many as those of the case");
    for (const std::vector<double>* column : p.affine())
        refuse(column->size() != (affine ? count : 0),
               "its particles carry affine motion, or not, against method.transfer");
    refuse(p.turn_p.size() != (turns ? count : 0) || !common::all_within(p.turn_p, -1e3, 1e3),
           "the turns of its particles are not as many as those of the case, or too large");
    for (const std::vector<double>* sides : p.half_sides())
        refuse((!sides->empty() && sides->size() != count) ||
                   !common::all_within(*sides, 1e-3, 0.5) || sides->size() != p.half_x_p.size(),
               "the sides of its particles are not as many as those of the case, or too large");
    const Surface& surface = p.surface;
    bool fits = common::all_within(surface.host, 0, static_cast<int>(count) - 1) &&
                std::is_sorted(surface.host.begin(), surface.host.end()) &&
                surface.side.size() == surface.count() && common::all_within(surface.side, 0, 1);
    const double size = mesh.length_x() + mesh.y_high() - mesh.y_low,
                 most_of_M = size * size + size;
    for (const std::vector<double>* column : p.surface.all())
        fits = fits && column->size() == surface.count() &&
               common::all_within(*column, -most_of_M, most_of_M);
    refuse(!fits, "the outlines of its grains do not belong to its particles");
    refuse(momenta.size() != all.grains.size(), "its grains are not as many as those of the case");
    constexpr double least = 1e-130, most = 1e130, largest = 1e90;  // products of some are numbers
    refuse(!common::all_within(p.m_p, least, most) || !common::all_within(p.V_p, least, most),
           "a particle has no mass or no volume");
    for (const Grain& grain : all.grains) {
        const double mass =
            std::accumulate(p.m_p.begin() + grain.begin, p.m_p.begin() + grain.end, 0.0);
        refuse(!(std::fabs(mass - grain.mass) <= 1e-9 * grain.mass),
               "the mass of grain '" + grain.name + "' is not that of the case");
    }
    refuse(!common::all_within(p.yield_p, 0, largest),
           "the plastic strain of a particle is negative");
    for (const auto* column : {&p.vx_p, &p.vy_p, &p.sxx_p, &p.syy_p, &p.sxy_p, &p.szz_p, &p.cxx_p,
                               &p.cxy_p, &p.cyx_p, &p.cyy_p})
        refuse(!common::all_within(*column, -largest, largest),
               "the velocity or the stress of a particle is beyond 1e90 in size");
    const double beyond = mesh.periodic_x ? mesh.length_x() : 0;
    refuse(!common::all_within(p.x_p, mesh.x_low - beyond, mesh.x_high() + beyond) ||
               !common::all_within(p.y_p, mesh.y_low, mesh.y_high()),
           "a particle is outside of the mesh");
    detail::validate_layout(mesh, all, layout);
    detail::validate_tiles(mesh, width, all, layout);
}

}  // namespace mpm
