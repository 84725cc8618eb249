// E, B and J on the staggered mesh, and the differences between them. common/grid.hpp draws the mesh;
// of the cell between node (i, j) and node (i+1, j+1) are stored at index(i, j):
//
//     z  ^   E_z,J_z,B_x ---- B_y             node    E_y, J_y, rho
//        |      |              |              x-edge  E_x, J_x, B_z
//        |   E_y,J_y,rho -- E_x,J_x,B_z       z-edge  E_z, J_z, B_x
//        +-----------------------> x          face    B_y
//
// Forward differences lead from nodes to midpoints and backward ones from midpoints to nodes; so curl
// takes E to the places of B and back, and div curl = 0, curl grad = 0 hold to round-off. No
// operator averages, so none has a checkerboard null space.
#pragma once

#include <algorithm>
#include <array>

#include "common/grid.hpp"
#include "common/parallel.hpp"

namespace implicit_moment {

using common::Field;
using common::Grid;
using common::Parity;
using common::Place;

/// Three components in one column vector, each grid.size() long: the form that GMRES works on.
struct VectorField {
    Eigen::VectorXd all;

    explicit VectorField(const Grid& grid) : all(Eigen::VectorXd::Zero(3 * grid.size())) {}
    long size() const { return all.size() / 3; }
    double* x() { return all.data(); }
    double* y() { return all.data() + size(); }
    double* z() { return all.data() + 2 * size(); }
    const double* x() const { return all.data(); }
    const double* y() const { return all.data() + size(); }
    const double* z() const { return all.data() + 2 * size(); }
};

/// The electromagnetic field of a run: E and B at t^n, ghosts filled, and E^{n+theta} of the last
/// step, where the solver starts; explicit_em does not use that one.
struct FieldState {
    VectorField E, B, E_theta;
    double by_theta = 0;    // energy that the time level theta has taken so far, see advance_field
    double iterations = 0;  // of the field solve of the last step
    explicit FieldState(const Grid& grid) : E(grid), B(grid), E_theta(grid) {}
};

/// Places and wall parities of a vector's three components.
struct VectorKind {
    std::array<Place, 3> place;
    std::array<Parity, 3> parity;
};
/// E at an ideal conductor: tangential parts odd (zero on the wall), normal part even.
inline constexpr VectorKind electric{{common::on_x_edges, common::on_nodes, common::on_z_edges},
                                     {{{+1, -1}, {-1, -1}, {-1, +1}}}};
/// B at an ideal conductor: normal part odd, tangential parts even.
inline constexpr VectorKind magnetic{{common::on_z_edges, common::on_faces, common::on_x_edges},
                                     {{{-1, +1}, {+1, +1}, {+1, -1}}}};
/// J of particles that are reflected: normal part odd, tangential parts even.
inline constexpr VectorKind current{{common::on_x_edges, common::on_nodes, common::on_z_edges},
                                    {{{-1, +1}, {+1, +1}, {+1, -1}}}};

/// J and the E that particles feel. Behind a conducting wall stand image charges, and both have the
/// parities of E: what touches the wall makes no field. Behind a wall that mirrors the plasma both have those of
/// the J of reflected particles: the current of a plasma goes on up to the wall.
/// exact:  with the same parities in the gather as in the deposit, one is the transpose of the other.
inline VectorKind felt(const Grid& grid) {
    VectorKind kind = electric;
    for (std::size_t a = 0; a < 3; ++a) {
        if (grid.x.mirrors) kind.parity[a].x = current.parity[a].x;
        if (grid.z.mirrors) kind.parity[a].z = current.parity[a].z;
    }
    return kind;
}
/// The parities of the charge that makes fields, which are those of J_y.
inline Parity felt_charge(const Grid& grid) { return felt(grid).parity[1]; }
inline bool mirrors_plasma(const Grid& grid) { return grid.x.mirrors || grid.z.mirrors; }

/// Fills the ghosts of all three components. in: kind, of the vector
inline void fill_ghosts(const Grid& grid, const VectorKind& kind, double* all) {
    for (std::size_t a = 0; a < 3; ++a)
        common::fill_ghosts(grid, kind.place[a], kind.parity[a], all + a * grid.size());
}
inline void fill_ghosts(const Grid& grid, const VectorKind& kind, VectorField& f) {
    fill_ghosts(grid, kind, f.all.data());
}

/// Adds what was deposited on the ghosts of all three components to the points that they stand for.
inline void fold_ghosts(const Grid& grid, const VectorKind& kind, double* all) {
    for (std::size_t a = 0; a < 3; ++a)
        common::fold_ghosts(grid, kind.place[a], kind.parity[a], all + long(a) * grid.size());
}

/// Fills the ghosts of B itself. What crosses a conducting wall is frozen into it: B_n keeps its values
/// there, and behind the wall it goes on odd about them, so that div B = 0 holds there as well.
inline void fill_B_ghosts(const Grid& grid, VectorField& B) {
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    for (std::size_t a = 0; a < 3; ++a) {
        double* f = B.all.data() + long(a) * B.size();
        const Place place = magnetic.place[a];
        const Parity parity = magnetic.parity[a];
        for (long j = 0; j <= nz; ++j) {
            double* row = f + grid.index(0, j);
            common::ghosts_along(grid.x, place.half_x, parity.x, [&](long to, long from, int sign) {
                row[to] = sign * row[from] + (sign < 0 ? 2 * row[to < 0 ? 0 : nx] : 0);
            });
        }
        common::ghosts_along(grid.z, place.half_z, parity.z, [&](long to, long from, int sign) {
            double* target = f + grid.index(-1, to);
            const double *source = f + grid.index(-1, from),
                         *wall = f + grid.index(-1, to < 0 ? 0 : nz);
            for (long i = 0; i < stride; ++i)
                target[i] = sign * source[i] + (sign < 0 ? 2 * wall[i] : 0);
        });
    }
}

/// The unknowns of one component as a matrix (x, z), without ghosts.
using Block = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstBlock = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
inline Block interior(const Grid& grid, double* f) {
    return {f + grid.index(0, 0), grid.x.cells, grid.z.cells, Eigen::OuterStride<>(grid.stride())};
}
inline ConstBlock interior(const Grid& grid, const double* f) {
    return {f + grid.index(0, 0), grid.x.cells, grid.z.cells, Eigen::OuterStride<>(grid.stride())};
}

/// Calls work(n) for the storage index n of rows and columns 0..N, of all points whose neighbors
/// are stored; work(n) writes to point n alone.
template <class Work>
inline void for_each_point(const Grid& grid, const Work& work) {
    constexpr long at_once = 2;
    const long rows = grid.z.cells + 1;
    common::for_each_piece(
        (rows + at_once - 1) / at_once,
        [&](long piece) {
            for (long j = piece * at_once; j < std::min(rows, (piece + 1) * at_once); ++j) {
                const long begin = grid.index(0, j), end = begin + grid.x.cells + 1;
#pragma omp simd
                for (long n = begin; n < end; ++n) work(n);
            }
        },
        grid.size());
}

/// curl E on the places of B:  x: -dE_y/dz   y: dE_x/dz - dE_z/dx   z: dE_y/dx
/// in:     E, ghosts filled.
/// out:    values on rows and columns 0..N.
inline void curl_of_electric(const Grid& grid, const double* E, double* curl) {
    const long s = grid.stride(), m = grid.size();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double *E_x = E, *E_y = E + m, *E_z = E + 2 * m;
    double *x = curl, *y = curl + m, *z = curl + 2 * m;
    for_each_point(grid, [=](long n) {
        x[n] = -(E_y[n + s] - E_y[n]) * per_dz;
        y[n] = (E_x[n + s] - E_x[n]) * per_dz - (E_z[n + 1] - E_z[n]) * per_dx;
        z[n] = (E_y[n + 1] - E_y[n]) * per_dx;
    });
}

/// curl B on the places of E:  x: -dB_y/dz   y: dB_x/dz - dB_z/dx   z: dB_y/dx
/// in:     B, ghosts filled.
/// out:    values on rows and columns 0..N.
inline void curl_of_magnetic(const Grid& grid, const double* B, double* curl) {
    const long s = grid.stride(), m = grid.size();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double *B_x = B, *B_y = B + m, *B_z = B + 2 * m;
    double *x = curl, *y = curl + m, *z = curl + 2 * m;
    for_each_point(grid, [=](long n) {
        x[n] = -(B_y[n] - B_y[n - s]) * per_dz;
        y[n] = (B_x[n] - B_x[n - s]) * per_dz - (B_z[n] - B_z[n - 1]) * per_dx;
        z[n] = (B_y[n] - B_y[n - 1]) * per_dx;
    });
}

/// div of a vector on the places of E, on nodes. in: ghosts filled.
inline void divergence_of_electric(const Grid& grid, const double* E, Field& div) {
    const long s = grid.stride(), m = grid.size();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double *E_x = E, *E_z = E + 2 * m;
    double* out = div.data();
    for_each_point(grid, [=](long n) {
        out[n] = (E_x[n] - E_x[n - 1]) * per_dx + (E_z[n] - E_z[n - s]) * per_dz;
    });
}

/// div B on faces: B_x lives on z-edges and B_z on x-edges.
/// in:     ghosts filled.
inline void divergence_of_magnetic(const Grid& grid, const double* B, Field& div) {
    const long s = grid.stride(), m = grid.size();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double *B_x = B, *B_z = B + 2 * m;
    double* out = div.data();
    for_each_point(grid, [=](long n) {
        out[n] = (B_x[n + 1] - B_x[n]) * per_dx + (B_z[n + s] - B_z[n]) * per_dz;
    });
}

/// Sets to zero everything that is not an unknown of the field equations: ghosts, images, and
/// tangential E on walls.
inline void keep_unknowns(const Grid& grid, double* E) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    for (std::size_t a = 0; a < 3; ++a) {
        double* f = E + a * grid.size();
        const bool wall_x = !grid.x.periodic && !electric.place[a].half_x;
        const bool wall_z = !grid.z.periodic && !electric.place[a].half_z;
        for (long j = -1; j <= nz + 1; ++j) {
            double* row = f + grid.index(0, j);
            if (j < 0 || j >= nz || (wall_z && j == 0)) {
                std::fill_n(row - 1, grid.stride(), 0.0);
            } else {
                row[-1] = row[nx] = row[nx + 1] = 0;
                if (wall_x) row[0] = 0;
            }
        }
    }
}

}  // namespace implicit_moment
