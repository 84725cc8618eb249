// Ghost nodes: nodes of a grain whose values are those of another of its nodes, the master.
//
//        wall                          periodic mesh, a grain that wraps around it
//     g---|---m    mirror of the       o---o---o- ... -o---g     g in column i + cells_x
//         |        node behind         m                         is m in column i
//
// What particles give to a ghost is added to its master (reduce), and the ghost takes the master's
// velocity (fill): v_x of the opposite sign across a wall x = const, and v_y as well where the wall
// sticks. Nodes on a wall have a fixed velocity component instead. Frictional walls are bodies in
// contact.
#pragma once

#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

/// Finds the ghosts of a layout, fixed velocities on walls, and the nodes that forces can move.
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
            const auto add_wall = [&](Side side, long beyond, long mirror, bool is_x) {
                const Boundary kind = mesh_.boundary[side];
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
                add_wall(x_low, -i, -i, true);
                add_wall(x_high, i - nx, 2 * nx - i, true);
            }
            add_wall(y_low, -j, -j, false);
            add_wall(y_high, j - ny, 2 * ny - j, false);
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
    for (const long dof : fixed_x_) fixed_[dof] |= 1;
    for (const long dof : fixed_y_) fixed_[dof] |= 2;
    for (const GhostNode& ghost : ghosts_) fixed_[ghost.dof] |= 4;
}

}  // namespace mpm
