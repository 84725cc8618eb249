// One field per grain, on the nodes that the grain touches and nowhere else.
//
// A grain's nodes are stored row by row. A row is a stretch of columns, and the node in column i has
// the slot origin[row] + i; so a particle finds its nodes with one look at a small table, and memory
// is proportional to the area that the grains cover. Two grains that touch the same node have two
// slots there: what they do to each other is the business of contact.hpp.
//
//      o   o---o---o---o   o        a grain's rows: every row as long as it needs to be, and half
//    o---o---o---o---o---o---o      a cell wider than the grain, so that the table stays good until
//    o---o---o---o---o---o---o      a particle has moved by that
//      o   o---o---o---o   o
//
// Columns are counted on without end: a grain that straddles the ends of a periodic mesh keeps its
// particles together, at positions beyond the end. Only a grain that reaches all around (a ring) has
// its particles put back into the box, and two copies of the columns where its ends meet.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/counting_sort.hpp"
#include "common/lanes.hpp"
#include "common/mpm/grains.hpp"
#include "common/mpm/mesh.hpp"
#include "common/mpm/particles.hpp"
#include "common/parallel.hpp"

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
struct Strip {
    int grain;
    long begin, end;
};

/// A node that stands for another one: behind a wall (mirrored), or at the other end of a ring.
struct Image {
    long slot, of;
    double sign_x, sign_y;  // of velocity, momentum and force
    bool mirror_x, mirror_y;
    double about;  // mirror: twice the coordinate of the wall; ring: the length of the mesh
};

/// A grain's field at a node that others may touch, too; or a frictional wall that the node is on
/// or behind.
struct Member {
    long slot;    // -1: a wall
    int grain;    // or the side that the wall is on
    double x, y;  // of the node, as this grain counts columns
    bool is_wall() const { return slot < 0; }
};

/// What a sort fixes, and a checkpoint must keep: everything else follows from it.
struct Frame {
    std::vector<int> first_row, rows;           // per grain: its rows of nodes
    std::vector<int> first_column, end_column;  // per row
    std::vector<int> strip_begin;               // per strip: its first particle
    std::vector<int> strips;                    // per grain: how many
    std::vector<int> ring;                      // per grain: it reaches around a periodic mesh
    double moved = 0;  // how far a particle can have come since the sort [length]
    double speed = 0;  // largest in the last step
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
    /// A node with less mass stays at rest: what it would give to particles is round-off to them.
    double least_mass() const { return least_mass_; }

    std::vector<NodeSums> sums;
    std::vector<NodeMotion> motion;
    std::vector<NodeForce> force;

    /// Slot of the node in column 0 of a grain's row j; column i is that plus i.
    long origin(int grain, long j) const {
        return origin_[static_cast<std::size_t>(first_of_grain_[static_cast<std::size_t>(grain)] +
                                                j)];
    }
    /// The same for consecutive rows: origins(grain)[j].
    const long* origins(int grain) const {
        return origin_.data() + first_of_grain_[static_cast<std::size_t>(grain)];
    }
    long size() const { return static_cast<long>(sums.size()); }

    const std::vector<Strip>& strips() const { return strips_; }
    const std::vector<Image>& images() const { return images_; }
    const std::vector<long>& fixed_x() const { return fixed_x_; }
    const std::vector<long>& fixed_y() const { return fixed_y_; }
    bool is_fixed_x(long slot) const { return (fixed_[static_cast<std::size_t>(slot)] & 1) != 0; }
    bool is_fixed_y(long slot) const { return (fixed_[static_cast<std::size_t>(slot)] & 2) != 0; }
    /// 1 for a node that forces can move, 0 for one of a rigid grain.
    const std::vector<unsigned char>& is_free() const { return free_; }
    const std::vector<Member>& members() const { return members_; }
    /// Shared node n has the members shared_begin()[n] ... shared_begin()[n + 1].
    const std::vector<long>& shared_begin() const { return shared_begin_; }
    long shared_count() const { return static_cast<long>(shared_begin_.size()) - 1; }
    /// Slots of a grain are consecutive.
    long slot_begin(int grain) const { return slot_begin_[static_cast<std::size_t>(grain)]; }
    long slot_end(int grain) const { return slot_begin_[static_cast<std::size_t>(grain) + 1]; }

    /// Whether particles may have left the nodes of their grain before the next step.
    bool sort_is_due(const Frame& frame) const { return frame.moved > 0.99 * reach * mesh_.h; }

