// Waves that grow at the interface of two fluids and in a shear layer, at small amplitude; where nothing
// else is said, far below the speed of sound.
//
// z points up and gravity down. Waves vary like exp(i k x - i omega t): Im omega is a growth rate.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace flip::theory {

/// Fluid 1 below z = 0, fluid 2 above it, between rigid walls at z = -lower_depth and upper_depth.
struct TwoLayers {
    double lower_density, upper_density;
    double gravity = 0.0;
    double lower_velocity = 0.0, upper_velocity = 0.0;  // along x
    double lower_depth = std::numeric_limits<double>::infinity();
    double upper_depth = std::numeric_limits<double>::infinity();
};

/// The frequency of waves at the interface.
///   (a_1 + a_2) omega = k (a_1 U_1 + a_2 U_2)
///                       +- [(a_1 + a_2) g k (rho_1 - rho_2) - a_1 a_2 k^2 (U_2 - U_1)^2]^1/2
/// with a = rho coth k H, from the pressure on both sides of z = eta:
///   a_1 (omega - k U_1)^2 + a_2 (omega - k U_2)^2 = g k (rho_1 - rho_2)
/// in:    k > 0
/// out:   the root that grows, or the larger of two real roots
/// exact: Im omega = (A g k)^1/2, A = (rho_2 - rho_1) / (rho_2 + rho_1), for heavy fluid at rest
///        on top of light fluid, both deep (Rayleigh and Taylor); k |U_2 - U_1| / 2 for equal
///        densities (Helmholtz and Kelvin)
/// source: Lamb, Hydrodynamics, articles 231 and 232.
inline std::complex<double> interface_frequency(const TwoLayers& s, double k) {
    const double a_1 = s.lower_density / std::tanh(k * s.lower_depth);
    const double a_2 = s.upper_density / std::tanh(k * s.upper_depth), a = a_1 + a_2;
    const double shear = k * (s.upper_velocity - s.lower_velocity);
    const double weight = s.gravity * k * (s.lower_density - s.upper_density);
    const std::complex<double> square = (weight - a_1 * a_2 / a * shear * shear) / a;
    return k * (a_1 * s.lower_velocity + a_2 * s.upper_velocity) / a + std::sqrt(square);
}

/// The growth rate of waves at the interface; zero where they do not grow.
inline double interface_growth(const TwoLayers& s, double k) {
    return interface_frequency(s, k).imag();
}

/// What the steps of flip make of a wave of the frequency omega.
///   v^1 = v^0 - dt omega^2 eta^0,  eta^1 = eta^0 + dt [(1 - theta) v^0 + theta v^1]
/// exact: in the limit of fine meshes and small waves; theta = 1, explicit steps too, is neutral
struct SwingingStep {
    double phase, amplification;
};
inline SwingingStep swinging_step(double omega, double theta, double dt) {
    const double a2 = omega * omega * dt * dt, growth = std::sqrt(1 + (1 - theta) * a2);
    return {std::acos(std::clamp((1 - 0.5 * theta * a2) / growth, -1.0, 1.0)), growth};
}

/// The growth rate of an interface between rows of cells as the mesh of flip has it, or its frequency
/// where the heavy fluid is below; in short steps and far below the speed of sound. Nodes have the
/// velocities u sin k x and w cos k x, cells keep their volume, and the particles are as sharp as the
/// interface.
///   D a = 0,  a = R (f - D^T p),  rate^2 = f . a,  f = |g (rho_2 - rho_1) mu|^1/2 at its nodes
///   R = M^-1 of consistent masses; M_L^-1 M M_L^-1 of lumped ones, as an increment of velocity goes to
///   the particles and comes back smoothed;  mu = (2 + cos k dx)/3, the part of M along x
/// in:    k dx < pi; finite depths of whole cells
/// exact: |interface_frequency()| for dx, dz -> 0, of first order, as u cannot jump at the interface
double interface_rate_on_mesh(const TwoLayers& s, double k, double dx, double dz, bool consistent);

/// rho c^2 = gamma (p + p_infinity) of a layer at the interface; it falls with the pressure above.
struct LayerStiffness {
    double at_interface, gamma;
};

