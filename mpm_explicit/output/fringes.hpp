// What a polariscope sees of loaded grains: the difference of the principal stresses on a raster of
// pixels, which a figure turns into fringes.
//
// Stress is averaged grain by grain on a patch of nodes of its own: nothing of one grain shows in
// the next. Its components are interpolated to the pixels, and s1 - s2 is taken there: taken
// earlier, the difference is wrong where the directions of stress turn, and fringes (not stresses)
// that are interpolated turn into moire.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "common/run/writers.hpp"
#include "mpm_explicit/grid/mesh.hpp"
#include "mpm_explicit/particles.hpp"
#include "mpm_explicit/shapes.hpp"

namespace mpm {

/// Square pixels, row after row from the bottom; axes hold the centers of the pixels. Between the
/// grains the number of the grain is -1 and the stresses are not numbers.
struct FringeRaster {
    common::SampledAxis x{"x", "length"}, y{"y", "length"};
    std::vector<double> stress_difference, pressure;  // s1 - s2, -(xx + yy + zz) / 3
    std::vector<double> coverage;                     // by the grain that is drawn there
    std::vector<int> grain;

    std::size_t pixel(long i, long j) const { return j * x.count + i; }
};

namespace detail {

/// Sums over particles at a node, of weights V S; then the stress, of weight 1 if there is any.
struct NodeStress {
    double weight = 0, xx = 0, yy = 0, xy = 0, mean = 0;

    void add(double part, const NodeStress& s) {
        weight += part, xx += part * s.xx, yy += part * s.yy, xy += part * s.xy;
        mean += part * s.mean;
    }
};

/// One grain on nodes i_first ... i_first + nodes_x - 1 and the like in y: memory in proportion to
/// the grain. Nodes may lie outside of a periodic mesh; they belong to no other grain.
struct Patch {
    long i_first = 0, j_first = 0, nodes_x = 0, nodes_y = 0;
    double volume = 0;             // of the grain
    std::vector<double> coverage;  // covered part of the cell around a node
    std::vector<NodeStress> stress;

