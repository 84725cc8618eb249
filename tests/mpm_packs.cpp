// Facts about outlines of grains, the particles that fill them, packs and their files, and about
// text among the parameters of a case.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mpm_explicit/setup/fill_grain.hpp"
#include "mpm_explicit/setup/pack_file.hpp"
#include "mpm_explicit/setup/packs.hpp"
#include "tests/support/any_numbers.hpp"
#include "tests/support/folder_of_test.hpp"

namespace {

using namespace facts;
using namespace mpm;
using common::InputError, common::ParameterTable;
constexpr double pi = std::numbers::pi;

double any_number(std::uint64_t k, std::uint32_t what, double low = 0, double high = 1) {
    return low + (high - low) * common::uniform(7, what, k, 0);
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// What an action says when it refuses its input; nothing when it does not.
std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

Outline letter_L(double x = 0, double y = 0) {
    return polygon(
        {{x, y}, {x + 3, y}, {x + 3, y + 1}, {x + 1, y + 1}, {x + 1, y + 2}, {x, y + 2}});
}
Outline star(double x, double y, double radius, long tips, double angle) {
    std::vector<Point> corners;
    for (long k = 0; k < 2 * tips; ++k) {
        const double r = k % 2 == 0 ? radius : 0.4 * radius, a = angle + pi * real(k) / real(tips);
        corners.push_back({x + r * std::cos(a), y + r * std::sin(a)});
    }
    return polygon(corners);
}

// Outlines of every kind, about as large as 1 and near the origin.
Outline any_outline(std::uint64_t k) {
    const double x = any_number(k, 1, -1, 1), y = any_number(k, 2, -1, 1),
                 r = any_number(k, 3, 0.3, 0.8), angle = any_number(k, 4, 0, 360);
    const long sides = 3 + static_cast<long>(k % 5);
    switch (k % 4) {
        case 0:
            return disk(x, y, r);
        case 1:
            return regular_polygon(x, y, r, sides, angle);
        case 2:
            return box(x, y, r, any_number(k, 5, 0.2, 1.5), angle);
        default:
            return star(x, y, r, sides, angle);
    }
}
bool is_convex(std::uint64_t k) { return k % 4 != 3; }

Mesh mesh_of(long cells_x, long cells_y, double h, double x_low = 0, double y_low = 0) {
    Mesh mesh;
    mesh.cells_x = cells_x, mesh.cells_y = cells_y, mesh.h = h;
    mesh.x_low = x_low, mesh.y_low = y_low;
    return mesh;
}

double distance(const Outline& a, const Outline& b, double period) {
    const double dx = period > 0 ? std::remainder(a.x - b.x, period) : a.x - b.x;
    return std::hypot(dx, a.y - b.y);
}

std::filesystem::path folder() {
    const std::filesystem::path path = std::filesystem::absolute(facts::folder_of_test());
    std::filesystem::create_directories(path);
    return path;
}
std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Texts {
    std::string name, path = "none", kind = "one", second = "none";
};

}  // namespace

TEST_CASE("area and centroid and width of an outline are those of geometry") {
    const Outline round = disk(0.3, -2, 0.5);
    CHECK(area(round) == about(pi / 4).epsilon(1e-15));
    CHECK(thinnest(round) == 1);
    CHECK(bounds(round).x_low == about(-0.2));
    CHECK(bounds(round).y_high == -1.5);
    for (const double angle : {0.0, 17.0, 45.0, 90.0, 200.0}) {
        const Outline bar = box(5, 6, 3, 0.5, angle);
        CHECK(area(bar) == about(1.5).epsilon(1e-14));
        CHECK(thinnest(bar) == about(0.5).epsilon(1e-14));
        CHECK(centroid(bar).x == about(5).epsilon(1e-14));
        CHECK(centroid(bar).y == about(6).epsilon(1e-14));
        for (const long n : {3L, 4L, 5L, 12L}) {
            const Outline regular = regular_polygon(-1, 2, 0.7, n, angle);
            const double sector = pi / real(n), apothem = 0.7 * std::cos(sector);
            CHECK(area(regular) == about(0.49 * real(n) * std::sin(2 * sector) / 2).epsilon(1e-14));
            CHECK(thinnest(regular) ==
                  about(n % 2 == 0 ? 2 * apothem : 0.7 + apothem).epsilon(1e-14));
            CHECK(centroid(regular).x == about(-1).epsilon(1e-14));
            CHECK(regular.radius == about(0.7).epsilon(1e-14));
        }
    }
    const Outline L = letter_L();
    CHECK(area(L) == about(4).epsilon(1e-14));
    CHECK(centroid(L).x == about((3 * 1.5 + 0.5) / 4).epsilon(1e-14));
    CHECK(centroid(L).y == about((3 * 0.5 + 1.5) / 4).epsilon(1e-14));
    // The hull of the L is closed by the line from (3, 1) to (1, 2).
    CHECK(thinnest(L) == about(2).epsilon(1e-14));
    const Outline far = moved(L, 1e3, -1e3);
    CHECK(area(far) == about(4).epsilon(1e-12));
    CHECK(centroid(far).y == about(0.75 - 1e3).epsilon(1e-14));
}

TEST_CASE("a polygon is the same whichever way around its corners are given") {
    std::vector<Point> corners = letter_L().corners;
    std::reverse(corners.begin() + 1, corners.end());
    const Outline turned = polygon(corners);
    CHECK(area(turned) > 0);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        CHECK(turned.corners[k].x == letter_L().corners[k].x);
        CHECK(turned.corners[k].y == letter_L().corners[k].y);
    }
}