    /// Sorts the particles by grain and row of cells, and lays out the nodes around them.
    /// in/out: particles, of each grain together; grains' ranges stay as they are
    void sort(const std::vector<Grain>& grains, Particles& particles, Frame& frame);

    /// Lays out the nodes of a frame that a checkpoint has kept.
    void lay_out(const std::vector<Grain>& grains, const Frame& frame);

    /// Calls work(strip, number) for every strip; those at work at the same time share no node, and
    /// sums on nodes are added in the same order whatever the number of threads.
    template <class Work>
    void for_each_strip(const Work& work) const {
        common::for_each_row_two_apart(static_cast<long>(pieces_.size()) - 1, [&](long piece) {
            const auto k = static_cast<std::size_t>(piece);
            for (long s = pieces_[k]; s < pieces_[k + 1]; ++s)
                work(strips_[static_cast<std::size_t>(s)], static_cast<std::size_t>(s));
        });
    }

   private:
    static constexpr double reach = 0.5;  // how far particles may move between sorts, in cells

    void add_walls_and_rings(const std::vector<Grain>& grains, const Frame& frame);
    void find_shared_nodes(const std::vector<Grain>& grains, const Frame& frame);

    // Visits all slots of a grain that are not images: visit(slot, column, row).
    template <class Visit>
    void for_each_slot(int grain, const Frame& frame, const Visit& visit) const {
        const auto g = static_cast<std::size_t>(grain);
        const long table = row_begin_[g];
        for (long r = 0; r < frame.rows[g]; ++r) {
            const auto row = static_cast<std::size_t>(table + r);
            for (long i = frame.first_column[row]; i < frame.end_column[row]; ++i)
                visit(origin_[row] + i, i, frame.first_row[g] + r);
        }
    }
    bool has_slot(int grain, const Frame& frame, long i, long j) const {
        const auto g = static_cast<std::size_t>(grain);
        const long r = j - frame.first_row[g];
        if (r < 0 || r >= frame.rows[g]) return false;
        const auto row = static_cast<std::size_t>(row_begin_[g] + r);
        return i >= frame.first_column[row] && i < frame.end_column[row];
    }

    Mesh mesh_;
    double least_mass_;
    long below_, above_;  // rows and columns of nodes that the particles of a cell see around it
    long rows_apart_;
    std::vector<long> origin_, row_begin_, first_of_grain_, slot_begin_;
    std::vector<Strip> strips_;
    std::vector<long> pieces_{0};
    std::vector<Image> images_;
    std::vector<long> fixed_x_, fixed_y_;
    std::vector<unsigned char> fixed_;  // per slot: 1 for x, 2 for y
    std::vector<unsigned char> free_;
    std::vector<Member> members_;
    std::vector<long> shared_begin_{0};
    common::SortScratch<double> scratch_;
};

template <class Archive>
void archive(Archive& a, Frame& frame) {
    a("first_row", frame.first_row), a("rows", frame.rows);
    a("first_column", frame.first_column), a("end_column", frame.end_column);
    a("strip_begin", frame.strip_begin), a("strips", frame.strips), a("ring", frame.ring);
    a("moved", frame.moved), a("speed", frame.speed);
}

namespace detail {

inline long cell_of(double x, double low, double h) {
    return static_cast<long>(std::floor((x - low) / h));
}

// A grain beyond the end of a periodic mesh comes back as a whole; one that reaches around it is
// cut where the mesh ends.
inline void put_back(const Mesh& mesh, const Grain& grain, int& ring, Particles& particles) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (long p = grain.begin; p < grain.end; ++p) {
        const double x = particles.x_p[static_cast<std::size_t>(p)];
        low = std::min(low, x), high = std::max(high, x);
    }
    const double length = mesh.length_x();
    ring = ring != 0 || high - low > length - 4 * mesh.h;
    const double center = 0.5 * (low + high) - mesh.x_low;
    const double shift = ring != 0 ? 0 : -length * std::floor(center / length);
    for (long p = grain.begin; p < grain.end; ++p) {
        double& x = particles.x_p[static_cast<std::size_t>(p)];
        if (ring != 0) {
            const double turns = std::floor((x - mesh.x_low) / length);
            if (turns != 0) x -= turns * length;
        } else if (shift != 0) {
            x += shift;
        }
    }
}

}  // namespace detail