    long node(long i, long j) const { return (j - j_first) * nodes_x + i - i_first; }
};

/// The grain of particles begin ... end - 1 on its nodes.
///   sigma_i = sum_p V_p S_ip sigma_p / sum_p V_p S_ip,  S linear
///   coverage_i = sum_p V_p S_ip / h^2,                  S quadratic
inline Patch average_on_nodes(const Particles& particles, long begin, long end, const Mesh& mesh) {
    const double per_h = 1 / mesh.h;
    Patch patch;
    // Leave two nodes free on all sides.
    const auto find_nodes = [&](const std::vector<double>& at, double edge, long& first,
                                long& nodes) {
        const auto [low, high] = std::minmax_element(at.begin() + begin, at.begin() + end);
        first = long(std::floor((*low - edge) * per_h)) - 2;
        nodes = long(std::floor((*high - edge) * per_h)) + 4 - first;
    };
    find_nodes(particles.x_p, mesh.x_low, patch.i_first, patch.nodes_x);
    find_nodes(particles.y_p, mesh.y_low, patch.j_first, patch.nodes_y);
    patch.coverage.assign(patch.nodes_x * patch.nodes_y, 0.0);
    patch.stress.resize(patch.nodes_x * patch.nodes_y);

    for (long p = begin; p < end; ++p) {
        const double V = particles.V_p[p], x = (particles.x_p[p] - mesh.x_low) * per_h,
                     y = (particles.y_p[p] - mesh.y_low) * per_h;
        const Stress s = particles.stress(p);
        patch.volume += V;
        const auto wide_x = QuadraticShape{}(x, per_h), wide_y = QuadraticShape{}(y, per_h);
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
                patch.coverage[patch.node(wide_x.first + a, wide_y.first + b)] +=
                    V * wide_x.S[a] * wide_y.S[b] * per_h * per_h;
        const auto in_x = LinearShape{}(x, per_h), in_y = LinearShape{}(y, per_h);
        for (int b = 0; b < 2; ++b)
            for (int a = 0; a < 2; ++a)
                patch.stress[patch.node(in_x.first + a, in_y.first + b)].add(
                    V * in_x.S[a] * in_y.S[b], {1, s.xx, s.yy, s.xy, (s.xx + s.yy + s.zz) / 3});
    }
    for (NodeStress& s : patch.stress)
        if (s.weight > 0)
            s = {1, s.xx / s.weight, s.yy / s.weight, s.xy / s.weight, s.mean / s.weight};
    return patch;
}

/// The pixels of one direction that a patch can reach, first ... first + count - 1 from the edge of
/// the mesh, and their weights at the nodes.
struct Reach {
    long first = 0, count = 0;
    std::vector<Weights<2>> linear;
    std::vector<Weights<3>> quadratic;
};

/// in:    nodes of the patch
inline Reach reach_pixels(long node_first, long nodes, int per_cell) {
    // Take the pixels whose nearest node has both neighbors in the patch.
    const double low = double(node_first + 1), high = double(node_first + nodes - 2);
    Reach reach;
    reach.first = long(std::ceil(low * per_cell - 0.5));
    reach.count = long(std::floor(high * per_cell - 0.5)) - reach.first + 1;
    for (long q = reach.first; q < reach.first + reach.count; ++q) {
        const double at = (double(q) + 0.5) / per_cell;
        reach.linear.push_back(LinearShape{}(at, 1.0));
        reach.quadratic.push_back(QuadraticShape{}(at, 1.0));
    }
    return reach;
}

/// The covered part of all pixels in reach, row after row.
inline std::vector<double> cover_pixels(const Patch& patch, const Reach& in_x, const Reach& in_y) {
    std::vector<double> covered, row(patch.nodes_x);
    covered.reserve(in_x.count * in_y.count);
    for (const Weights<3>& y : in_y.quadratic) {
        const std::size_t below = patch.node(patch.i_first, y.first);
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] = y.S[0] * patch.coverage[below + i] +
                     y.S[1] * patch.coverage[below + row.size() + i] +
                     y.S[2] * patch.coverage[below + 2 * row.size() + i];
        for (const Weights<3>& x : in_x.quadratic) {
            const double* at = &row[x.first - patch.i_first];
            covered.push_back(x.S[0] * at[0] + x.S[1] * at[1] + x.S[2] * at[2]);
        }
    }
    return covered;
}

/// The same by the particles of a grain with corners, each as large as it is: what is smooth over a
/// cell has none.
///   coverage = sum_p hat((x - x_p) / d) hat((y - y_p) / d),  d = V_p^1/2
/// note:  what is far inside is covered, also where particles have parted
inline std::vector<double> cover_by_particles(const Particles& at, long begin, long end,
                                              const FringeRaster& raster, const Patch& patch,
                                              const Reach& in_x, const Reach& in_y) {
    std::vector<double> covered = cover_pixels(patch, in_x, in_y);
    for (double& part : covered) part = part > 0.9 ? 1 : 0;
    for (long p = begin; p < end; ++p) {
        const double d = std::sqrt(at.V_p[p]) / raster.x.step,
                     x = (at.x_p[p] - raster.x.first) / raster.x.step - double(in_x.first),
                     y = (at.y_p[p] - raster.y.first) / raster.y.step - double(in_y.first);
        const auto first = [&](double a) { return std::max(0l, long(std::ceil(a - d))); };
        for (long m = first(y); m < in_y.count && double(m) < y + d; ++m)
            for (long n = first(x); n < in_x.count && double(n) < x + d; ++n)
                covered[m * in_x.count + n] +=
                    (1 - std::fabs(double(m) - y) / d) * (1 - std::fabs(double(n) - x) / d);
    }
    return covered;
}

/// The coverage above which a pixel belongs to the grain: near one half, and such that its pixels
/// have the area of its particles.
/// note:  Coverage is smooth over a cell, so that its line of one half lies inside of a small disk.
inline double outline_level(std::vector<double> covered, double pixels) {
    const auto inside = std::size_t(std::max(pixels, 0.0) + 0.5);
    if (inside >= covered.size()) return 0;
    const auto place = covered.begin() + long(inside);
    std::nth_element(covered.begin(), place, covered.end(), std::greater<>());
    // Round it, but to no simple fraction, so that pixels of equal coverage are on the same side.
    return (std::floor(*place * 1024) + std::numbers::inv_pi) / 1024;
}

/// The weighted sum over the four nodes around a pixel.
/// out:   of weight 0 where no particle is near
inline NodeStress stress_at(const Patch& patch, const Weights<2>& x, const Weights<2>& y) {
    NodeStress s;
    for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a) {
            const NodeStress& node = patch.stress[patch.node(x.first + a, y.first + b)];
            s.add(x.S[a] * y.S[b] * node.weight, node);
        }
    return s;
}

