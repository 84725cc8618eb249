// One field per grain, on the nodes that the grain touches and nowhere else: a sparse grid.
//
// A grain's nodes are stored row by row. A row is a stretch of columns, and the node in column i
// has the dof index origin[row] + i; so a particle finds its nodes with one look at a small table,
// and memory is proportional to the area that the grains cover. Two grains that touch the same node
// have two dofs there, and contact.hpp lets them act on each other.
//
//      o   o---o---o---o   o        a grain's rows: half a cell wider than the grain, so that they hold its
//    o---o---o---o---o---o---o      particles until one of them has moved by that
//      o   o---o---o---o   o
//
// Columns are counted on beyond the ends of a periodic mesh: a grain that straddles them keeps its
// particles together, at positions beyond the end. Only a grain that wraps around the whole mesh
// has its particles put back into the box, and two copies of the columns where its ends meet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "common/counting_sort.hpp"
#include "common/parallel.hpp"
#include "mpm_explicit/grains/grains.hpp"
#include "mpm_explicit/grid/mesh.hpp"
#include "mpm_explicit/grid/surface_sums.hpp"
#include "mpm_explicit/particles.hpp"

namespace mpm {

/// What particles put on a node of their grain, in one line of the cache.
struct alignas(64) NodeSums {
    double m;       // mass:                 sum_p m_p S_ip
    double px, py;  // momentum:             sum_p m_p v_p S_ip
    double mx, my;  // mass times position:  sum_p m_p x_p S_ip
    double gx, gy;  // out of the grain:     sum_p V_p grad S_ip
    double V;       // volume:               sum_p V_p S_ip
};

/// Velocities before and after the step.
struct alignas(32) NodeMotion {
    double vx_0, vy_0, vx_1, vy_1;
};

struct NodeForce {
    double x, y;
};

/// Particles of one grain that are worked on together: one or more rows of cells.
struct Tile {
    int grain;
    long begin, end;
};

/// A ghost node, whose values are those of its master: behind a wall (mirrored), at the other end
/// of a grain that wraps around a periodic mesh, or constrained.
struct GhostNode {
    long dof, master;
    double part_x, part_y;  // of the master's velocity, momentum and force: -1 across a wall
    bool mirror_x, mirror_y;
    double offset;  // mirror: twice the coordinate of the wall; wrap: the length of the mesh
    // The node beyond the master, for a velocity on the line through both, v = 2 v_master - v_beyond;
    // or -1.
    long beyond = -1;
    signed char along = 0;  // 1, 2: that is along x, along y
};

/// A grain's field at a node that others may touch, too; or a frictional wall that the node is on
/// or behind.
struct Member {
    long dof;     // -1: a wall
    int grain;    // or the side that the wall is on
    double x, y;  // of the node, as this grain counts columns
    bool is_wall() const { return dof < 0; }
};

/// What a sort fixes, and a checkpoint must keep: everything else follows from it.
struct GridLayout {
    std::vector<int> first_row, rows;           // per grain: its rows of nodes
    std::vector<int> first_column, end_column;  // per row
    std::vector<int> tile_begin;                // per tile: its first particle
    std::vector<int> tiles;                     // per grain: how many
    std::vector<int> wraps;                     // per grain: it reaches around a periodic mesh
    double moved = 0;  // how far a particle can have come since the sort [length]
};

class GrainNodes {
   public:
    /// in: width of the shape function in nodes; least mass of a node that takes part
    GrainNodes(const Mesh& mesh, int shape_width, double least_mass)
        : mesh_(mesh),
          least_mass_(least_mass),
          below_(shape_width == 2 ? 0 : 1),
          above_(shape_width == 2 ? 1 : 2),
          rows_apart_(shape_width == 2 ? 3 : 5) {}

    const Mesh& mesh() const { return mesh_; }
    /// Forces do not act on a node with less mass: what it gives to particles is round-off to them.
    double least_mass() const { return least_mass_; }

    std::vector<NodeSums> sums;
    std::vector<double> mass;  // the m of sums, by itself: most of a step reads nothing else
    std::vector<NodeMotion> motion;
    std::vector<NodeForce> force;
    /// What outlines put on the nodes where bodies can meet, and on ghosts of these, by side: the second
    /// one is empty where no outline has a sharp corner.
    std::array<std::vector<SideSums>, 2> surface;
    /// Where in surface a dof has its place; -1: nowhere.
    int surface_of(long dof) const { return surface_of_[dof]; }
    /// The number of the shared node that a dof is at; -1: none.
    int shared_of(long dof) const { return shared_of_[dof]; }

    /// Dof of the node in column 0 of a grain's row j; column i is that plus i.
    long origin(int grain, long j) const { return origin_[first_of_grain_[grain] + j]; }
    /// The same for consecutive rows: origins(grain)[j].
    const long* origins(int grain) const { return origin_.data() + first_of_grain_[grain]; }
    long size() const { return static_cast<long>(sums.size()); }