TEST_CASE("what is no outline is refused with the corner and the cure") {
    const auto says = [](std::vector<Point> corners) {
        return refusal([&] { polygon(std::move(corners)); });
    };
    const double none = std::nan("");
    CHECK(holds(says({}), "a polygon of 0 corners: give at least 3"));
    CHECK(holds(says({{0, 0}, {1, 1}}), "a polygon of 2 corners: give at least 3"));
    CHECK(holds(says(std::vector<Point>(1001)), "a polygon of 1001 corners"));
    CHECK(holds(says({{0, 0}, {1, 0}, {1, none}}), "corner 3 is not at a finite place"));
    CHECK(holds(says({{0, 0}, {1, 0}, {1, 1e200}}), "corner 3 is not at a finite place"));
    CHECK(
        holds(says({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), "corners 2 and 3 of a polygon are the same"));
    CHECK(
        holds(says({{0, 0}, {1, 0}, {0, 1}, {0, 0}}), "corners 4 and 1 of a polygon are the same"));
    CHECK(holds(says({{0, 0}, {1, 1}, {2, 2}}), "the 3 corners of a polygon lie on a line"));
    CHECK(holds(says({{0, 0}, {1, 1}, {1, 0}, {0, 1}}),
                "the side from corner 1 to 2 of a polygon meets the side from corner 3 to 4"));
    // A corner on a side; a corner met twice; a side that turns back.
    CHECK(holds(says({{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}}), "meets the side"));
    CHECK(holds(says({{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}}), "meets the side"));
    CHECK(holds(says({{0, 0}, {2, 0}, {1, 0}, {0, 1}}), "meets the side"));
    CHECK(
        holds(refusal([] { disk(0, 0, 0); }), "the radius of a disk = 0 must be a length above 0"));
    CHECK(holds(refusal([] { disk(0, 0, -1); }), "the radius of a disk = -1"));
    CHECK(holds(refusal([&] { disk(none, 0, 1); }), "the center of a disk"));
    CHECK(holds(refusal([] { box(0, 0, 1, 0); }), "the height of a box = 0"));
    CHECK(holds(refusal([] { box(0, 0, -1, 1); }), "the width of a box = -1"));
    CHECK(holds(refusal([] { regular_polygon(0, 0, 1, 2); }), "a regular polygon of 2 sides"));
    CHECK(refusal([] { letter_L(), star(0, 0, 1, 5, 0.3); }).empty());
    // Corners on a straight side are no fault.
    CHECK(refusal([] { polygon({{0, 0}, {1, 0}, {2, 0}, {0, 1}}); }).empty());
}

TEST_CASE("a point is inside an outline that winds around it") {
    int inside = 0;
    for (std::uint64_t k = 0; k < 40; ++k) {
        const Outline outline = any_outline(k);
        for (std::uint64_t m = 0; m < 100; ++m) {
            const double x = any_number(100 * k + m, 6, -2, 2),
                         y = any_number(100 * k + m, 7, -2, 2);
            double angle = 0;
            for (std::size_t c = 0; c < outline.corners.size(); ++c) {
                const Point &a = outline.corners[c],
                            &b = outline.corners[(c + 1) % outline.corners.size()];
                angle += std::remainder(std::atan2(b.y - y, b.x - x) - std::atan2(a.y - y, a.x - x),
                                        2 * pi);
            }
            const bool winds = outline.kind == OutlineKind::disk
                                   ? std::hypot(x - outline.x, y - outline.y) < outline.radius
                                   : std::fabs(angle) > pi;
            CHECK(contains(outline, x, y) == winds);
            inside += winds;
        }
    }
    CHECK(inside > 100);
    // A point on the side of two neighbors belongs to one.
    for (const double y : {0.0, 0.25, 0.5})
        CHECK(contains(box(0, 0, 1, 2), 0.5, y) != contains(box(1, 0, 1, 2), 0.5, y));
}

TEST_CASE("how deep disks and boxes overlap is what geometry says") {
    const double tight = 1e-13;
    CHECK(overlap_depth(disk(0, 0, 1), disk(1.5, 0, 0.75)) == about(0.25).epsilon(tight));
    CHECK(overlap_depth(disk(0, 0, 1), disk(3, 4, 4)) == 0);
    CHECK(overlap_depth(disk(0, 0, 1), disk(0.25, 0, 0.1)) == about(0.85).epsilon(tight));
    CHECK(overlap_depth(box(0, 0, 2, 2), box(1.75, 0.5, 2, 1)) == about(0.25));
    CHECK(overlap_depth(box(0, 0, 2, 2), box(2, 0, 2, 2)) == 0);
    CHECK(overlap_depth(box(0, 0, 2, 2), box(2, 2, 2, 2)) == 0);
    // A corner in a side, a disk on a side and on a corner, and one inside.
    CHECK(overlap_depth(box(0, 0, 2, 2), box(1 + std::sqrt(2.0) - 0.1, 0, 2, 2, 45)) ==
          about(0.1).epsilon(tight));
    CHECK(overlap_depth(box(0, 0, 2, 2), disk(1.4, 0.3, 0.5)) == about(0.1));
    CHECK(overlap_depth(disk(4, 5, 5.5), box(0, 0, 2, 2)) == about(0.5));
    CHECK(overlap_depth(disk(0.5, 0.2, 0.25), box(0, 0, 2, 2)) == about(0.75));
    // In the notch of an L there is room.
    CHECK(overlap_depth(letter_L(), box(2, 1.5, 2, 1)) == 0);
    CHECK(overlap_depth(letter_L(), disk(1.5, 1.5, 0.5)) == 0);
    CHECK(overlap_depth(letter_L(), disk(1.45, 1.5, 0.5)) == about(0.05));
    CHECK(overlap_depth(letter_L(), box(1.95, 1.45, 2, 1)) > 0.04);
    // And in that of a small wedge, in whose first corner another one lies.
    const Outline wedge = polygon({{1, 0}, {1, 1}, {0.5, 0.1}, {0, 0}});
    CHECK(overlap_depth(wedge, box(0.7, 0.6, 0.05, 0.05)) == 0);
    CHECK(overlap_depth(wedge, box(0.7, 0.4, 0.05, 0.05)) > 0.04);
    // Grains that only touch, to the round-off of their places.
    CHECK(overlap_depth(disk(0.1, 0, 0.1), disk(0.3, 0, 0.1)) == 0);
    CHECK(overlap_depth(disk(0, 0, 1), disk(2 - 0.5e-9, 0, 1)) == 0);
    CHECK(overlap_depth(disk(0, 0, 1), disk(2 - 2e-9, 0, 1)) > 0);
    for (int angle = 0; angle < 90; ++angle) {
        const double c = std::cos(angle * pi / 180), s = std::sin(angle * pi / 180);
        const Outline bar = box(0.1, 0.7, 1, 3, angle);
        CHECK(overlap_depth(bar, moved(bar, c - 0.3 * s, s + 0.3 * c)) == 0);
        CHECK(overlap_depth(bar, disk(0.1 + 1.5 * c - s, 0.7 + 1.5 * s + c, 1)) == 0);
    }
}

TEST_CASE("the depth of an overlap is the shortest way out") {
    int overlapping = 0, apart = 0;
    for (std::uint64_t k = 0; k < 400; ++k) {
        const std::uint64_t first = any_number(k, 8) < 0.5 ? k : 7 * k + 1, second = 3 * k + 2;
        const Outline a = any_outline(first), b = any_outline(second);
        const double depth = overlap_depth(a, b);
        CHECK(std::fabs(overlap_depth(b, a) - depth) <= 1e-12 * depth);
        // Move one outline away in every direction.
        bool out = false, too_early = false;
        for (int m = 0; m < 720; ++m) {
            const double way = 2 * pi * m / 720, c = std::cos(way), s = std::sin(way);
            const auto left = [&](double part) {
                return overlap_depth(a, moved(b, part * depth * c, part * depth * s));
            };
            if (depth > 0 && left(1.001) == 0) out = true;
            if (depth > 0 && left(0.99) == 0) too_early = true;
        }
        overlapping += depth > 0, apart += depth == 0;
        CHECK_FALSE(too_early);
        if (depth > 0 && is_convex(first) && is_convex(second)) CHECK(out);
    }
    CHECK(overlapping > 100);
    CHECK(apart > 50);
}

TEST_CASE("outlines overlap exactly when they have points in common") {
    for (std::uint64_t k = 0; k < 300; ++k) {
        const Outline a = any_outline(4 * k + 3), b = any_outline(5 * k + 1);
        const double depth = overlap_depth(a, b);
        long common_points = 0;
        for (double x = -1.8; x < 1.8; x += 0.02)
            for (double y = -1.8; y < 1.8; y += 0.02)
                common_points += contains(a, x, y) && contains(b, x, y);
        if (common_points > 0) CHECK(depth > 0);
        if (depth > 0.06) CHECK(common_points > 0);
    }
}

TEST_CASE("a box along mesh lines is filled to its area") {
    for (const double h : {0.025, 0.1, 1.0 / 80, 0.3}) {
        for (const long per_side : {1L, 2L, 3L, 4L}) {
            const Mesh mesh = mesh_of(40, 30, h, 0.7, -0.9);
            for (const auto& [i, j, columns, rows] :
                 {std::array{0L, 0L, 40L, 30L}, {3L, 5L, 7L, 2L}, {39L, 29L, 1L, 1L}}) {
                const double width = real(columns) * h, height = real(rows) * h;
                const auto particles = fill(box(mesh.x_of(real(i)) + width / 2,
                                                mesh.y_of(real(j)) + height / 2, width, height),
                                            mesh, per_side);
                CHECK(static_cast<long>(particles.size()) == columns * rows * per_side * per_side);
            }
        }
    }
}

TEST_CASE("the sides at a sharp corner are told apart and those of a round outline are not") {
    for (long n = 3; n <= 40; ++n) {
        if (n == 36) continue;  // its corners turn by ten degrees
        CAPTURE(n);
        const Outline outline = regular_polygon(0, 0, 1, n, 7);
        const auto sides = number_sides(outline.corners);
        REQUIRE(long(sides.size()) == n);
        for (long k = 0; k < n; ++k)
            CHECK((sides[k][1] != sides[(k + 1) % n][0]) == (360.0 / double(n) > 10));
        // Of the outline, each half of a side that is both stands on its own half.
        double of[2] = {0, 0};
        for (const FilledPlace& p : fill(outline, mesh_of(40, 40, 0.1, -2, -2), 3))
            for (const OutlinePart& part : p.surface)
                of[part.side] += std::hypot(part.area_x, part.area_y);
        const double around = 2 * double(n) * std::sin(std::numbers::pi / double(n));
        CHECK(std::fabs(of[0] + of[1] - around) <= 1e-9);
        CHECK(std::fabs(of[1] - (n < 36 ? around / 2 : 0)) <= 1e-9);
    }
}

TEST_CASE("the particles of a grain have its area and its center of mass and its outline") {
    const Mesh mesh = mesh_of(40, 40, 0.1, -2, -2);
    for (std::uint64_t k = 0; k < 80; ++k) {
        CAPTURE(k);
        const Outline outline = any_outline(k);
        double whole = 0, x = 0, y = 0, least = 1, largest = 0, around_x = 0, around_y = 0,
               twice = 0;
        std::pair<long, long> before{-1000, -1000};
        for (const FilledPlace& p : fill(outline, mesh, 3)) {
            whole += p.volume, x += p.volume * p.x, y += p.volume * p.y;
            least = std::min(least, p.volume * 900), largest = std::max(largest, p.volume * 900);
            for (const OutlinePart& part : p.surface) {
                around_x += part.area_x, around_y += part.area_y;
                // Twice the area is the integral of x.n around it.
                twice += part.area_x * (p.x + part.x) + part.area_y * (p.y + part.y);
                CHECK(std::hypot(part.x, part.y) < 2.5 / 30);
                const Point at{p.x + part.x, p.y + part.y};
                const double away = outline.kind == OutlineKind::disk
                                        ? std::fabs(distance(at, Point{outline.x, outline.y}) -
                                                    outline.radius - 0.01 / (12 * outline.radius))
                                        : distance_to_outline(outline.corners, at);
                CHECK(away < 1e-9);
            }
            if (is_convex(k)) {
                const double reach = 2.0 / 30;
                CHECK(std::fabs(p.x - outline.x) < outline.radius + reach);
            }
            const std::pair cell{std::lround(std::floor((p.y + 2) * 10 - 1e-6)),
                                 std::lround(std::floor((p.x + 2) * 10 - 1e-6))};
            // What takes slivers in may lean out of its cell, but by less than another cell.
            CHECK(before.first <= cell.first + 1);
            before = cell;
        }
        const bool round = outline.kind == OutlineKind::disk;
        CHECK(std::fabs(whole / area(outline) - 1) < 1e-8);
        const double near = round ? 2e-3 * outline.radius : 1e-7;
        CHECK(std::fabs(x / whole - centroid(outline).x) < near);
        CHECK(std::fabs(y / whole - centroid(outline).y) < near);
        CHECK(least > (is_convex(k) ? 0.01 : 0));
        CHECK(largest < 2.5);
        // Corners that cut less than 1e-9 of a square are left out: 1.5e-6 of the outline each.
        CHECK(std::hypot(around_x, around_y) < 1e-5);
        // Chords, whose middles stand farther out.
        const double out = round ? 0.01 / (12 * outline.radius * outline.radius) : 0;
        CHECK(std::fabs(twice / (2 * area(outline)) - 1 - out) < (round ? 1e-3 : 1e-5));
    }
}

TEST_CASE("a disk of eight cells has its area and its moment of inertia to round-off") {
    for (const double cells : {4.0, 8.0, 16.0, 32.0}) {
        for (const double shift : {0.0, 0.13, 0.37, 0.5}) {
            const Mesh mesh = mesh_of(std::lround(3 * cells), std::lround(3 * cells), 1 / cells);
            const double x = 1.5 + shift * mesh.h, y = 1.5 - 0.7 * shift * mesh.h;
            double whole = 0, inertia = 0, least = 1;
            for (const FilledPlace& p : fill(disk(x, y, 0.5), mesh, 2)) {
                whole += p.volume, least = std::min(least, 4 * p.volume / (mesh.h * mesh.h));
                inertia += p.volume * ((p.x - x) * (p.x - x) + (p.y - y) * (p.y - y));
            }
            CHECK(std::fabs(whole / (pi * 0.25) - 1) < 1e-13);
            CHECK(std::fabs(inertia / (0.125 * whole) - 1) < 1e-10);
            CHECK(least >= 0.02);
        }
    }
}

TEST_CASE("mirror images about a mesh line are filled alike") {
    // The rebounding grains: disks at 0.35 and 0.85 mirrored about 0.6, for round and odd meshes.
    const auto sorted = [](std::vector<FilledPlace> places, double about) {
        for (FilledPlace& p : places)
            if (about > 0) p.x = 2 * about - p.x;
        std::sort(places.begin(), places.end(), [](const FilledPlace& a, const FilledPlace& b) {
            return std::lround(1e7 * a.y) != std::lround(1e7 * b.y)
                       ? std::lround(1e7 * a.y) < std::lround(1e7 * b.y)
                       : a.x < b.x;
        });
        return places;
    };
    const auto compare = [&](const std::vector<FilledPlace>& one,
                             const std::vector<FilledPlace>& other, double h) {
        const auto a = sorted(one, 0), b = sorted(other, 0.6);
        REQUIRE(a.size() == b.size());
        double off = 0;
        for (std::size_t k = 0; k < a.size(); ++k)
            off = worst({off, std::fabs(a[k].x - b[k].x) / h, std::fabs(a[k].y - b[k].y) / h,
                         std::fabs(a[k].volume - b[k].volume) / (h * h)});
        CHECK(off < 1e-7);
    };
    for (const double h : {0.025, 0.0125, 0.05, 0.6 / 7, 0.6 / 23}) {
        for (const long per_side : {1L, 2L, 3L, 4L}) {
            const long cells = std::lround(1.2 / h);
            const Mesh mesh = mesh_of(cells, cells, h);
            for (const double x : {0.25, 0.3, 0.35, 0.35 + h / 3, 0.35 + h / 6}) {
                for (const double radius : {0.2, 8 * h, 0.2 + h / 7}) {
                    if (radius > 0.24) continue;
                    compare(fill(disk(x, 0.3, radius), mesh, per_side),
                            fill(disk(0.6 + (0.6 - x), 0.3, radius), mesh, per_side), h);
                }
            }
            const auto whole = fill(regular_polygon(0.6, 0.6, 0.55, 6), mesh, per_side);
            compare(whole, whole, h);
        }
    }
}

TEST_CASE("a grain across the ends of a periodic mesh is filled on both sides") {
    Mesh mesh = mesh_of(50, 10, 0.02);
    const auto whole = fill(disk(0.5, 0.1, 0.1), mesh, 2);
    for (const auto& sentence : {refusal([&] { fill(disk(1, 0.1, 0.1), mesh, 2); }),
                                 refusal([&] { fill(disk(0.5, 0.15, 0.1), mesh, 2); }),
                                 refusal([&] { fill(disk(0.05, 0.1, 0.1), mesh, 2); })})
        CHECK(holds(sentence, "does not fit on the mesh"));
    mesh.periodic_x = true;
    CHECK(holds(refusal([&] { fill(disk(0.5, 0.15, 0.1), mesh, 2); }), "does not fit"));
    CHECK(holds(refusal([&] { fill(box(0.5, 0.1, 1.1, 0.1), mesh, 2); }), "does not fit"));
    CHECK(holds(refusal([&] { fill(disk(1e80, 0.1, 0.1), mesh, 2); }), "does not fit"));
    CHECK(fill(box(0.7, 0.1, 1, 0.2), mesh, 2).size() == 2000);
    for (const double x : {0.0, 1.0}) {
        const auto split = fill(disk(x, 0.1, 0.1), mesh, 2);
        REQUIRE(split.size() == whole.size());
        for (const FilledPlace& p : split) {
            CHECK((p.x >= 0 && p.x < 1));
            const bool there = std::any_of(whole.begin(), whole.end(), [&](const FilledPlace& q) {
                return std::fabs(std::remainder(p.x - q.x - 0.5, 1)) < 1e-9 &&
                       std::fabs(p.y - q.y) < 1e-9;
            });
            CHECK(there);
        }
    }
}

TEST_CASE("an outline may reach beyond the mesh by a millionth of the spacing and no further") {
    const double h = 0.5, spacing = 0.25;
    const Mesh mesh = mesh_of(4, 6, h, -1, -2);  // to 1 and 1
    const auto fits = [&](double left, double right, double below, double above) {
        const double x_low = -1 - left, x_high = 1 + right, y_low = -2 - below, y_high = 1 + above;
        const Outline outline =
            polygon({{x_low, y_low}, {x_high, y_low}, {x_high, y_high}, {x_low, y_high}});
        std::size_t count = 0;
        const std::string sentence = refusal([&] { count = fill(outline, mesh, 2).size(); });
        CHECK((holds(sentence, "does not fit on the mesh") || count == 8 * 12));
        return sentence.empty();
    };
    const double just = 1e-6 * spacing, far = 1.1e-6 * spacing;
    CHECK(fits(just, just, just, just));
    CHECK_FALSE(fits(far, 0, 0, 0));
    CHECK_FALSE(fits(0, far, 0, 0));
    CHECK_FALSE(fits(0, 0, far, 0));
    CHECK_FALSE(fits(0, 0, 0, far));
}

TEST_CASE("rows of disks make the compressed pack and the sheared one") {
    Rows rows;
    rows.x = 0.1, rows.y = 0.1, rows.columns = 5, rows.rows = 4, rows.radius = 0.1;
    rows.shift = 0.1, rows.one_less = true;
    const auto compressed = hexagonal_rows(rows);
    CHECK(compressed.size() == 18);
    CHECK(compressed.front().name == "g0001");
    CHECK(compressed.back().name == "g0018");
    CHECK(compressed.back().outline.x == about(0.8));
    CHECK(compressed.back().outline.y == about(0.1 + 0.3 * std::sqrt(3.0)));
    double right = 0, top = 0;
    for (const PackedGrain& grain : compressed) {
        right = std::max(right, bounds(grain.outline).x_high);
        top = std::max(top, bounds(grain.outline).y_high);
    }
    CHECK(right == about(1));
    CHECK(top == about(0.7196).epsilon(1e-4));
    CHECK(overlaps(compressed, 0, 0).depth == 0);
    CHECK(overlaps(compressed, 1, 0).depth == 0);

    rows.rows = 5, rows.one_less = false, rows.spacing_y = 0.18;
    const auto sheared = hexagonal_rows(rows);
    CHECK(sheared.size() == 25);
    CHECK(sheared[9].outline.x == about(1));
    CHECK(sheared[24].outline.y == about(0.1 + 4 * 0.18));
    CHECK(overlaps(sheared, 1, 0).depth == 0);
    rows.spacing_y = 0.17;
    CHECK(overlaps(hexagonal_rows(rows), 1, 0).depth ==
          about(0.2 - std::hypot(0.1, 0.17)).epsilon(1e-9));
}

TEST_CASE("rows without a spacing leave just the gap") {
    for (const double gap : {0.0, 0.03}) {
        for (const double spacing_x : {0.0, 0.3, 0.45}) {
            for (const double shift : {0.0, 0.05, 0.1, 0.2, -0.3}) {
                Rows rows;
                rows.columns = 4, rows.rows = 5, rows.radius = 0.1, rows.gap = gap;
                rows.spacing_x = spacing_x, rows.shift = shift;
                const auto grains = hexagonal_rows(rows);
                double least = 1e9;
                for (const PackedGrain& a : grains)
                    for (const PackedGrain& b : grains)
                        if (a.name < b.name && a.outline.y != b.outline.y)
                            least = std::min(least, distance(a.outline, b.outline, 0) - 0.2);
                CHECK(least >= gap - 1e-12);
                // Far at the ends two rows may miss each other.
                if (std::fabs(shift) < 0.15) CHECK(least <= gap + 1e-12);
            }
        }
    }
    Rows rows;
    CHECK(holds(refusal([&] { hexagonal_rows(rows); }), "the radius of the disks in rows = 0"));
    rows.radius = 1, rows.columns = 0;
    CHECK(holds(refusal([&] { hexagonal_rows(rows); }), "1 rows of 0 disks"));
    rows.columns = 1, rows.rows = 2, rows.one_less = true;
    CHECK(holds(refusal([&] { hexagonal_rows(rows); }), "2 rows of 1 disks"));
    rows.one_less = false, rows.gap = -1;
    CHECK(holds(refusal([&] { hexagonal_rows(rows); }), "a gap or spacing of rows is -1"));
    rows.gap = 0, rows.spacing_x = 5, rows.shift = 2.5;
    CHECK(holds(refusal([&] { hexagonal_rows(rows); }), "two rows shifted by 2.5 fall into one"));
}

namespace {

RandomDisks pack_of(long count, bool periodic, bool loose, double gap) {
    RandomDisks pack;
    pack.box = {-0.3, 0.7, 2, loose ? 6.0 : 4.0};
    pack.radius_min = 0.01, pack.radius_max = 0.025, pack.count = count;
    pack.periodic_x = periodic, pack.loose = loose, pack.gap = gap;
    return pack;
}

}  // namespace

TEST_CASE("the disks of a random pack keep their gap and stay in the box") {
    for (const bool periodic : {false, true}) {
        for (const bool loose : {false, true}) {
            for (const double gap : {0.0, 0.004}) {
                const RandomDisks pack = pack_of(700, periodic, loose, gap);
                const auto grains = random_disks(pack);
                REQUIRE(grains.size() == 700);
                double least = 1, low = 1, beside = 1;
                for (std::size_t k = 0; k < grains.size(); ++k) {
                    const Outline& a = grains[k].outline;
                    CHECK(a.radius >= 0.01);
                    CHECK(a.radius <= 0.025);
                    for (std::size_t m = 0; m < k; ++m) {
                        const Outline& b = grains[m].outline;
                        least =
                            std::min(least, distance(a, b, periodic ? 1 : 0) - a.radius - b.radius);
                    }
                    low = std::min({low, bounds(a).y_low - 2, pack.box.y_high - bounds(a).y_high});
                    beside = std::min({beside, bounds(a).x_low + 0.3, 0.7 - bounds(a).x_high});
                    CHECK(a.x >= -0.3);
                    CHECK(a.x < 0.7);
                }
                CHECK(least >= gap - 1e-12);
                CHECK(low >= gap / 2 - 1e-12);
                if (!periodic) CHECK(beside >= gap / 2 - 1e-12);
                if (!loose) CHECK(least <= gap + 1e-12);
                CHECK(overlaps(grains, periodic ? 1 : 0, 0).depth == 0);
            }
        }
    }
}

TEST_CASE("a loose disk may lie anywhere in its box") {
    RandomDisks pack;
    pack.box = {-1, 1, 0, 2}, pack.radius_min = pack.radius_max = 0.4, pack.count = 1;
    pack.loose = true;
    Bounds all{0, 0, 1, 1};
    for (pack.seed = 1; pack.seed <= 200; ++pack.seed) {
        const Bounds one = bounds(random_disks(pack)[0].outline);
        all = {std::min(all.x_low, one.x_low), std::max(all.x_high, one.x_high),
               std::min(all.y_low, one.y_low), std::max(all.y_high, one.y_high)};
    }
    CHECK(std::fabs(all.x_low + 1) < 0.03);
    CHECK(std::fabs(all.x_high - 1) < 0.03);
    CHECK(std::fabs(all.y_low) < 0.03);
    CHECK(std::fabs(all.y_high - 2) < 0.03);
}

TEST_CASE("every deposited disk rests on what was there before") {
    for (const double width : {1.0, 0.11, 0.26}) {
        for (const bool periodic : {false, true}) {
            RandomDisks pack = pack_of(400, periodic && width > 0.25, false, 0);
            pack.box = {0, width, 0, 20};
            const double period = pack.periodic_x ? width : 0, near = 1e-9;
            const auto grains = random_disks(pack);
            for (std::size_t k = 0; k < grains.size(); ++k) {
                const Outline& a = grains[k].outline;
                if (a.y - a.radius < near) continue;
                // Something to the left and something to the right, and one of them below.
                bool left = period == 0 && a.x - a.radius < near,
                     right = period == 0 && a.x + a.radius > width - near, below = false;
                for (std::size_t m = 0; m < k; ++m) {
                    const Outline& b = grains[m].outline;
                    if (distance(a, b, period) - a.radius - b.radius > near) continue;
                    const double to = period > 0 ? std::remainder(b.x - a.x, period) : b.x - a.x;
                    left = left || to <= near, right = right || to >= -near;
                    below = below || b.y < a.y;
                }
                CHECK(left);
                CHECK(right);
                CHECK(below);
            }
        }
    }
}

TEST_CASE("no place is lower than the one that a deposited disk takes") {
    RandomDisks pack = pack_of(80, false, false, 0);
    pack.box = {0, 0.3, 0, 2};
    const auto grains = random_disks(pack);
    const auto is_free = [&](std::size_t count, double x, double y, double r) {
        const double near = 1e-10;
        bool free = x > r - near && x < 0.3 - r + near && y > r - near;
        for (std::size_t m = 0; m < count && free; ++m)
            free = std::hypot(x - grains[m].outline.x, y - grains[m].outline.y) >
                   r + grains[m].outline.radius - near;
        return free;
    };
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Outline& taken = grains[k].outline;
        const double r = taken.radius;
        double lowest = 1e9;
        const auto consider = [&](double x, double y) {
            if (y < lowest && is_free(k, x, y, r)) lowest = y;
        };
        consider(r, r), consider(0.3 - r, r);
        for (std::size_t m = 0; m < k; ++m) {
            // The circle of places on one disk meets the floor, the walls and those on the others.
            const Outline& a = grains[m].outline;
            const double reach = a.radius + r;
            for (const double side : {-1.0, 1.0}) {
                const double x = side < 0 ? r : 0.3 - r;
                const double along_floor = reach * reach - (a.y - r) * (a.y - r),
                             up_wall = reach * reach - (x - a.x) * (x - a.x);
                if (along_floor >= 0) consider(a.x + side * std::sqrt(along_floor), r);
                if ((x - a.x) * side >= 0 && up_wall >= 0) consider(x, a.y + std::sqrt(up_wall));
                for (std::size_t n = 0; n < m; ++n) {
                    const Outline& b = grains[n].outline;
                    const double apart = std::hypot(b.x - a.x, b.y - a.y), other = b.radius + r,
                                 along = (apart + (reach * reach - other * other) / apart) / 2,
                                 up =
                                     side * std::sqrt(std::max(0.0, reach * reach - along * along)),
                                 c = (b.x - a.x) / apart, s = (b.y - a.y) / apart,
                                 at_x = a.x + along * c - up * s, at_y = a.y + along * s + up * c;
                    if (up * c > 0 && (at_x - a.x) * (b.x - at_x) >= 0) consider(at_x, at_y);
                }
            }
        }
        CHECK(taken.y == about(lowest).epsilon(1e-9));
    }
}