/// Draws one grain. Pixel i of a periodic mesh shows also what is whole periods of pixels away; period 0: none.
inline void draw_grain(const Patch& patch, const std::vector<double>& covered, int number,
                       const Reach& in_x, const Reach& in_y, long period, FringeRaster& raster) {
    const double level = outline_level(covered, patch.volume / (raster.x.step * raster.y.step));
    for (long m = 0; m < in_y.count; ++m) {
        const long j = in_y.first + m;
        if (j < 0 || j >= raster.y.count) continue;
        for (long n = 0; n < in_x.count; ++n) {
            const double part = covered[m * in_x.count + n];
            if (!(part > level)) continue;
            const NodeStress s = stress_at(patch, in_x.linear[n], in_y.linear[m]);
            if (!(s.weight > 0)) continue;
            long i = in_x.first + n;
            if (period > 0) i = (i % period + period) % period;
            if (i < 0 || i >= raster.x.count) continue;
            const std::size_t pixel = raster.pixel(i, j);
            if (!(part > raster.coverage[pixel])) continue;
            raster.coverage[pixel] = part;
            raster.grain[pixel] = number;
            raster.stress_difference[pixel] = std::hypot(s.xx - s.yy, 2 * s.xy) / s.weight;
            raster.pressure[pixel] = -s.mean / s.weight;
        }
    }
}

}  // namespace detail

/// Draws the difference of the principal stresses in grains.
///   s1 - s2 = [(s_xx - s_yy)^2 + 4 s_xy^2]^1/2
/// of components that come from the particles to nodes and from nodes to pixels by linear weights,
/// grain by grain. Where grains meet, a pixel shows the one that covers most of it.
/// in:    grains, each with its particles begin ... end - 1 and has_corners (a Grain, or any struct
///        with these); x_p may lie outside of a periodic mesh; at 7 or more pixels per cell what the
///        mesh resolves is smooth
/// out:   the raster
/// exact: uniform stress has the same s1 - s2 in all pixels of its grain
template <class Range>
FringeRaster draw_fringes(const Particles& particles, const std::vector<Range>& grains,
                          const Mesh& mesh, int pixels_per_cell = 8) {
    const double step = mesh.h / pixels_per_cell;
    FringeRaster raster;
    raster.x.first = mesh.x_low + 0.5 * step;
    raster.y.first = mesh.y_low + 0.5 * step;
    raster.x.step = raster.y.step = step;
    raster.x.count = mesh.cells_x * pixels_per_cell;
    raster.y.count = mesh.cells_y * pixels_per_cell;
    const long pixels = raster.x.count * raster.y.count;
    raster.stress_difference.assign(pixels, std::numeric_limits<double>::quiet_NaN());
    raster.pressure = raster.stress_difference;
    raster.coverage.assign(pixels, 0.0);
    raster.grain.assign(pixels, -1);

    const long period = mesh.periodic_x ? raster.x.count : 0;
    for (std::size_t g = 0; g < grains.size(); ++g) {
        using namespace detail;
        if (grains[g].end <= grains[g].begin) continue;
        const Patch patch = average_on_nodes(particles, grains[g].begin, grains[g].end, mesh);
        const Reach in_x = reach_pixels(patch.i_first, patch.nodes_x, pixels_per_cell),
                    in_y = reach_pixels(patch.j_first, patch.nodes_y, pixels_per_cell);
        draw_grain(patch,
                   grains[g].has_corners
                       ? cover_by_particles(particles, grains[g].begin, grains[g].end, raster,
                                            patch, in_x, in_y)
                       : cover_pixels(patch, in_x, in_y),
                   int(g), in_x, in_y, period, raster);
    }
    return raster;
}

}  // namespace mpm
