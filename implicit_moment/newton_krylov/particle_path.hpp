// The straight path of one particle through a step, piece by piece: across the lines where splines change
// their polynomials, through periodic ends, reflected by walls.
#pragma once

#include <cmath>

#include "implicit_moment/kick_and_drift.hpp"
#include "implicit_moment/move_one.hpp"

namespace implicit_moment {

namespace detail {

// One coordinate of a path in cells from the first node; behind walls and periodic ends it goes on
// straight. A piece of it lies between two of the lines where splines change their polynomials.
struct PathAxis {
    long cells;
    bool periodic;
    double start, way;  // from start to start + way
    double low, high;   // of the present piece

    PathAxis(const common::Axis& axis, double x, double displacement)
        : cells(axis.cells),
          periodic(axis.periodic),
          start((x - axis.low) / axis.spacing()),
          way(displacement / axis.spacing()) {
        low = std::floor(start + 0.5) - 0.5, high = low + 1;
        const double node = low + 0.5;
        if (is_wall(node)) (start < node || (start == node && way < 0) ? high : low) = node;
    }
    bool is_wall(double node) const { return !periodic && std::fmod(node, double(cells)) == 0; }
    // The part of the path after which the piece ends.
    double end_of_piece() const {
        if (way == 0) return 2;
        return ((way > 0 ? high : low) - start) / way;
    }
    void next_piece() {
        double& front = way > 0 ? high : low;
        (way > 0 ? low : high) = front;
        const double side = way > 0 ? 0.5 : -0.5, node = front + side;
        front = is_wall(front) || is_wall(node) ? node : front + 2 * side;
    }
    // The place on the mesh of a point of the path: node, distance from it, and -1 where the path has
    // been reflected an odd number of times.
    void place(double part, long& node, double& d, double& mirror) const {
        const double middle = 0.5 * (low + high), turns = std::floor(middle / double(cells));
        double x = start + part * way - turns * double(cells), m = middle - turns * double(cells);
        mirror = 1;
        if (!periodic && std::fmod(turns, 2) != 0) {
            x = double(cells) - x, m = double(cells) - m;
            mirror = -1;
        }
        node = long(m + 0.5);
        d = x - double(node);
    }
    bool is_near_wall(double reach) const {
        reach = std::fmax(reach, std::fabs(way));
        return !periodic && (start - reach <= 0 || start + reach >= double(cells));
    }
    bool meets_wall() const {
        return !periodic && (start + way < 0 || start + way > double(cells));
    }
    // Where the path ends.
    double end(const common::Axis& axis, double& v) const {
        double x = axis.low + (start + way) * axis.spacing();
        land(axis, x, v);
        return x;
    }
};

// Calls visit(weight, corner, d_x, d_z, mirror_x, mirror_z) at the points of Gauss of every piece.
template <class Visit>
inline void along_path(const Grid& grid, PathAxis x, PathAxis z, const Visit& visit) {
    const double gauss = 0.5 / std::sqrt(3.0);
    for (double begin = 0; begin < 1;) {
        const double end_x = x.end_of_piece(), end_z = z.end_of_piece(),
                     end = std::fmin(1.0, std::fmax(begin, std::fmin(end_x, end_z)));
        if (end > begin) {
            for (const double side : {-gauss, gauss}) {
                const double part = 0.5 * (begin + end) + side * (end - begin);
                long i, j;
                double d_x, d_z, m_x, m_z;
                x.place(part, i, d_x, m_x);
                z.place(part, j, d_z, m_z);
                visit(0.5 * (end - begin), grid.index(i - 1, j - 1), d_x, d_z, m_x, m_z);
            }
        }
        if (end >= 1) break;
        if (end_x <= end) x.next_piece();
        if (end_z <= end) z.next_piece();
        begin = end;
    }
}

// The mean field along a path, in the frame in which the path is straight.
inline LocalField<double> field_along(const Grid& grid, const InterleavedField& field,
                                      const PathAxis& x, const PathAxis& z) {
    LocalField<double> mean{};
    along_path(grid, x, z,
               [&](double w, long corner, double d_x, double d_z, double m_x, double m_z) {
                   const auto at = gather_field(&field[corner], grid.stride(), d_x, d_z);
                   mean.E_x += w * m_x * at.E_x;
                   mean.E_y += w * at.E_y;
                   mean.E_z += w * m_z * at.E_z;
                   // B turns around in a mirror where E stays.
                   mean.B_x += w * m_z * at.B_x;
                   mean.B_y += w * m_x * m_z * at.B_y;
                   mean.B_z += w * m_x * at.B_z;
               });
    return mean;
}

// How far a path is found: settled, it stays as it is; sliding, it keeps its distance from a wall.
struct PathState {
    bool settled = false, slides_x = false, slides_z = false;
};

inline constexpr double longest_path = 1e4;  // cells along either direction

// Finds the path of one particle in a field, by iteration; false where there is none.
// in:     x, z and u at t^n; may_change, false where a path that meets a wall is to stay as it is
// in/out: vbar; state
// note:   reflected paths may jump between two ways to go, and a particle that the field presses against a
//         wall would bounce for ever: corrections become smaller, and at last it slides.
template <class Dynamics>
inline bool find_path(Dynamics, const Grid& grid, const InterleavedField& field, double dt,
                      const MoverSettings& settings, double half_kick, double x, double z,
                      const Velocity<double>& u, bool may_change, Velocity<double>& vbar,
                      PathState& state) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    double change = 2 * settings.tolerance;
    for (long i = 0; change > settings.tolerance && !state.settled; ++i) {
        if (state.slides_x) vbar.x = 0;
        if (state.slides_z) vbar.z = 0;
        const PathAxis path_x(grid.x, x, dt * vbar.x), path_z(grid.z, z, dt * vbar.z);
        if (!(std::fabs(path_x.way) <= longest_path && std::fabs(path_z.way) <= longest_path))
            return false;
        if (!may_change && (path_x.meets_wall() || path_z.meets_wall())) {
            state.settled = true;
            break;
        }
        const Velocity<double> next =
            Dynamics::mean(u, field_along(grid, field, path_x, path_z), half_kick).vbar;
        if (i == 2 * settings.max_iterations) {
            state.slides_x = path_x.is_near_wall(std::fabs(dt * next.x * per_dx));
            state.slides_z = path_z.is_near_wall(std::fabs(dt * next.z * per_dz));
        }
        if (i == 4 * settings.max_iterations) state.settled = true;
        const double step_x = state.slides_x ? 0 : next.x - vbar.x, step_y = next.y - vbar.y,
                     step_z = state.slides_z ? 0 : next.z - vbar.z;
        change = dt * std::fmax(std::fabs(step_x) * per_dx, std::fabs(step_z) * per_dz);
        const double part = i < 3 ? 1 : 3 / double(i + 1);
        vbar = {vbar.x + part * step_x, vbar.y + part * step_y, vbar.z + part * step_z};
    }
    if (state.slides_x) vbar.x = 0;
    if (state.slides_z) vbar.z = 0;
    return std::isfinite(vbar.x + vbar.y + vbar.z);
}

}  // namespace detail

}  // namespace implicit_moment