inline void GrainNodes::sort(const std::vector<Grain>& grains, Particles& particles, Frame& frame) {
    frame.ring.resize(grains.size());
    if (mesh_.periodic_x)
        for (std::size_t g = 0; g < grains.size(); ++g)
            detail::put_back(mesh_, grains[g], frame.ring[g], particles);

    // Every grain has one strip per row of cells from its lowest to its highest.
    const std::size_t count = grains.size();
    std::vector<long> low(count), first_strip(count + 1, 0);
    frame.strips.resize(count);
    for (std::size_t g = 0; g < count; ++g) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (long p = grains[g].begin; p < grains[g].end; ++p) {
            const double y = particles.y_p[static_cast<std::size_t>(p)];
            least = std::min(least, y), most = std::max(most, y);
        }
        low[g] = detail::cell_of(least, mesh_.y_low, mesh_.h);
        const long rows = detail::cell_of(most, mesh_.y_low, mesh_.h) - low[g] + 1;
        frame.strips[g] = static_cast<int>(rows);
        first_strip[g + 1] = first_strip[g] + rows;
    }
    std::vector<int> owner(static_cast<std::size_t>(particles.count()));
    for (std::size_t g = 0; g < count; ++g)
        std::fill(owner.begin() + grains[g].begin, owner.begin() + grains[g].end,
                  static_cast<int>(g));
    const auto strip_of = [&](long p) {
        const auto n = static_cast<std::size_t>(p);
        const auto g = static_cast<std::size_t>(owner[n]);
        const long row = detail::cell_of(particles.y_p[n], mesh_.y_low, mesh_.h) - low[g];
        return static_cast<int>(first_strip[g] + row);
    };
    common::counting_sort(particles.count(), first_strip[count], strip_of, scratch_,
                          &frame.strip_begin);
    for (std::vector<double>* quantity : particles.all())
        common::carry_to_place(*quantity, scratch_);

    // Rows of nodes around the strips, wide enough for particles that move by the reach.
    frame.first_row.resize(count), frame.rows.resize(count);
    frame.first_column.clear(), frame.end_column.clear();
    const double spare = reach * mesh_.h;
    for (std::size_t g = 0; g < count; ++g) {
        struct Reach {
            long first_row, end_row, first_column, end_column;
        };
        std::vector<Reach> reaches;
        long first_row = std::numeric_limits<long>::max(),
             end_row = std::numeric_limits<long>::min();
        for (int s = 0; s < frame.strips[g]; ++s) {
            const auto k = static_cast<std::size_t>(first_strip[g] + s);
            const int begin = frame.strip_begin[k], end = frame.strip_begin[k + 1];
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
        const std::size_t table = frame.first_column.size();
        frame.first_row[g] = static_cast<int>(first_row);
        frame.rows[g] = static_cast<int>(end_row - first_row);
        frame.first_column.resize(table + static_cast<std::size_t>(end_row - first_row), 0);
        frame.end_column.resize(frame.first_column.size(), 0);
        for (const Reach& r : reaches) {
            for (long j = r.first_row; j < r.end_row; ++j) {
                const auto row = table + static_cast<std::size_t>(j - first_row);
                int &first = frame.first_column[row], &end = frame.end_column[row];
                const bool empty = first == end;
                first = empty ? static_cast<int>(r.first_column)
                              : std::min(first, static_cast<int>(r.first_column));
                end = empty ? static_cast<int>(r.end_column)
                            : std::max(end, static_cast<int>(r.end_column));
            }
        }
    }
    frame.moved = 0;
    lay_out(grains, frame);
}

inline void GrainNodes::lay_out(const std::vector<Grain>& grains, const Frame& frame) {
    const std::size_t count = grains.size();
    origin_.clear(), strips_.clear();
    row_begin_.assign(count + 1, 0), first_of_grain_.assign(count, 0);
    slot_begin_.assign(count + 1, 0);
    long slots = 0, row = 0;
    for (std::size_t g = 0; g < count; ++g) {
        row_begin_[g] = row, first_of_grain_[g] = row - frame.first_row[g], slot_begin_[g] = slots;
        for (int r = 0; r < frame.rows[g]; ++r, ++row) {
            const auto k = static_cast<std::size_t>(row);
            origin_.push_back(slots - frame.first_column[k]);
            slots += frame.end_column[k] - frame.first_column[k];
        }
    }
    row_begin_[count] = row, slot_begin_[count] = slots;
    const auto size = static_cast<std::size_t>(slots);
    sums.resize(size), motion.resize(size), force.resize(size);

    // Pieces of work: so many rows that the next but one shares no node.
    constexpr long particles_per_piece = 1024;
    pieces_.assign(1, 0);
    long rows_in_piece = 0, particles_in_piece = 0;
    std::size_t cells = 0;  // rows of cells so far
    for (std::size_t g = 0; g < count; ++g) {
        for (int r = 0; r < frame.strips[g]; ++r, ++cells) {
            const long begin = frame.strip_begin[cells], end = frame.strip_begin[cells + 1];
            const bool new_piece = pieces_.back() == static_cast<long>(strips_.size());
            if (new_piece || strips_.back().grain != static_cast<int>(g))
                strips_.push_back({static_cast<int>(g), begin, begin});
            strips_.back().end = end;
            particles_in_piece += end - begin, ++rows_in_piece;
            if (particles_in_piece < particles_per_piece || rows_in_piece < rows_apart_) continue;
            pieces_.push_back(static_cast<long>(strips_.size()));
            particles_in_piece = rows_in_piece = 0;
        }
    }
    if (pieces_.back() < static_cast<long>(strips_.size()))
        pieces_.push_back(static_cast<long>(strips_.size()));
    add_walls_and_rings(grains, frame);
    find_shared_nodes(grains, frame);
}

