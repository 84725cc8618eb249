// Shared nodes: nodes of the mesh that several grains, or a grain and a frictional wall, have dofs
// at.
//
//     members_       | grain 0, dof 17 | grain 3, dof 240 | wall || grain 1, dof 80 | grain 3, dof 251 |
//     shared_begin_    0                                         3                                     5
#pragma once

#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

/// Lists the members of every shared node, in time proportional to dofs plus nodes: a first pass
/// counts the members of each node, a second one puts them in place.
inline void GrainNodes::find_shared_nodes(const std::vector<Grain>& grains,
                                          const GridLayout& layout) {
    members_.clear(), shared_begin_.assign(1, 0);
    // How many have a dof at each node, and where their list begins.
    const long nx = mesh_.cells_x, ny = mesh_.cells_y, width = nx + 2 * margin,
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
    // Grains first, in their order, then walls; but no copies of wrapped columns and no mirrored nodes.
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
        members_[-1 - at] = member;
        --at;
    });

    // Which fixed nodes are neighbors: place has the number of a fixed node, counted from 1.
    std::fill(place.begin(), place.end(), 0);
    fixed_nodes_.clear();
    for (long n = 0; n < shared_count(); ++n)
        if (std::any_of(
                members_.begin() + shared_begin_[n], members_.begin() + shared_begin_[n + 1],
                [&](const Member& one) { return one.is_wall() || grains[one.grain].rigid; }))
            fixed_nodes_.push_back({n});
    const auto for_each_fixed = [&](const auto& visit) {
        for (std::size_t n = 0; n < fixed_nodes_.size(); ++n) {
            const Member& first = members_[shared_begin_[fixed_nodes_[n].shared]];
            visit(static_cast<int>(n), std::lround((first.x - mesh_.x_low) / mesh_.h),
                  std::lround((first.y - mesh_.y_low) / mesh_.h));
        }
    };
    for_each_fixed([&](int n, long i, long j) { place[node_of(i, j)] = n + 1; });
    for_each_fixed([&](int n, long i, long j) {
        const auto at = [&](long a, long b) {
            const long node = node_of(a, b);
            return node < 0 ? -1 : place[node] - 1;
        };
        FixedNode& one = fixed_nodes_[n];
        one.left = at(i - 1, j), one.right = at(i + 1, j);
        one.below = at(i, j - 1), one.above = at(i, j + 1);
    });
}

/// Where outlines are summed up: at the members of shared nodes, and at ghosts that give to these, in
/// the order of their dofs. What particles of a grain give to lies together.
inline void GrainNodes::place_surface() {
    shared_of_.assign(sums.size(), -1);
    for (long n = 0; n < shared_count(); ++n)
        for (long l = shared_begin_[n]; l < shared_begin_[n + 1]; ++l)
            if (!members_[l].is_wall()) shared_of_[members_[l].dof] = static_cast<int>(n);
    surface_of_ = shared_of_;
    for (auto ghost = ghosts_.rbegin(); ghost != ghosts_.rend(); ++ghost)
        if (surface_of_[ghost->master] >= 0) surface_of_[ghost->dof] = surface_of_[ghost->master];
    int count = 0;
    for (int& place : surface_of_)
        if (place >= 0) place = count++;
    surface[0].resize(static_cast<std::size_t>(count));
}

}  // namespace mpm
