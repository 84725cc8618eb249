// The particles that fill the outline of a grain.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "mpm_explicit/grid/mesh.hpp"
#include "mpm_explicit/setup/cut_outline.hpp"

namespace mpm {

/// A particle of a grain at the start: its place, and what of the grain it stands for.
struct FilledPlace {
    double x = 0, y = 0, volume = 0;
    double half_x = 0, half_y = 0;     // half its sides, in cells
    std::vector<OutlinePart> surface;  // the outline around it; middles from the particle
};

namespace detail {

/// The pieces that an outline cuts out of the squares of a lattice, in units of its spacing.
class Pieces {
   public:
    /// in: center and radius, or corners, from the lower left corner of the mesh; per_side, pieces per
    ///     cell and direction
    Pieces(const Outline& outline, const Bounds& box, long per_side)
        : per_side_(per_side),
          first_i_(whole(box.x_low)),
          first_j_(whole(box.y_low)),
          columns_(whole(box.x_high) - first_i_ + 1),
          rows_(whole(box.y_high) - first_j_ + 1),
          pieces_(static_cast<std::size_t>(columns_ * rows_)) {
        std::vector<Point> row;
        const Piece full{1, 0, 0, 1.0 / 12, 1.0 / 12};
        for (long j = first_j_; j < first_j_ + rows_; ++j) {
            const auto y = double(j);
            if (outline.kind == OutlineKind::polygon)
                row = cut(cut(outline.corners, &Point::y, y, 1), &Point::y, y + 1, -1);
            for (long i = first_i_; i < first_i_ + columns_; ++i) {
                const auto x = double(i);
                const Piece piece =
                    outline.kind == OutlineKind::polygon
                        ? piece_of_polygon(row, x, y)
                        : piece_of_disk({outline.x, outline.y}, outline.radius, x, y);
                at(i, j) = piece.area > 1 - nothing ? full.moved(x + 0.5, y + 0.5)
                           : piece.area > nothing   ? piece
                                                    : Piece{};
            }
        }
        for_each_part(outline, [&](long i, long j, const OutlinePart& part) {
            if (has(i, j)) surface_[number(i, j)].push_back(part);
        });
        share_slivers();
    }

    /// Visits the pieces, cell by cell, row of cells by row of cells.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (long b = cell(first_j_); b <= cell(first_j_ + rows_ - 1); ++b)
            for (long a = cell(first_i_); a <= cell(first_i_ + columns_ - 1); ++a)
                for (long j = b * per_side_; j < (b + 1) * per_side_; ++j)
                    for (long i = a * per_side_; i < (a + 1) * per_side_; ++i)
                        if (has(i, j) && at(i, j).area > 0) {
                            const auto found = surface_.find(number(i, j));
                            visit(at(i, j), found == surface_.end() ? none_ : found->second);
                        }
    }

   private:
    static constexpr double nothing = 1e-9;  // area that is round-off of an outline
    static constexpr double even = 1e-7;     // difference of areas that are equal on paper
    static constexpr double sliver = 0.25;   // area below which others of its cell take it in,
    static constexpr double speck = 0.02;    // and below which those of another cell may

    long cell(long k) const { return k >= 0 ? k / per_side_ : -((per_side_ - 1 - k) / per_side_); }
    static long whole(double length) { return std::lround(std::floor(length)); }
    bool has(long i, long j) const {
        return i >= first_i_ && i < first_i_ + columns_ && j >= first_j_ && j < first_j_ + rows_;
    }
    Piece& at(long i, long j) { return pieces_[(j - first_j_) * columns_ + i - first_i_]; }
    const Piece& at(long i, long j) const {
        return pieces_[(j - first_j_) * columns_ + i - first_i_];
    }

    // Slivers go to the pieces beside them, to each in proportion to its area; where those are slivers
    // as well, to the larger ones, which go on in turn. What has no larger one beside it stays. An even
    // stress is in equilibrium, with linear shapes, where every full cell has its volume: so slivers
    // stay in their cell.
    void share_slivers() {
        for (bool shared = true; shared;) {
            shared = false;
            const std::vector<Piece> before = pieces_;
            for (long j = first_j_; j < first_j_ + rows_; ++j)
                for (long i = first_i_; i < first_i_ + columns_; ++i) {
                    const Piece small = before[number(i, j)];
                    if (small.area > 0 && small.area < sliver - even)
                        shared = share(i, j, small, before) || shared;
                }
        }
    }
    bool share(long i, long j, const Piece& small, const std::vector<Piece>& before) {
        const LatticePoint beside[4]{{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}};
        const auto for_each_larger = [&](const auto& visit) {
            for (const LatticePoint& to : beside)
                if (has(to.x, to.y) && before[number(to.x, to.y)].area > small.area + even &&
                    (small.area < speck - even || (cell(to.x) == cell(i) && cell(to.y) == cell(j))))
                    visit(number(to.x, to.y), before[number(to.x, to.y)].area);
        };
        double largest = 0, total = 0;
        for_each_larger([&](long, double area) { largest = std::max(largest, area); });
        const double least = std::min(largest, sliver) - even;
        for_each_larger([&](long, double area) { total += area >= least ? area : 0; });
        if (!(total > 0)) return false;
        const std::vector<OutlinePart> parts = std::move(surface_[number(i, j)]);
        surface_.erase(number(i, j));
        for_each_larger([&](long to, double area) {
            if (area < least) return;
            pieces_[to] += small.times(area / total);
            for (OutlinePart part : parts) {
                part.area_x *= area / total, part.area_y *= area / total;
                surface_[to].push_back(part);
            }
        });
        // Others may have given it theirs meanwhile.
        at(i, j) += small.times(-1);
        return true;
    }