inline void GrainNodes::add_walls_and_rings(const std::vector<Grain>& grains, const Frame& frame) {
    images_.clear(), fixed_x_.clear(), fixed_y_.clear();
    const long nx = mesh_.cells_x, ny = mesh_.cells_y;
    std::vector<Image> along_y;
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const int g = static_cast<int>(k);
        for_each_slot(g, frame, [&](long slot, long i, long j) {
            if (frame.ring[k] != 0 && has_slot(g, frame, i - nx, j))
                images_.push_back({slot, slot - nx, 1, 1, false, false, mesh_.length_x()});
            if (grains[k].rigid) return;
            const auto meet = [&](Side side, long beyond, long mirror, bool is_x) {
                const Boundary kind = mesh_.boundary[static_cast<std::size_t>(side)];
                if (beyond < 0 || kind == Boundary::open || kind == Boundary::frictional) return;
                if (beyond == 0) {
                    if (is_x || kind == Boundary::stick) fixed_x_.push_back(slot);
                    if (!is_x || kind == Boundary::stick) fixed_y_.push_back(slot);
                    return;
                }
                const long i_of = is_x ? mirror : i, j_of = is_x ? j : mirror;
                if (beyond > 1 || !has_slot(g, frame, i_of, j_of)) return;
                const double tangential = kind == Boundary::stick ? -1 : 1;
                const double wall = side == x_low    ? mesh_.x_low
                                    : side == x_high ? mesh_.x_high()
                                    : side == y_low  ? mesh_.y_low
                                                     : mesh_.y_high();
                (is_x ? images_ : along_y)
                    .push_back({slot, origin(g, j_of) + i_of, is_x ? -1 : tangential,
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
    images_.insert(images_.end(), along_y.begin(), along_y.end());
    free_.assign(sums.size(), 1);
    for (std::size_t g = 0; g < grains.size(); ++g)
        if (grains[g].rigid)
            std::fill(free_.begin() + slot_begin_[g], free_.begin() + slot_begin_[g + 1],
                      static_cast<unsigned char>(0));
    fixed_.assign(sums.size(), 0);
    for (const long slot : fixed_x_) fixed_[static_cast<std::size_t>(slot)] |= 1;
    for (const long slot : fixed_y_) fixed_[static_cast<std::size_t>(slot)] |= 2;
}

inline void GrainNodes::find_shared_nodes(const std::vector<Grain>& grains, const Frame& frame) {
    members_.clear(), shared_begin_.assign(1, 0);
    // How many have a slot at each node, and where their list begins.
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
    // Grains first, in their order, then walls; copies of ring columns and mirrored nodes not.
    const auto for_each_member = [&](const auto& visit) {
        for (std::size_t k = 0; k < grains.size(); ++k) {
            const int g = static_cast<int>(k);
            for_each_slot(g, frame, [&](long slot, long i, long j) {
                const bool copy = frame.ring[k] != 0 && has_slot(g, frame, i - nx, j);
                const bool behind_x =
                    !mesh_.periodic_x && ((i < 0 && !stands(x_low)) || (i > nx && !stands(x_high)));
                const bool behind_y = (j < 0 && !stands(y_low)) || (j > ny && !stands(y_high));
                const long node = node_of(i, j);
                if (copy || behind_x || behind_y || node < 0) return;
                visit(static_cast<std::size_t>(node),
                      Member{slot, g, mesh_.x_of(static_cast<double>(i)),
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