/// The growth rate of waves at the interface of layers that sound crosses in some time: each has one
/// density and the pressure of its weight, and would overturn by itself, as N^2 = -g^2/c^2.
/// With the displacement xi along z and the pressure q of the displaced fluid less that at rest,
///   sigma^2 rho xi = -dp'/dz - g rho',  p' = q + rho g xi,  c^2 rho' = q,
///   rho' = -rho (dxi/dz + k^2 p'/(rho sigma^2))
/// become, both continuous at the interface and xi = 0 at the walls,
///   dxi/dz = -a xi - b q,  dq/dz = d xi + a q
///   a = g k^2/sigma^2,  b = 1/(rho c^2) + k^2/(rho sigma^2),  d = rho (a g - sigma^2)
/// The fastest wave has no node between the walls; from the lower wall upward, xi of a slower sigma
/// comes to one, and that of a faster one to none.
/// in:    k > 0; heavy fluid at rest above, between walls; pressure + p_infinity above 0 everywhere
/// exact: interface_growth() for rho c^2 -> infinity, and never below it, as fluid that is free to
///        change its volume finds what does not change it, too
inline double compressible_interface_growth(const TwoLayers& s, const LayerStiffness& lower,
                                            const LayerStiffness& upper, double k) {
    const auto has_node = [&](double sigma) {
        double xi = 0, q = -1;
        const auto cross = [&](double rho, const LayerStiffness& layer, double from, double to) {
            const double a = s.gravity * k * k / (sigma * sigma),
                         d = rho * (a * s.gravity - sigma * sigma);
            const auto slope = [&](double z, const Eigen::Vector2d& y) -> Eigen::Vector2d {
                const double rho_c2 = layer.at_interface - layer.gamma * rho * s.gravity * z,
                             b = 1 / rho_c2 + k * k / (rho * sigma * sigma);
                return {-a * y[0] - b * y[1], d * y[0] + a * y[1]};
            };
            const int steps = 100 + int(20 * k * (to - from));
            const double h = (to - from) / steps;
            Eigen::Vector2d y(xi, q);
            for (int n = 0; n < steps; ++n) {
                const double z = from + n * h;
                const Eigen::Vector2d k1 = slope(z, y), k2 = slope(z + 0.5 * h, y + 0.5 * h * k1),
                                      k3 = slope(z + 0.5 * h, y + 0.5 * h * k2),
                                      k4 = slope(z + h, y + h * k3);
                y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
                if (!(y[0] > 0)) return true;
                y /= y.norm();
            }
            xi = y[0], q = y[1];
            return false;
        };
        return cross(s.lower_density, lower, -s.lower_depth, 0) ||
               cross(s.upper_density, upper, 0, s.upper_depth);
    };
    double low = interface_growth(s, k), high = 1.1 * low;
    while (has_node(high)) low = high, high *= 1.1;
    for (int n = 0; n < 50; ++n) {
        const double middle = 0.5 * (low + high);
        (has_node(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// A fluid of one density with U(z) = velocity_difference / 2 times z / half_width, clamped to
/// +-1, between rigid walls at z = +-wall_distance.
struct ShearLayer {
    double velocity_difference, half_width;  // U(d) - U(-d), and d
    double wall_distance = std::numeric_limits<double>::infinity();
};

namespace instabilities_detail {

/// Green's function of -d^2/dz^2 + k^2 between rigid walls at z = +-b.
///   sinh k (b - z_high) sinh k (b + z_low) / (k sinh 2 k b)
inline double green(double k, double b, double z, double from) {
    const double high = std::max(z, from), low = std::min(z, from);
    const double decay = std::exp(-k * (high - low)) / (2.0 * k);
    if (std::isinf(b)) return decay;
    return decay * std::expm1(-2.0 * k * (b - high)) * std::expm1(-2.0 * k * (b + low)) /
           -std::expm1(-4.0 * k * b);
}

}  // namespace instabilities_detail

/// The frequency of waves in a shear layer.
/// By (U - c) (psi'' - k^2 psi) = U'' psi vorticity is disturbed at the two kinks of U only. With
/// S = velocity_difference / 2 d and Green's function G of walls, psi = A G(z, d) + B G(z, -d):
///   A (S d - S G_same - c) = S G_other B
///   B (S d - S G_same + c) = S G_other A
///   (omega / k)^2 = c^2 = S^2 [(d - G_same)^2 - G_other^2]
/// in:    k > 0
/// out:   the root that grows, or the positive one of two real roots; the other is -omega
/// exact: without walls omega^2 = (S / 2)^2 [(1 - 2 k d)^2 - exp(-4 k d)], which grows for
///        k d < 0.6392 and becomes k velocity_difference / 2 for k d -> 0
/// source: Rayleigh, Proc. London Math. Soc. 11, 57 (1880).
inline std::complex<double> shear_layer_frequency(const ShearLayer& s, double k) {
    using instabilities_detail::green;
    const double d = s.half_width, b = s.wall_distance, S = 0.5 * s.velocity_difference / d;
    const double same = green(k, b, d, d), other = green(k, b, d, -d);
    const double square = (d - same - other) * (d - same + other);
    return std::abs(S) * k * std::sqrt(std::complex<double>(square));
}

/// The growth rate of waves in a shear layer; zero where they do not grow.
inline double shear_layer_growth(const ShearLayer& s, double k) {
    return shear_layer_frequency(s, k).imag();
}

}  // namespace flip::theory
