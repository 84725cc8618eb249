// The waves of the staggered mesh: what equations with constant coefficients do to a field, they do to
// each wave alone.
//
// Between walls a component on nodes vanishes on them and one on midpoints is even about them, so that
// both go on as periodic ones on a mesh of twice the length,
//
//     nodes      0   a   b   c  [0]        0   a   b   c   0  -c  -b  -a
//                |---|---|---|---|   -->   |---|---|---|---|---|---|---|
//     midpoints    a   b   c   d             a   b   c   d   d   c   b   a
//
// and in either case the waves are e^{i (k_x x + k_z z)}, counted from where a component lives. The
// forward difference from nodes to midpoints makes i K e^{i k x} of one, K = (2/dx) sin(k dx/2).
//
// Transforms along z take a few columns at a time, which stay in the cache on their way to the waves and back.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#include "common/parallel.hpp"
#include "implicit_moment/field/fftw.hpp"
#include "implicit_moment/field/vector_field.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// The waves of one direction: k = 0, then the positive ones, then the negative ones from the shortest.
struct AxisWaves {
    std::vector<double> angle;  // k dx, within pi on either side
    std::vector<double> K;      // what the forward difference makes of a wave [1/length]

    explicit AxisWaves(const common::Axis& axis) {
        const long count = (2 - axis.periodic) * axis.cells;
        for (long n = 0; n < count; ++n) {
            angle.push_back(2 * pi * double(2 * n <= count ? n : n - count) / double(count));
            K.push_back(2 / axis.spacing() * std::sin(0.5 * angle.back()));
        }
    }
    /// Points of the periodic mesh: the cells, or between walls twice as many.
    long points() const { return long(K.size()); }
};

/// One component that is transformed: its unknowns, and where it lives.
struct WaveComponent {
    const double* from;
    double* to;
    common::Place place;
};

/// Transforms to waves and back, of several components at a time.
/// note:   FFTW estimates its plans and does not time them: the same bytes in every run.
template <class Real, std::size_t components>
class MeshWaves {
   public:
    /// One row of waves, all k_z of one k_x: real and imaginary part in turn, by component.
    using Row = std::array<Real*, components>;

    AxisWaves x, z;

    explicit MeshWaves(const Grid& grid)
        : x(grid.x), z(grid.z), grid_(grid), room_(components * grid.z.cells * padded(rows())) {
        using F = Fftw<Real>;
        const Buffer a(std::max(rows(), z.points())), b(std::max(rows(), z.points()));
        Real* real = a.reals();
        Pair *from = as_pairs(real), *to = as_pairs(b.reals());
        const int n_x = int(x.points()), n_z = int(z.points());
        to_x_ = keep(F::plan_real(1, &n_x, 1, real, &n_x, 1, n_x, to, &n_x, 1, n_x, FFTW_ESTIMATE));
        from_x_ =
            keep(F::plan_back(1, &n_x, 1, to, &n_x, 1, n_x, real, &n_x, 1, n_x, FFTW_ESTIMATE));
        const auto plan_z = [&](int sign) {
            return keep(
                F::plan(1, &n_z, 1, from, &n_z, 1, n_z, to, &n_z, 1, n_z, sign, FFTW_ESTIMATE));
        };
        to_z_ = plan_z(FFTW_FORWARD), from_z_ = plan_z(FFTW_BACKWARD);
    }

    /// Rows of waves: k_x >= 0, since fields are real.
    long rows() const { return x.points() / 2 + 1; }
    /// Waves in a row: k_z = 0, 1, ... and then the negative ones, ... -2, -1.
    long columns() const { return z.points(); }

    /// Every wave of the components becomes what solve makes of it.
    /// in:     parts, their values on the unknowns; solve(row, waves), which may change a row of waves, counted
    ///         from node (0, 0) of each component
    /// out:    parts[k].to, the unknowns
    template <class Solve>
    void apply(const std::array<WaveComponent, components>& parts, const Solve& solve) {
        const long n_x = grid_.x.cells, n_z = grid_.z.cells, n_k = components;
        const double norm = 1 / (double(x.points()) * double(z.points()));
        // Calls work(k, row of the mesh, room for a row) for all rows of all components.
        const auto for_each_line = [&](const auto& work) {
            const long pieces = (n_z + at_once - 1) / at_once;
            common::for_each_row(
                n_k * pieces,
                [&](long piece) {
                    const Buffer line(x.points());
                    const long first = piece / n_k * at_once;
                    for (long j = first; j < std::min(n_z, first + at_once); ++j)
                        work(std::size_t(piece % n_k), j, line.reals());
                },
                grid_.size());
        };
        for_each_line([&](std::size_t k, long j, Real* line) {
            const double* from = parts[k].from + grid_.index(0, j);
            for (long i = 0; i < n_x; ++i) line[i] = Real(norm * from[i]);
            continue_behind_walls(grid_.x, parts[k].place.half_x, line);
            Fftw<Real>::run_real(to_x_.get(), line, as_pairs(along_x(k, j)));
        });
        common::for_each_row(
            (rows() + at_once - 1) / at_once,
            [&](long block) {
                const long first = block * at_once, count = std::min(at_once, rows() - first),
                           length = padded(columns());
                const Buffer columns_of_mesh(n_k * at_once * length), waves(n_k * length);
                const auto column = [&](std::size_t k, long m) {
                    return columns_of_mesh.numbers() + (long(k) * at_once + m) * length;
                };
                Row row;
                for (std::size_t k = 0; k < components; ++k) {
                    row[k] = waves.reals() + 2 * long(k) * length;
                    for (long j = 0; j < n_z; ++j)
                        for (long m = 0; m < count; ++m) column(k, m)[j] = along_x(k, j)[first + m];
                }
                for (long m = 0; m < count; ++m) {
                    for (std::size_t k = 0; k < components; ++k) {
                        continue_behind_walls(grid_.z, parts[k].place.half_z, column(k, m));
                        Fftw<Real>::run(to_z_.get(), as_pairs(column(k, m)), as_pairs(row[k]));
                    }
                    solve(first + m, row);
                    for (std::size_t k = 0; k < components; ++k)
                        Fftw<Real>::run(from_z_.get(), as_pairs(row[k]), as_pairs(column(k, m)));
                }
                for (std::size_t k = 0; k < components; ++k)
                    for (long j = 0; j < n_z; ++j)
                        for (long m = 0; m < count; ++m) along_x(k, j)[first + m] = column(k, m)[j];
            },
            grid_.size());
        for_each_line([&](std::size_t k, long j, Real* line) {
            Fftw<Real>::run_back(from_x_.get(), as_pairs(along_x(k, j)), line);
            double* to = parts[k].to + grid_.index(0, j);
            for (long i = 0; i < n_x; ++i) to[i] = double(line[i]);
        });
    }