TEST_CASE("a deposited pack is dense") {
    for (const bool periodic : {false, true}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            RandomDisks pack = pack_of(0, periodic, false, 0);
            pack.box.y_high = 3, pack.seed = seed;
            const auto grains = random_disks(pack);
            double total = 0;
            for (const PackedGrain& grain : grains) total += area(grain.outline);
            CHECK(total > 0.78);
            CHECK(total < 0.9069);
        }
    }
    // Equal disks in a box of whole diameters stand in hexagonal order.
    RandomDisks equal = pack_of(18, false, false, 0);
    equal.box = {0, 1, 0, 0.72}, equal.radius_min = equal.radius_max = 0.1;
    Rows rows;
    rows.x = rows.y = rows.radius = rows.shift = 0.1;
    rows.columns = 5, rows.rows = 4, rows.one_less = true;
    const auto crystal = hexagonal_rows(rows);
    for (const PackedGrain& grain : random_disks(equal))
        CHECK(std::any_of(crystal.begin(), crystal.end(), [&](const PackedGrain& place) {
            return distance(grain.outline, place.outline, 0) < 1e-9;
        }));
}

TEST_CASE("a random pack depends on its seed and not on its place") {
    for (const bool loose : {false, true}) {
        RandomDisks pack = pack_of(300, true, loose, 0);
        const auto first = random_disks(pack), second = random_disks(pack);
        pack.box.x_low += 4, pack.box.x_high += 4, pack.box.y_low -= 2, pack.box.y_high -= 2;
        const auto elsewhere = random_disks(pack);
        pack.seed = 2;
        const auto other = random_disks(pack);
        int same = 0;
        for (std::size_t k = 0; k < first.size(); ++k) {
            CHECK(first[k].outline.x == second[k].outline.x);
            CHECK(first[k].outline.y == second[k].outline.y);
            CHECK(first[k].outline.radius == elsewhere[k].outline.radius);
            CHECK(elsewhere[k].outline.x - 4 == about(first[k].outline.x).epsilon(1e-9));
            same += elsewhere[k].outline.radius == other[k].outline.radius ||
                    elsewhere[k].outline.x == other[k].outline.x;
        }
        CHECK(same == 0);
        CHECK(first[0].name == "g0001");
        CHECK(first[299].name == "g0300");
    }
}

