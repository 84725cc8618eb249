// Poisson's equation on the nodes, -lap phi = rho: by Fourier transforms where the mesh is
// periodic, by a tridiagonal solve from wall to wall, and by a sparse factorization in a box with
// walls on all sides.
//
// With delta_xx f = (f_{i+1} - 2 f_i + f_{i-1}) / dx^2,
//     five-point  lap = delta_xx + delta_zz
//     nine-point  lap = delta_xx + delta_zz + (1/12) (dx^2 + dz^2) delta_xx delta_zz
// The second one also uses the four corners, as Birdsall and Fuss did; with square cells its error
// of second order is the same in all directions.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

#include "cic/real_transform.hpp"

namespace cic {

/// One end of a direction that is not periodic: held at a potential, or an insulated conductor
/// that carries the charge it has collected.
struct Wall {
    bool floating = false;
    double potential = 0;  // in: of a grounded wall; out: of a floating one
    double charge = 0;     // per area. in: of a floating wall; out: of a grounded one
};
/// Which wall: an index of Walls, and its name in a case.
enum WallName : std::size_t { x_low, x_high, z_low, z_high };
inline constexpr std::array<const char*, 4> wall_names{"x_low", "x_high", "z_low", "z_high"};
using Walls = std::array<Wall, 4>;

/// -c phi'' + K2 phi = rho on the nodes 0..N from wall to wall, by elimination.
/// in:     c, factor of delta_xx; K2 >= 0; rho[0..N], on the walls per volume of the half cell;
///         low, high: the walls
/// out:    phi[0..N] in place of rho
/// exact:  to round-off. With two floating walls and K2 = 0 nothing fixes the mean: phi is zero on
///         the low wall, whose charge is taken to be what makes all neutral.
/// source: Thomas's algorithm.
inline void solve_tridiagonal(double dx, double c, double K2, const Wall& low, const Wall& high,
                              double* rho, long N, std::vector<double>& scratch) {
    const double off = -c / (dx * dx), diagonal = 2 * c / (dx * dx) + K2;
    std::vector<double>& ratio = scratch;
    ratio.resize(N + 1);
    const bool pinned = low.floating && high.floating && K2 == 0;
    // First row: a potential, or Gauss's law for the half cell, E_1/2 = sigma + rho_0 dx/2.
    if (low.floating && !pinned) {
        const double d = c / dx + 0.5 * dx * K2;
        rho[0] = (low.charge + 0.5 * dx * rho[0]) / d;
        ratio[0] = -(c / dx) / d;
    } else {
        rho[0] = pinned ? 0 : low.potential;
        ratio[0] = 0;
    }
    for (long i = 1; i < N; ++i) {
        const double pivot = 1 / (diagonal - off * ratio[i - 1]);
        ratio[i] = off * pivot;
        rho[i] = (rho[i] - off * rho[i - 1]) * pivot;
    }
    const double before = ratio[N - 1];
    if (high.floating) {
        const double d = c / dx * (1 + before) + 0.5 * dx * K2;
        rho[N] = (high.charge + 0.5 * dx * rho[N] + c / dx * rho[N - 1]) / d;
    } else {
        rho[N] = high.potential;
    }
    for (long i = N - 1; i >= 0; --i) rho[i] -= ratio[i] * rho[i + 1];
}

/// Solves -lap phi = rho on one mesh again and again.
class PoissonSolver {
   public:
    /// in:     nine_point, the Laplacian with the corners; a box with four walls is factorized here
    PoissonSolver(const Grid& grid, bool nine_point)
        : grid_(grid),
          coupling_(
              nine_point
                  ? (grid.x.spacing() * grid.x.spacing() + grid.z.spacing() * grid.z.spacing()) / 12
                  : 0),
          along_x_(grid.x.cells),
          along_z_(grid.z.cells) {
        if (!grid.x.periodic && !grid.z.periodic) factorize();
    }

    /// Solves for one charge density.
    /// in:     rho on the nodes, on walls per volume of the half cell; walls
    /// out:    phi on the nodes, interior only
    /// exact:  the difference equation holds to round-off. Without walls the mean of rho is taken
    ///         out, and phi has no mean.
    void solve(const Field& rho, const Walls& walls, Field& phi) {
        phi.resize(grid_.size());
        if (grid_.x.periodic && grid_.z.periodic)
            solve_periodic(rho, phi);
        else if (grid_.x.periodic || grid_.z.periodic)
            solve_between_walls(grid_.z.periodic, rho, walls, phi);
        else
            solve_in_box(rho, walls, phi);
    }

   private:
    double symbol(double Kx2, double Kz2) const { return Kx2 + Kz2 - coupling_ * Kx2 * Kz2; }

    void solve_periodic(const Field& rho, Field& phi) {
        const long nx = grid_.x.cells, nz = grid_.z.cells;
        rows_.resize(nx, nz);
        for (long j = 0; j < nz; ++j) rows_.col(j) = rho.segment(grid_.index(0, j), nx);
        along_x_.forward(rows_);
        transpose(rows_, columns_);
        along_z_.forward(columns_);
        common::for_each_row(nx, [&](long m) {
            const double Kx2 = RealTransform::minus_delta(grid_.x, m);
            for (long l = 0; l < nz; ++l) {
                const double K2 = symbol(Kx2, RealTransform::minus_delta(grid_.z, l));
                columns_(l, m) = m + l > 0 ? columns_(l, m) / K2 : 0;
            }
        });
        along_z_.backward(columns_);
        transpose(columns_, rows_);
        along_x_.backward(rows_);
        for (long j = 0; j < nz; ++j) phi.segment(grid_.index(0, j), nx) = rows_.col(j);
    }

