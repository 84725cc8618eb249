// Which of the many roots of a dispersion relation a mode is compared with: all that are reached from
// guesses, the one nearest to a frequency; and whether there is one that grows faster than a rate.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"

namespace cic {

using common::Complex;

/// The roots that are reached from all guesses, without repetition.
template <class Dispersion>
std::vector<Complex> all_roots(const Dispersion& D, const std::vector<Complex>& guesses) {
    std::vector<Complex> roots;
    for (const Complex guess : guesses) {
        const common::DispersionRoot root = common::root_near(D, guess);
        const auto same = [&](Complex other) {
            return std::abs(other - root.omega) <= 1e-7 * std::abs(root.omega);
        };
        if (root.found && std::none_of(roots.begin(), roots.end(), same))
            roots.push_back(root.omega);
    }
    return roots;
}

/// How far a root is from a frequency that is asked for. That a wave grows does not make it another one: it
/// covers all others.
inline double apart(Complex omega, double frequency) {
    return std::hypot(omega.real() - frequency, std::min(omega.imag(), 0.0));
}

/// Of the roots that are reached from all guesses the one that is nearest to a frequency; of two as near
/// the one with the larger Im omega.
template <class Dispersion>
common::DispersionRoot nearest_root(const Dispersion& D, const std::vector<Complex>& guesses,
                                    double frequency) {
    common::DispersionRoot best;
    const double same = 1e-9 * std::fabs(frequency);
    for (const Complex guess : guesses) {
        const common::DispersionRoot root = common::root_near(D, guess);
        const double lead = apart(best.omega, frequency) - apart(root.omega, frequency);
        const bool nearer = lead > same, faster = root.omega.imag() > best.omega.imag();
        if (root.found && (nearer || (lead >= -same && faster))) best = root;
    }
    return best;
}

/// How often D turns about 0 while omega goes straight from a to b: by halves, until D changes by less
/// than a half of itself.
/// out:   not a number where D is none
template <class Dispersion>
double turns_about_zero(const Dispersion& D, Complex a, Complex b, Complex D_a, Complex D_b,
                        int halvings = 40) {
    const Complex middle = 0.5 * (a + b), D_middle = D(middle);
    const double apart = std::max(std::abs(D_middle - D_a), std::abs(D_b - D_middle)),
                 least = std::min({std::abs(D_a), std::abs(D_middle), std::abs(D_b)});
    if (apart > 0.5 * least && halvings > 0)
        return turns_about_zero(D, a, middle, D_a, D_middle, halvings - 1) +
               turns_about_zero(D, middle, b, D_middle, D_b, halvings - 1);
    return 0.5 * std::numbers::inv_pi * (std::arg(D_middle / D_a) + std::arg(D_b / D_middle));
}

/// Whether D may have roots that grow faster than a rate: they are as many as the turns of D about 0 along
/// Im omega = rate.
/// in:    D, analytic above that line and 1 far away; guesses, of its roots and so where D changes
template <class Dispersion>
bool may_grow_faster(const Dispersion& D, double rate, const std::vector<Complex>& guesses) {
    std::vector<double> places{0.0};
    for (const Complex guess : guesses)
        for (const double sign : {-1.0, 1.0}) places.push_back(sign * guess.real());
    std::sort(places.begin(), places.end());
    const double far = 1e4 * places.back();
    places.insert(places.begin(), -far), places.push_back(far);
    double turns = 0.0;
    Complex before, D_before;
    for (const double place : places) {
        const Complex omega{place, rate}, D_here = D(omega);
        if (place > -far) turns += turns_about_zero(D, before, omega, D_before, D_here);
        before = omega, D_before = D_here;
    }
    return !(std::abs(turns) < 0.5);
}

}  // namespace cic
