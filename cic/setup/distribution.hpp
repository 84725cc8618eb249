// A density or a distribution of velocities as a table: what loading inverts and theory integrates.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace cic {

/// A distribution that is constant within each of many equal pieces.
struct Distribution {
    double low = 0, step = 0;
    std::vector<double> f;           // of each piece; its integral is 1
    std::vector<double> cumulative;  // the integral of f up to each edge, 0 to 1
    std::vector<double> rise;        // the step of f at each edge, all that f' consists of

    bool given() const { return !f.empty(); }
    double edge(std::size_t j) const { return low + double(j) * step; }
    double middle(std::size_t j) const { return low + (double(j) + 0.5) * step; }
    double within(std::size_t j) const { return cumulative[j + 1] - cumulative[j]; }

    /// The place below which the part u of all particles is.
    double inverse(double u) const {
        const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
        const auto j = std::size_t(above - cumulative.begin()) - 1;
        return edge(j) + step * std::clamp((u - cumulative[j]) / within(j), 0.0, 1.0);
    }
    double mean() const {
        double sum = 0;
        for (std::size_t j = 0; j < f.size(); ++j) sum += within(j) * middle(j);
        return sum;
    }
    /// The mean of (v - origin)^2.
    double mean_square(double origin) const {
        double sum = step * step / 12;
        for (std::size_t j = 0; j < f.size(); ++j)
            sum += within(j) * (middle(j) - origin) * (middle(j) - origin);
        return sum;
    }
};

/// A table of f from low to high.
/// in:     f(v), not negative; speeds, whether v is the speed in a plane, of which particles have
///         2 pi v f(v) dv
/// out:    nothing where f is zero in the middle of every piece
/// note:   what is below 1e-16 of the largest f is zero.
template <class Function>
Distribution tabulate(double low, double high, long pieces, bool speeds, const Function& f) {
    Distribution table{low, (high - low) / double(pieces), {}, {0}, {}};
    for (long j = 0; j < pieces; ++j) table.f.push_back(f(table.middle(std::size_t(j))));
    const double least = 1e-16 * std::ranges::max(table.f);
    if (!(least > 0)) return {};
    for (std::size_t j = 0; j < table.f.size(); ++j) {
        if (table.f[j] < least) table.f[j] = 0;
        table.cumulative.push_back(table.cumulative.back() +
                                   table.f[j] * table.step *
                                       (speeds ? 2 * std::acos(-1.0) * table.middle(j) : 1));
    }
    const double all = table.cumulative.back();
    for (double& value : table.f) value /= all;
    for (double& value : table.cumulative) value /= all;
    table.rise = table.f;
    table.rise.push_back(0);
    for (std::size_t j = 1; j < table.rise.size(); ++j) table.rise[j] -= table.f[j - 1];
    return table;
}

}  // namespace cic