    // Fourier transforms along the walls, and a tridiagonal solve for each mode across.
    void solve_between_walls(bool walls_in_x, const Field& rho, const Walls& walls, Field& phi) {
        const common::Axis &across = walls_in_x ? grid_.x : grid_.z,
                           &along = walls_in_x ? grid_.z : grid_.x;
        const RealTransform& transform = walls_in_x ? along_z_ : along_x_;
        const auto node = [&](long a, long c) {
            return walls_in_x ? grid_.index(c, a) : grid_.index(a, c);
        };
        rows_.resize(along.cells, across.cells + 1);
        for (long c = 0; c <= across.cells; ++c)
            for (long a = 0; a < along.cells; ++a) rows_(a, c) = rho[node(a, c)];
        transform.forward(rows_);
        transpose(rows_, columns_);
        solve_modes(across, along, walls[walls_in_x ? x_low : z_low],
                    walls[walls_in_x ? x_high : z_high], columns_);
        transpose(columns_, rows_);
        transform.backward(rows_);
        for (long c = 0; c <= across.cells; ++c)
            for (long a = 0; a < along.cells; ++a) phi[node(a, c)] = rows_(a, c);
    }

    // One tridiagonal system per column, a mode of the periodic direction; only mode 0 sees the
    // potential or the charge of the walls.
    void solve_modes(const common::Axis& from_wall_to_wall, const common::Axis& periodic, Wall low,
                     Wall high, Eigen::MatrixXd& modes) {
        const double count = double(periodic.cells);
        low.potential *= count, low.charge *= count;
        high.potential *= count, high.charge *= count;
        common::for_each_block(modes.cols(), [&](int, long begin, long end) {
            std::vector<double> scratch;
            for (long m = begin; m < end; ++m) {
                const double K2 = RealTransform::minus_delta(periodic, m);
                solve_tridiagonal(from_wall_to_wall.spacing(), 1 - coupling_ * K2, K2,
                                  m == 0 ? low : Wall{}, m == 0 ? high : Wall{},
                                  modes.col(m).data(), from_wall_to_wall.cells, scratch);
            }
        });
    }

    // Number of an unknown in a box: nodes inside.
    long unknown(long i, long j) const { return (j - 1) * (grid_.x.cells - 1) + i - 1; }
    bool inside(long i, long j) const {
        return i > 0 && i < grid_.x.cells && j > 0 && j < grid_.z.cells;
    }
    // Visits the eight neighbors with the factors of -lap, and the node itself.
    template <class Visit>
    void visit_stencil(long i, long j, const Visit& visit) const {
        const double per_dx2 = 1 / (grid_.x.spacing() * grid_.x.spacing()),
                     per_dz2 = 1 / (grid_.z.spacing() * grid_.z.spacing()),
                     corner = coupling_ * per_dx2 * per_dz2;
        visit(i, j, 2 * per_dx2 + 2 * per_dz2 - 4 * corner);
        for (const long s : {-1L, 1L}) {
            visit(i + s, j, -per_dx2 + 2 * corner);
            visit(i, j + s, -per_dz2 + 2 * corner);
            for (const long t : {-1L, 1L}) visit(i + s, j + t, -corner);
        }
    }

    void factorize() {
        const long unknowns = (grid_.x.cells - 1) * (grid_.z.cells - 1);
        std::vector<Eigen::Triplet<double>> entries;
        for (long j = 1; j < grid_.z.cells; ++j)
            for (long i = 1; i < grid_.x.cells; ++i)
                visit_stencil(i, j, [&](long k, long l, double factor) {
                    if (inside(k, l) && factor != 0)
                        entries.emplace_back(int(unknown(i, j)), int(unknown(k, l)), factor);
                });
        Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
        matrix.setFromTriplets(entries.begin(), entries.end());
        box_.compute(matrix);
    }

    // All four walls hold their potential.
    void solve_in_box(const Field& rho, const Walls& walls, Field& phi) {
        const long nx = grid_.x.cells, nz = grid_.z.cells;
        for (long j = 0; j <= nz; ++j) {
            phi[grid_.index(0, j)] = walls[x_low].potential;
            phi[grid_.index(nx, j)] = walls[x_high].potential;
        }
        for (long i = 1; i < nx; ++i) {
            phi[grid_.index(i, 0)] = walls[z_low].potential;
            phi[grid_.index(i, nz)] = walls[z_high].potential;
        }
        Eigen::VectorXd right((nx - 1) * (nz - 1));
        for (long j = 1; j < nz; ++j)
            for (long i = 1; i < nx; ++i) {
                double& value = right[unknown(i, j)];
                value = rho[grid_.index(i, j)];
                visit_stencil(i, j, [&](long k, long l, double factor) {
                    if (!inside(k, l)) value -= factor * phi[grid_.index(k, l)];
                });
            }
        const Eigen::VectorXd solution = box_.solve(right);
        for (long j = 1; j < nz; ++j)
            for (long i = 1; i < nx; ++i) phi[grid_.index(i, j)] = solution[unknown(i, j)];
    }

    static void transpose(const Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
        to.resize(from.cols(), from.rows());
        constexpr long tile = 16;
        common::for_each_row((from.cols() + tile - 1) / tile, [&](long part) {
            const long j = part * tile, width = std::min(tile, from.cols() - j);
            for (long i = 0; i < from.rows(); i += tile) {
                const long height = std::min(tile, from.rows() - i);
                to.block(j, i, width, height) = from.block(i, j, height, width).transpose();
            }
        });
    }

    Grid grid_;
    double coupling_;  // factor of delta_xx delta_zz
    RealTransform along_x_, along_z_;
    Eigen::MatrixXd rows_, columns_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> box_;
};

}  // namespace cic