TEST_CASE("in another unit of length a random pack is the same") {
    for (const bool periodic : {false, true}) {
        for (const bool loose : {false, true}) {
            RandomDisks pack = pack_of(300, periodic, loose, 0);
            const auto grains = random_disks(pack);
            const double unit = 64;  // a power of two changes no digit
            for (double* length : {&pack.box.x_low, &pack.box.x_high, &pack.box.y_low,
                                   &pack.box.y_high, &pack.radius_min, &pack.radius_max})
                *length *= unit;
            const auto scaled = random_disks(pack);
            REQUIRE(scaled.size() == grains.size());
            double most = 0;
            for (std::size_t k = 0; k < grains.size(); ++k) {
                const Outline &a = grains[k].outline, &b = scaled[k].outline;
                most = worst({most, std::fabs(b.x / unit - a.x), std::fabs(b.y / unit - a.y),
                              std::fabs(b.radius / unit - a.radius)});
            }
            CHECK(most <= 1e-9);
        }
    }
}

TEST_CASE("radii are drawn evenly between the least and the largest") {
    RandomDisks pack = pack_of(4000, false, false, 0);
    pack.box = {0, 4, 0, 4};
    std::vector<double> part;
    for (const PackedGrain& grain : random_disks(pack))
        part.push_back((grain.outline.radius - 0.01) / 0.015);
    std::sort(part.begin(), part.end());
    CHECK(std::adjacent_find(part.begin(), part.end()) == part.end());
    double largest = 0;
    for (std::size_t k = 0; k < part.size(); ++k)
        largest = worst({largest, std::fabs(part[k] - real(static_cast<long>(k)) / 4000)});
    CHECK(largest < 1.63 / std::sqrt(4000.0));  // passed by 99 of 100 even samples
}