    const std::vector<Tile>& tiles() const { return tiles_; }
    const std::vector<GhostNode>& ghosts() const { return ghosts_; }
    /// Until particles_to_grid() is called again, a dof has the velocity of its master, or of its line.
    void constrain(long dof, long master, long beyond, signed char along = 0) {
        const double part = beyond < 0 ? 1 : 2;
        ghosts_.push_back({dof, master, part, part, false, false, 0, beyond, along});
        fixed_[dof] |= 4;
    }
    std::span<const GhostNode> constraints() const {
        return std::span(ghosts_).subspan(boundary_ghosts_);
    }
    void drop_constraints() {
        for (const GhostNode& one : constraints()) fixed_[one.dof] &= 3;
        ghosts_.resize(boundary_ghosts_);
    }
    /// Whether a dof has a velocity: particles around it, or a master.
    bool moves(long dof) const { return mass[dof] > least_mass_ || (fixed_[dof] & 4) != 0; }
    const std::vector<long>& fixed_x() const { return fixed_x_; }
    const std::vector<long>& fixed_y() const { return fixed_y_; }
    bool is_fixed_x(long dof) const { return (fixed_[dof] & 1) != 0; }
    bool is_fixed_y(long dof) const { return (fixed_[dof] & 2) != 0; }
    /// 1 for a node that forces can move, 0 for one of a rigid grain.
    const std::vector<unsigned char>& is_free() const { return free_; }
    const std::vector<Member>& members() const { return members_; }
    /// Shared node n has the members shared_begin()[n] ... shared_begin()[n + 1].
    const std::vector<long>& shared_begin() const { return shared_begin_; }
    long shared_count() const { return static_cast<long>(shared_begin_.size()) - 1; }
    /// A shared node that a wall or a rigid grain is at, and those beside it, by number; -1: none.
    struct FixedNode {
        long shared;
        int left = -1, right = -1, below = -1, above = -1;
    };
    const std::vector<FixedNode>& fixed_nodes() const { return fixed_nodes_; }
    /// Dofs of a grain are consecutive.
    long dof_begin(int grain) const { return dof_begin_[grain]; }
    long dof_end(int grain) const { return dof_begin_[static_cast<std::size_t>(grain) + 1]; }

    /// Whether particles may have left the nodes of their grain before the next step.
    bool sort_is_due(const GridLayout& layout) const { return layout.moved > sorted_within(mesh_); }
    /// How far a particle may come before it is sorted again.
    static double sorted_within(const Mesh& mesh) { return 0.99 * reach * mesh.h; }
    static constexpr double reach = 0.5;  // how far particles may move between sorts, in cells
    static constexpr long margin = 4;     // nodes beyond the mesh that a grain may touch

    /// Sorts the particles of each grain by row of cells, and lays out the nodes around them.
    void sort(const std::vector<Grain>& grains, Particles& particles, GridLayout& layout);

    /// Lays out the nodes of a layout that a checkpoint has kept.
    void lay_out(const std::vector<Grain>& grains, const GridLayout& layout);

    /// Calls work(tile, number) for every tile; those at work at the same time share no node, and
    /// sums on nodes are added in the same order whatever the number of threads.
    template <class Work>
    void for_each_tile(const Work& work) const {
        common::for_each_row_colored(2, static_cast<long>(pieces_.size()) - 1, [&](long piece) {
            const auto k = static_cast<std::size_t>(piece);
            for (long s = pieces_[k]; s < pieces_[k + 1]; ++s)
                work(tiles_[s], static_cast<std::size_t>(s));
        });
    }

   private:
    void find_ghost_nodes(const std::vector<Grain>& grains, const GridLayout& layout);
    void find_shared_nodes(const std::vector<Grain>& grains, const GridLayout& layout);
    void place_surface();

    // Visits all dofs of a grain: visit(dof, column, row).
    template <class Visit>
    void for_each_dof(int grain, const GridLayout& layout, const Visit& visit) const {
        const auto g = static_cast<std::size_t>(grain);
        const long table = row_begin_[g];
        for (long r = 0; r < layout.rows[g]; ++r) {
            const auto row = static_cast<std::size_t>(table + r);
            for (long i = layout.first_column[row]; i < layout.end_column[row]; ++i)
                visit(origin_[row] + i, i, layout.first_row[g] + r);
        }
    }
    bool has_dof(int grain, const GridLayout& layout, long i, long j) const {
        const auto g = static_cast<std::size_t>(grain);
        const long r = j - layout.first_row[g];
        if (r < 0 || r >= layout.rows[g]) return false;
        const auto row = static_cast<std::size_t>(row_begin_[g] + r);
        return i >= layout.first_column[row] && i < layout.end_column[row];
    }

    Mesh mesh_;
    double least_mass_;
    long below_, above_;  // rows and columns of nodes that the particles of a cell see around it
    long rows_apart_;
    std::vector<long> origin_, row_begin_, first_of_grain_, dof_begin_;
    std::vector<Tile> tiles_;
    std::vector<long> pieces_{0};
    std::vector<GhostNode> ghosts_;
    std::size_t boundary_ghosts_ = 0;  // those of walls and periodic ends come first
    std::vector<long> fixed_x_, fixed_y_;
    std::vector<unsigned char> fixed_;  // per dof: 1 for x, 2 for y; 4 for a ghost
    std::vector<unsigned char> free_;
    std::vector<Member> members_;
    std::vector<long> shared_begin_{0};
    std::vector<FixedNode> fixed_nodes_;
    std::vector<int> shared_of_, surface_of_;
    common::SortScratch<double> scratch_;
};

template <class Archive>
void archive(Archive& a, GridLayout& layout) {
    a("first_row", layout.first_row), a("rows", layout.rows);
    a("first_column", layout.first_column), a("end_column", layout.end_column);
    a("tile_begin", layout.tile_begin), a("tiles", layout.tiles), a("wraps", layout.wraps);
    a("moved", layout.moved);
}

}  // namespace mpm

// The members of GrainNodes that a sort calls.
#include "mpm_explicit/grid/ghost_nodes.hpp"
#include "mpm_explicit/grid/grid_layout.hpp"
#include "mpm_explicit/grid/shared_nodes.hpp"