   private:
    using Complex = std::complex<Real>;
    using Pair = Real[2];
    using Plan = std::shared_ptr<std::remove_pointer_t<decltype(Fftw<Real>::plan(
        1, nullptr, 1, nullptr, nullptr, 1, 1, nullptr, nullptr, 1, 1, 1, 0u))>>;
    static constexpr long at_once = 4;  // rows or columns

    // Room for complex numbers, which nobody has set to zero.
    struct Buffer {
        std::unique_ptr<Real[]> room;
        explicit Buffer(long count)
            : room(std::make_unique_for_overwrite<Real[]>(std::size_t(2 * count))) {}
        Real* reals() const { return room.get(); }
        Complex* numbers() const { return reinterpret_cast<Complex*>(reals()); }
    };

    // errors: bad_alloc where FFTW has no room for a plan
    static Plan keep(typename Plan::element_type* plan) {
        if (plan == nullptr) throw std::bad_alloc();
        return {plan, Fftw<Real>::destroy};
    }
    template <class Number>
    static Pair* as_pairs(Number* waves) {
        return reinterpret_cast<Pair*>(waves);
    }
    // Rows begin at multiples of 16 bytes, as FFTW's vectors want it.
    static long padded(long count) { return count + count % 2; }
    Complex* along_x(std::size_t k, long j) {
        return &room_[(k * std::size_t(grid_.z.cells) + std::size_t(j)) *
                      std::size_t(padded(rows()))];
    }

    // Odd about walls on nodes, even on midpoints, as drawn above.
    template <class Number>
    static void continue_behind_walls(const common::Axis& axis, bool half, Number* f) {
        const long n = axis.cells;
        if (axis.periodic) return;
        if (half) {
            for (long i = 0; i < n; ++i) f[2 * n - 1 - i] = f[i];
        } else {
            for (long i = 1; i < n; ++i) f[2 * n - i] = -f[i];
            f[0] = f[n] = 0;
        }
    }

    Grid grid_;
    std::vector<Complex> room_;  // [component][row of the mesh][k_x]
    Plan to_x_, from_x_, to_z_, from_z_;
};

using NodeWaves = MeshWaves<double, 1>;  // of a number on nodes, zero on walls
using FieldWaves = MeshWaves<float, 3>;  // of the three components of E

/// f becomes the function whose waves are those of f times factor(K^2), K^2 of the Laplacian.
/// in/out: f on nodes, zero on walls; ghosts filled afterwards.
template <class Factor>
inline void scale_waves(const Grid& grid, NodeWaves& waves, const Factor& factor, Field& f) {
    waves.apply({WaveComponent{f.data(), f.data(), common::on_nodes}},
                [&](long p, const NodeWaves::Row& row) {
                    const double K_x = waves.x.K[std::size_t(p)];
                    for (std::size_t q = 0; q < waves.z.K.size(); ++q) {
                        const double K_z = waves.z.K[q], by = factor(K_x * K_x + K_z * K_z);
                        row[0][2 * q] *= by, row[0][2 * q + 1] *= by;
                    }
                });
    common::fill_ghosts(grid, common::on_nodes, {-1, -1}, f.data());
}

/// Solves (1 - a^2 lap) g = f on nodes, with g = 0 on walls. in/out: f becomes g, ghosts filled.
/// exact:  to round-off.
inline void solve_helmholtz(const Grid& grid, NodeWaves& waves, double a, Field& f) {
    scale_waves(
        grid, waves, [a](double K2) { return 1 / (1 + a * a * K2); }, f);
}

/// Solves -lap g = f on nodes, with g = 0 on walls; where nothing fixes the mean, the means of f
/// and g are taken out.
inline void solve_poisson(const Grid& grid, NodeWaves& waves, Field& f) {
    scale_waves(
        grid, waves, [](double K2) { return K2 > 0 ? 1 / K2 : 0; }, f);
}

}  // namespace implicit_moment