TEST_CASE("a random pack that cannot be is refused with its numbers") {
    const facts::Untrapped calm;
    const RandomDisks good = pack_of(10, false, false, 0);
    const auto says = [&](const std::function<void(RandomDisks&)>& spoil) {
        RandomDisks pack = good;
        spoil(pack);
        return refusal([&] { random_disks(pack); });
    };
    CHECK(says([](RandomDisks&) {}).empty());
    CHECK(holds(says([](RandomDisks& p) { p.box.x_high = -1; }), "the width of a pack = -0.7"));
    CHECK(holds(says([](RandomDisks& p) { p.box.y_high = 2; }), "the height of a pack = 0"));
    CHECK(holds(says([](RandomDisks& p) { p.radius_min = 0; }), "the least radius of a pack = 0"));
    CHECK(holds(says([](RandomDisks& p) { p.radius_max = 0.005; }),
                "the largest radius of a pack, 0.005, must be 1 to 100 times the least, 0.01"));
    CHECK(holds(says([](RandomDisks& p) { p.radius_max = std::nan(""); }), "the largest radius"));
    CHECK(holds(says([](RandomDisks& p) { p.gap = -0.1; }), "the gap of a pack is -0.1"));
    CHECK(holds(says([](RandomDisks& p) { p.gap = 1; }),
                "a box of 1 by 2 is too small for disks 1.05 wide"));
    CHECK(
        holds(says([](RandomDisks& p) { p.periodic_x = true, p.gap = 0.16; }), "5 times as wide"));
    // Just as high as the largest disk, up to round-off.
    CHECK(says([](RandomDisks& p) { p.count = 1, p.box.y_high = 2.05; }).empty());
    CHECK(holds(says([](RandomDisks& p) { p.count = -1; }), "a pack of -1 disks"));
    CHECK(holds(says([](RandomDisks& p) { p.count = 0, p.loose = true; }), "give at least one"));
    CHECK(holds(says([](RandomDisks& p) { p.count = 2000000; }), "a pack of up to 2e+06 disks"));
    CHECK(holds(says([](RandomDisks& p) { p.count = 0, p.radius_min = p.radius_max = 1e-4; }),
                "for at most 1e6"));
    CHECK(holds(says([](RandomDisks& p) { p.count = 5000; }), "the box is full with 1"));
    CHECK(holds(says([](RandomDisks& p) { p.count = 5000; }), "and a solid fraction of 0.8"));
    CHECK(holds(says([](RandomDisks& p) { p.count = 5000, p.loose = true; }),
                "the box is full with"));
}

