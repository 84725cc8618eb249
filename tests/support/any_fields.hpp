// What several tests need: random numbers, fields made of them, and the points of a mesh.
#pragma once

#include <cmath>
#include <random>
#include <utility>

#include "implicit_moment/field/vector_field.hpp"
#include "tests/support/any_numbers.hpp"

namespace facts {

using namespace implicit_moment;

/// The largest entry in size; not a number where one of them is not.
inline double largest(const Eigen::VectorXd& v) {
    double size = 0;
    for (const double value : v) size = worst({size, std::fabs(value)});
    return size;
}

/// Numbers between -1 and 1, and fields of them with ghosts filled.
struct Random {
    std::mt19937_64 engine{1};
    double operator()() { return 0x1p-52 * double(engine() >> 11) - 1; }
    Eigen::Vector3d vector() {
        const double x = (*this)(), y = (*this)();
        return {x, y, (*this)()};
    }
    Field field(const Grid& grid) {
        return Field::NullaryExpr(grid.size(), [this] { return (*this)(); });
    }
    Field field(const Grid& grid, Place place, Parity parity) {
        Field f = field(grid);
        common::fill_ghosts(grid, place, parity, f.data());
        return f;
    }
    VectorField field(const Grid& grid, const VectorKind& kind, double amplitude = 1) {
        VectorField f(grid);
        for (double& value : f.all) value = amplitude * (*this)();
        fill_ghosts(grid, kind, f);
        return f;
    }
};

/// E with a potential in the place of E_y, for both live on nodes and vanish on walls, and its
/// gradient in the plane, E = -grad E_y; and B that is a curl.
inline std::pair<VectorField, VectorField> gradient_and_curl(const Grid& grid, Random& random) {
    VectorField E = random.field(grid, electric, 1), B(grid);
    const VectorField A = random.field(grid, electric, 1);
    for_each_point(grid, [&](long n) {
        E.x()[n] = -(E.y()[n + 1] - E.y()[n]) / grid.x.spacing();
        E.z()[n] = -(E.y()[n + grid.stride()] - E.y()[n]) / grid.z.spacing();
    });
    curl_of_electric(grid, A.all.data(), B.all.data());
    fill_ghosts(grid, electric, E);
    fill_ghosts(grid, magnetic, B);
    return {E, B};
}

/// Distinct points along one direction; a node on a wall has half a cell inside the mesh.
inline long points(const common::Axis& axis, bool half) {
    return axis.cells + !(axis.periodic || half);
}
inline double weight(const common::Axis& axis, bool half, long i) {
    return !axis.periodic && !half && i % axis.cells == 0 ? 0.5 : 1;
}
template <class Visit>
void for_each_distinct(const Grid& grid, Place place, const Visit& visit) {
    for (long j = 0; j < points(grid.z, place.half_z); ++j) {
        for (long i = 0; i < points(grid.x, place.half_x); ++i) visit(i, j, grid.index(i, j));
    }
}

}  // namespace facts