    struct LatticePoint {
        long x, y;
    };
    long number(long i, long j) const { return (j - first_j_) * columns_ + i - first_i_; }
    long per_side_, first_i_, first_j_, columns_, rows_;
    std::map<long, std::vector<OutlinePart>> surface_;
    std::vector<OutlinePart> none_;
    std::vector<Piece> pieces_;
};

}  // namespace detail

/// The particles of a grain: one for each square of a lattice, for the part of it that is inside, at
/// the centroid of that part. Squares are h / per_side wide. A part below a quarter of a square
/// goes to its neighbors in the cell.
/// in:     per_side, particles per cell and direction
/// out:    places and volumes, cell by cell, row of cells by row of cells
/// exact:  sum of volumes and center of mass are those of the outline, to round-off; a disk's moment
///         of inertia as well
/// errors: InputError for an outline that reaches beyond the mesh; in a periodic direction the
///         particles stand inside the mesh instead, and the outline must not be longer than it
/// note:   Points have no moment of inertia of their own: those at the surface of a disk stand farther
///         out, by some hundredths of the spacing, to make up for it. So do the parts of its outline, by
///         h^2/12R, as nodes see their mean over a cell. Places are rounded to 1e-9 of
///         the spacing, so that those that are equal on paper are equal here. Sides are those of the
///         pieces in upright boxes, at most a cell, and else those of the squares: thin pieces of oblique cuts
///         bear stress of the wrong sign with theta = 1/2 when they are as narrow.
inline std::vector<FilledPlace> fill(const Outline& outline, const Mesh& mesh, long per_side) {
    const double spacing = mesh.h / double(per_side);
    const Bounds box = bounds(outline);
    const auto require_room = [&](double low, double high, double room_low, double room_high,
                                  const std::string& axis) {
        require(low >= room_low - 1e-6 * spacing && high <= room_high + 1e-6 * spacing,
                "an outline from " + axis + " = " + format(low) + " to " + format(high) +
                    " does not fit on the mesh, which has room from " + format(room_low) + " to " +
                    format(room_high) + ": move the grain or widen the mesh");
    };
    const double wrapped = mesh.periodic_x ? mesh.length_x() : 0;
    require_room(box.x_low, box.x_high, mesh.x_low - wrapped, mesh.x_high() + wrapped, "x");
    if (mesh.periodic_x) require_room(box.x_low, box.x_high, box.x_low, box.x_low + wrapped, "x");
    require_room(box.y_low, box.y_high, mesh.y_low, mesh.y_high(), "y");

    const auto lattice = [&](double x, double y) -> Point {
        const auto fine = [&](double length) {
            return std::ldexp(std::round(std::ldexp(length / spacing, 30)), -30);
        };
        return {fine(x - mesh.x_low), fine(y - mesh.y_low)};
    };
    Outline on_lattice = outline;
    const Point center = lattice(outline.x, outline.y);
    on_lattice.x = center.x, on_lattice.y = center.y, on_lattice.radius /= spacing;
    for (Point& p : on_lattice.corners) p = lattice(p.x, p.y);
    const detail::Pieces pieces(on_lattice, bounds(on_lattice), per_side);

    const bool round = outline.kind == OutlineKind::disk, upright = is_upright_box(outline);
    double whole = 0, parts = 0, area = 0;  // sums of area, and of area times distance squared
    const auto away = [&](const Point& p) {
        return (p.x - center.x) * (p.x - center.x) + (p.y - center.y) * (p.y - center.y);
    };
    pieces.for_each([&](const Piece& piece, const std::vector<OutlinePart>&) {
        (piece.area == 1 ? whole : parts) += piece.area * away(piece.centroid());
        area += piece.area;
    });
    const double radius = on_lattice.radius,
                 farther = round ? std::sqrt((0.5 * area * radius * radius - whole) / parts) : 1;
    // A node sees the mean over its neighborhood, a cell's sixth of h^2 in variance.
    const double cells = radius / double(per_side), outward = 1 + 1 / (12 * cells * cells);
    const auto from_center = [&](double factor, double x, double y) -> Point {
        return {center.x + factor * (x - center.x), center.y + factor * (y - center.y)};
    };
    std::vector<FilledPlace> particles;
    pieces.for_each([&](const Piece& piece, const std::vector<OutlinePart>& surface) {
        Point p = piece.centroid();
        if (round && piece.area != 1) p = from_center(farther, p.x, p.y);
        FilledPlace particle{0, 0, piece.area * (spacing * spacing), 0, 0, {}};
        const Point half = upright ? piece.half_sides() : Point{0.5, 0.5};
        const auto in_cells = [&](double side) {
            // Round-off makes no side of a square another one.
            const double exact = std::fabs(side - 0.5) < 1e-4 ? 0.5 : side;
            return std::clamp(exact / double(per_side), 1e-3, 0.5);
        };
        particle.half_x = in_cells(half.x), particle.half_y = in_cells(half.y);
        for (const OutlinePart& part : surface) {
            const Point at = round ? from_center(outward, part.x, part.y) : Point{part.x, part.y};
            particle.surface.push_back({spacing * part.area_x, spacing * part.area_y,
                                        spacing * (at.x - p.x), spacing * (at.y - p.y), part.side});
        }
        const double all = double(mesh.cells_x * per_side);
        if (mesh.periodic_x) p.x -= all * std::floor(p.x / all);
        particle.x = mesh.x_low + p.x * spacing, particle.y = mesh.y_low + p.y * spacing;
        particles.push_back(std::move(particle));
    });
    return particles;
}

}  // namespace mpm