TEST_CASE("polygons stand in the circles of their disks and are turned at random") {
    const auto disks = random_disks(pack_of(300, false, false, 0));
    for (const long sides : {3L, 5L, 8L}) {
        const auto grains = regular_polygons(disks, sides, 5);
        REQUIRE(grains.size() == disks.size());
        std::set<double> angles;
        for (std::size_t k = 0; k < grains.size(); ++k) {
            const Outline &round = disks[k].outline, &outline = grains[k].outline;
            CHECK(grains[k].name == disks[k].name);
            CHECK(static_cast<long>(outline.corners.size()) == sides);
            for (const Point& p : outline.corners)
                CHECK(std::hypot(p.x - round.x, p.y - round.y) ==
                      about(round.radius).epsilon(1e-12));
            angles.insert(
                std::atan2(outline.corners[0].y - round.y, outline.corners[0].x - round.x));
        }
        CHECK(angles.size() == disks.size());
        CHECK(*angles.begin() < -3);
        CHECK(*angles.rbegin() > 3);
        CHECK(overlaps(grains, 0, 0).depth == 0);
    }
}

TEST_CASE("the deepest overlap of a pack is that of all pairs") {
    for (const double period : {0.0, 3.0}) {
        for (std::uint64_t seed = 0; seed < 40; ++seed) {
            std::vector<PackedGrain> grains;
            for (std::uint64_t k = 0; k < 12; ++k) {
                const std::uint64_t n = 100 * seed + k;
                grains.push_back(
                    {std::string("n").append(std::to_string(k)),
                     moved(any_outline(n), any_number(n, 9, -9, 9), any_number(n, 10, 0, 4))});
            }
            // A plate among them reaches over many cells.
            grains.push_back({"plate", box(0, 6.6, 2.9, 0.2)});
            Overlap all;
            for (std::size_t a = 0; a < grains.size(); ++a)
                for (std::size_t b = a + 1; b < grains.size(); ++b)
                    for (int image = -8; image <= 8; ++image) {
                        const double depth = overlap_depth(
                            grains[a].outline, moved(grains[b].outline, image * period, 0));
                        if (depth > all.depth * (1 + 1e-12) + 1e-12)
                            all = {grains[a].name, grains[b].name, depth};
                    }
            const Overlap found = overlaps(grains, period, 0);
            CHECK(std::fabs(found.depth - all.depth) <= 1e-10 * all.depth);
            CHECK(found.first == all.first);
            CHECK(found.second == all.second);
            CHECK(overlaps(grains, period, all.depth * 1.0001).first.empty());
        }
    }
    CHECK(overlaps({}, 1, 0).depth == 0);
    // Of several that overlap alike the first, and a grain may be longer than the period.
    std::vector<PackedGrain> alike;
    for (const double x : {6.0, 2.0, 0.0, 4.0})
        alike.push_back({"at" + std::to_string(static_cast<int>(x)), disk(x, 0, 1.25)});
    CHECK(overlaps(alike, 0, 0).depth == 0.5);
    CHECK(overlaps(alike, 0, 0).first == "at6");
    CHECK(overlaps(alike, 0, 0).second == "at4");
    CHECK(overlaps({{"long", box(0.3, 0, 1.25, 1)}}, 1, 0).first == "long");
    CHECK(overlaps({{"long", box(0.3, 0, 1.25, 1)}}, 1, 0).depth == about(0.25));
    CHECK(overlaps({{"fits", box(0.3, 0, 1, 1)}}, 1, 0).depth == 0);
}

