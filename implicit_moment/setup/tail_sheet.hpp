// The tail: a current sheet with a field across it, in the plane of the mesh, and an exact equilibrium.
//
// Particles whose distribution depends on their energy and canonical momentum alone stay as they are in
// any A_y(x, z). Of the Harris sheet's drifting Maxwellians is left n = n0 exp(2 A_y/(B0 L)) with uniform
// temperatures and drifts, whose pressure balances the force for any A_y; and the law of Ampere,
//
//     lap A_y = -(B0/L) exp(2 A_y/(B0 L)),
//
// which an analytic f(zeta), zeta = (x + i z)/L, turns into a solution wherever f' is not 0:
//
//     A_y = -B0 L ln [ cosh(Im f) / |f'| ]
//
// f = zeta is Harris's sheet. With f = exp(epsilon zeta)/epsilon, where h = Im f,
//
//     A_y = -B0 L ln [ cosh(h)/F(x) ],   h = F(x) sin(epsilon z/L)/epsilon,   F = exp(epsilon x/L)
//     n   = n0 F^2/cosh^2(h),            B_z(x, 0) = epsilon B0
//
// Near the middle h = F z/L: there it is the slowly varying sheet of Lembege and Pellat, which has h = F z/L
// everywhere and misses the law of Ampere by epsilon^2.
//
// source: B. Lembege and R. Pellat, Phys. Fluids 25, 1995 (1982); the solution by f is Walker's of 1915,
//         see P. H. Yoon and A. T. Y. Lui, J. Geophys. Res. 110, A01202 (2005).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/grid.hpp"
#include "implicit_moment/setup/case.hpp"

namespace implicit_moment {

/// ln cosh(u), also where cosh(u) is no number any more.
inline double log_cosh(double u) {
    return std::fabs(u) < 300 ? std::log(std::cosh(u)) : std::fabs(u) - std::numbers::ln2;
}

/// The tail around the middle of the box, where F = 1; epsilon = 0 is Harris's sheet.
struct TailSheet {
    double L = 1;        // half-thickness where F = 1 [d_i]
    double epsilon = 0;  // B_z/B0 in the middle row

    double F(double x) const { return std::exp(epsilon * x / L); }
    double height(double x, double z) const {
        return epsilon == 0 ? z / L : F(x) * std::sin(epsilon * z / L) / epsilon;
    }
    /// A_y / (B0 L). in: x and z from the middle of the box [d_i]
    double A_y(double x, double z) const { return epsilon * x / L - log_cosh(height(x, z)); }
    /// n/n0 of what drifts.
    double density(double x, double z) const { return std::pow(F(x) / std::cosh(height(x, z)), 2); }
    /// The integral of n/n0 over z from 0 to where tanh(h) = t.
    ///     L F int_0^t dt' / (1 - (epsilon artanh(t')/F)^2)^(1/2)
    double content(double x, double t) const {
        static constexpr std::array<double, 4> place{0.1834346424956498, 0.5255324099163290,
                                                     0.7966664774136267, 0.9602898564975363},
            weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
        double sum = 0;
        for (std::size_t k = 0; k < place.size(); ++k)
            for (const double side : {-1.0, 1.0})
                sum += 0.5 * weight[k] * slope(x, 0.5 * t * (1 + side * place[k]));
        return L * F(x) * t * sum;
    }
    /// (1 - (epsilon artanh(t)/F)^2)^(-1/2) = 1/cos(epsilon z/L).
    double slope(double x, double t) const {
        return 1 / std::sqrt(1 - std::pow(epsilon * std::atanh(t) / F(x), 2));
    }
};

/// The tail of a case.
inline TailSheet tail_of(const HarrisCase& h) { return {h.thickness, h.normal_field}; }

/// Finds places that are spread as the tail's density is in a box.
class TailPlaces {
   public:
    TailPlaces(const TailSheet& tail, const Grid& grid) : tail_(tail), grid_(grid) {
        for (long k = 0; k < pieces; ++k) {
            const double x = piece() * (double(k) + 0.5) - 0.5 * grid.x.length;
            below_.push_back(below_.back() + 2 * piece() * tail.content(x, highest(x)));
        }
    }
    /// The integral of n/n0 over the box [d_i^2].
    double content() const { return below_.back(); }
    /// in: two numbers between 0 and 1. out: x and z from the middle of the box
    std::array<double, 2> place(double u_x, double u_z) const {
        const double wanted = u_x * content();
        const auto next = std::upper_bound(below_.begin() + 1, below_.end() - 1, wanted);
        const double x = piece() * (double(next - below_.begin() - 1) +
                                    (wanted - *(next - 1)) / (*next - *(next - 1))) -
                         0.5 * grid_.x.length;
        const double part = 2 * u_z - 1, most = highest(x),
                     in_z = std::fabs(part) * tail_.content(x, most);
        double t = std::fabs(part) * most;
        for (int k = 0; k < 4; ++k)
            t = std::clamp(
                t + (in_z - tail_.content(x, t)) / (tail_.L * tail_.F(x) * tail_.slope(x, t)), 0.0,
                most);
        const double angle = tail_.epsilon * std::atanh(t) / tail_.F(x);
        return {x, std::copysign(tail_.L * std::asin(angle) / tail_.epsilon, part)};
    }

   private:
    static constexpr long pieces = 4096;
    double piece() const { return grid_.x.length / double(pieces); }
    // tanh(h) at the upper wall, below 1 in any rounding.
    double highest(double x) const {
        return std::min(std::tanh(tail_.height(x, 0.5 * grid_.z.length)), 1 - 1e-14);
    }

    TailSheet tail_;
    Grid grid_;
    std::vector<double> below_{0};
};

}  // namespace implicit_moment