TEST_CASE("a pack that is written and read and written again gives the same bytes") {
    std::vector<PackedGrain> grains =
        regular_polygons(random_disks(pack_of(100, true, false, 0)), 5, 3);
    for (PackedGrain& grain : random_disks(pack_of(100, true, true, 0)))
        grains.push_back({"loose_" + grain.name, grain.outline});
    grains.push_back({"third", disk(1.0 / 3, -1e-30, 1e20 / 3)});
    grains.push_back({"L", letter_L(0.1, -0.2)});
    grains.push_back({"largest", regular_polygon(1 / 3.0, 1e-7, 1 / 7.0, 1000, 1)});
    const std::string first = folder() / "first.txt", second = folder() / "second.txt";
    write_pack(first, grains);
    const auto again = read_pack(first);
    write_pack(second, again);
    CHECK(bytes_of(first) == bytes_of(second));
    REQUIRE(again.size() == grains.size());
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Outline &a = grains[k].outline, &b = again[k].outline;
        CHECK(grains[k].name == again[k].name);
        CHECK(a.kind == b.kind);
        if (a.kind == OutlineKind::disk) CHECK((a.x == b.x && a.y == b.y && a.radius == b.radius));
        REQUIRE(a.corners.size() == b.corners.size());
        for (std::size_t c = 0; c < a.corners.size(); ++c)
            CHECK((a.corners[c].x == b.corners[c].x && a.corners[c].y == b.corners[c].y));
    }
}

namespace {

std::string written(const std::string& bytes) {
    std::string path = folder() / "pack.txt";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

}  // namespace

TEST_CASE("a pack written by a person is read as it is meant") {
    const auto grains =
        read_pack(written("\xEF\xBB\xBF# two grains, \xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80\r\n\r\n"
                          "  disk\tleft  .5 -3e-1   0.25 # the first\r\n"
                          "\t \r\n"
                          "polygon 2nd 0 0  0 1  1 0#clockwise"));
    REQUIRE(grains.size() == 2);
    CHECK(grains[0].name == "left");
    CHECK(grains[0].outline.x == 0.5);
    CHECK(grains[0].outline.y == -0.3);
    CHECK(grains[0].outline.radius == 0.25);
    CHECK(grains[1].name == "2nd");
    CHECK(area(grains[1].outline) == about(0.5));
    CHECK(grains[1].outline.corners[1].x == 1);
}

TEST_CASE("a file that is no pack is refused with its line and the cure") {
    using namespace std::string_literals;
    const std::string good = "disk a 0 0 1\n", long_word(200, 'x');
    struct Row {
        std::string bytes, message;
    };
    for (const Row& row : std::vector<Row>{
             {"", "pack.txt: holds no grain; write lines like: disk left 0.35 0.3 0.2"},
             {"# only a comment\n\n", "pack.txt: holds no grain"},
             {good + "circle b 0 0 1\n",
              "pack.txt:2: unknown word 'circle'; a line begins with disk or polygon"},
             {"\n\nDisk b 0 0 1\n", "pack.txt:3: unknown word 'Disk'"},
             {long_word + " b\n", "unknown word '" + std::string(40, 'x') + "...'"},
             {"disk\n", "pack.txt:1: a disk without a name; write its name and its numbers"},
             {"disk 0.1 0.2 0.3\n", "pack.txt:1: '0.1' cannot name a grain"},
             {"disk a-b 0 0 1\n",
              "'a-b' cannot name a grain: use letters, digits and '_', 40 at most"},
             {"disk \xC3\xA9 0 0 1\n", "cannot name a grain"},
             {"disk " + long_word + " 0 0 1\n", "cannot name a grain"},
             {"disk a 0 0\n", "pack.txt:1: a disk takes 3 numbers, x y radius, not 2"},
             {"disk a 0 0 1 2\n", "a disk takes 3 numbers, x y radius, not 4"},
             {"disk a 0 0 1 m\n", "pack.txt:1: 'm' is not a number"},
             {"disk a 0 0 1m\n", "'1m' is not a number: write one like 0.25 or 1e-3"},
             {"disk a 0,5 0 1\n", "'0,5' is not a number"},
             {"disk a 0 0 0x1\n", "'0x1' is not a number"},
             {"disk a 0 nan 1\n", "'nan' is no number to compute with: give a finite one"},
             {"disk a 0 0 inf\n", "'inf' is no number to compute with"},
             {"disk a 0 0 1e999\n", "'1e999' is no number to compute with"},
             {"disk a 0 0 1e300\n", "'1e300' is no number to compute with"},
             {"disk a 0 0 -1\n",
              "pack.txt:1: 'a': the radius of a disk = -1 must be a length above 0: give one"},
             {"disk a 0 0 0\n", "the radius of a disk = 0 must be"},
             {"polygon p 0 0 1 0 1\n",
              "pack.txt:1: a polygon takes two numbers, x y, for each of 3 or more corners, not 5 "
              "numbers"},
             {"polygon p 0 0 1 0\n", "not 4 numbers"},
             {"polygon p 0 0 1 1 1 0 0 1\n",
              "pack.txt:1: 'p': the side from corner 1 to 2 of a polygon meets the side from "
              "corner 3 to 4"},
             {good + "polygon p 0 0 1 1 2 2\n", "pack.txt:2: 'p': the 3 corners of a polygon lie"},
             {good + "\n# more\ndisk a 3 3 1\n",
              "pack.txt:4: the name 'a' is that of line 1 too: give each grain its own"},
             {good + "# \xff\n", "pack.txt:2: not UTF-8 text; save the file as UTF-8"},
             {"# \xC0\xAF\n", "not UTF-8 text"},
             {"# \xBF\xBF\n", "not UTF-8 text"},
             {"# \xE0\x80\xAF\n", "not UTF-8 text"},
             {"# \xED\xA0\x80\n", "not UTF-8 text"},
             {"# \xF4\x90\x80\x80\n", "not UTF-8 text"},
             {"# \xE2\x82", "not UTF-8 text"},
             {"disk a 0 0 1\0\n"s,
              "pack.txt:1: a control character; this is not a text file, or it is damaged"},
             {"disk a 0 0 1 # \x1b[31m\n", "pack.txt:1: a control character"},
             {"disk a 0\r0 1\n", "pack.txt:1: a control character"},
             {"# \x7f\n", "pack.txt:1: a control character"},
             {good + "#" + std::string(100000, ' ') + "\n",
              "pack.txt:2: the line has more than 100000 letters; this is another kind of file"},
         }) {
        CAPTURE(row.bytes.substr(0, 60));
        const std::string sentence = refusal([&] { read_pack(written(row.bytes)); });
        CAPTURE(sentence);
        CHECK(holds(sentence, row.message));
        CHECK(sentence.find('\n') == std::string::npos);
    }
    CHECK(holds(refusal([] { read_pack(folder() / "nowhere.txt"); }), "there is no such file"));
    CHECK(holds(refusal([] { read_pack(folder()); }), "is a folder"));
}

TEST_CASE("a pack that could not be read again is not written") {
    const std::string path = folder() / "never.txt";
    const Outline round = disk(0, 0, 1);
    CHECK(holds(refusal([&] { write_pack(path, {}); }), "no grain to write"));
    CHECK(holds(refusal([&] { write_pack(path, {{"a b", round}}); }), "cannot name a grain"));
    CHECK(holds(refusal([&] { write_pack(path, {{"", round}}); }), "cannot name a grain"));
    CHECK(holds(refusal([&] {
                    write_pack(path, {{"a", round}, {"b", round}, {"a", round}});
                }),
                "two grains have the name 'a'"));
    CHECK(holds(refusal([&] {
                    write_pack(folder() / "no/such/folder.txt", {{"a", round}});
                }),
                "cannot be opened for writing"));
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a free text is read and shown as it stands") {
    Texts values;
    const auto table_of = [&] {
        ParameterTable table;
        table.text("pack.file", values.path, "a pack of grains");
        table.choice("pack.kind", values.kind, {"one", "two"}, "which");
        return table;
    };
    ParameterTable table = table_of();
    CHECK(holds(table.help(), "text; default \"none\""));
    CHECK(holds(table.help(), "one | two; default \"one\""));
    CHECK(table.takes_text("pack.file") == true);
    CHECK(table.takes_text("pack.kind") == true);
    const std::string longest(900, '\\');
    for (const std::string text :
         {"", "a pack.txt", "say \"so\"", "C:\\packs\\new", "# no comment", "it's", "{x = [1,",
          "caf\xC3\xA9 \xF0\x9F\x98\x80", longest.c_str()}) {
        table.set({"pack.file", text, "here"});
        CHECK(values.path == text);
        const std::string effective = table.effective_case();
        values.path = "other";
        for (const common::Setting& setting : common::read_case(effective, "effective.toml"))
            table.set(setting);
        CHECK(values.path == text);
        CHECK(table.effective_case() == effective);
    }
    const auto says = [&](const std::string& line) {
        return refusal([&] {
            for (const common::Setting& setting : common::read_case(line, "case.toml"))
                table.set(setting);
        });
    };
    CHECK(says("pack.file = 3") == "case.toml:1:13: 'pack.file' takes text, not a whole number");
    CHECK(says("pack.file = true") == "case.toml:1:13: 'pack.file' takes text, not true or false");
    CHECK(holds(says("pack.kind = 3"), "'pack.kind' takes text, one of \"one\", \"two\""));
    CHECK(holds(says("pack.kind = \"three\""), "= \"three\" is not one of \"one\", \"two\""));
    CHECK(holds(says("pack.file = \"\\u007F\""), "holds a control character; write plain text"));
    CHECK(holds(says("pack.file = \"" + std::string(901, 'x') + "\""),
                "'pack.file' has 901 letters; write at most 900"));
}

TEST_CASE("items of a list may have free texts and be as many as 256") {
    std::vector<Texts> items;
    ParameterTable table;
    table.list<Texts>(
        "grain", items,
        [](ParameterTable& t, const std::string& prefix, Texts& item) {
            t.text(prefix + ".path", item.path, "a file");
        },
        "grains");
    CHECK(table.takes_text("grain.new.path") == true);
    for (int k = 0; k < 256; ++k)
        table.set({"grain.g" + std::to_string(k) + ".path", "file " + std::to_string(k), "here"});
    REQUIRE(items.size() == 256);
    CHECK(items[255].path == "file 255");
    CHECK(holds(refusal([&] {
                    table.set({"grain.more.path", "one more", "here"});
                }),
                "more than 256 items in [grain]"));
}
