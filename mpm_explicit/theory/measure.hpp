// What a comparison with theory follows through the run: columns of its own in the history.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "common/run/history.hpp"
#include "mpm_explicit/setup/assemble.hpp"
#include "mpm_explicit/setup/case_of_grains.hpp"

namespace mpm {

/// The grain that a comparison looks at.
struct Subject {
    std::size_t grain = 0;
};

inline Subject subject_of(const Case& w, const std::vector<Grain>& grains) {
    Subject subject;
    bool found = false;
    for (std::size_t g = 0; g < grains.size(); ++g) {
        if (!grains[g].rigid && (w.grain.empty() ? !found : grains[g].name == w.grain))
            subject.grain = g, found = true;
    }
    return subject;
}

/// Mean stress of the particles within a distance of the center of a grain.
inline Stress stress_at_center(const Assembly& all, std::size_t grain, double distance) {
    const Particles& at = all.particles;
    const auto begin = static_cast<std::size_t>(all.grains[grain].begin),
               end = static_cast<std::size_t>(all.grains[grain].end);
    double x = 0, y = 0, m = 0, V = 0;
    for (std::size_t p = begin; p < end; ++p)
        x += at.m_p[p] * at.x_p[p], y += at.m_p[p] * at.y_p[p], m += at.m_p[p];
    x /= m, y /= m;
    Stress mean;
    for (std::size_t p = begin; p < end; ++p) {
        if (std::hypot(at.x_p[p] - x, at.y_p[p] - y) > distance) continue;
        V += at.V_p[p], mean.xx += at.V_p[p] * at.sxx_p[p], mean.yy += at.V_p[p] * at.syy_p[p];
        mean.xy += at.V_p[p] * at.sxy_p[p], mean.zz += at.V_p[p] * at.szz_p[p];
    }
    return {mean.xx / V, mean.yy / V, mean.xy / V, mean.zz / V};
}

/// The place beyond which a share of all mass that is not rigid lies, along x.
inline double front_of(const Assembly& all, double share) {
    std::vector<double> x;
    for (const Grain& grain : all.grains)
        if (!grain.rigid)
            x.insert(x.end(), all.particles.x_p.begin() + grain.begin,
                     all.particles.x_p.begin() + grain.end);
    const auto at =
        x.begin() + static_cast<std::ptrdiff_t>((1 - share) * static_cast<double>(x.size() - 1));
    std::nth_element(x.begin(), at, x.end());
    return *at;
}

inline constexpr double share_beyond_front = 0.01;

inline std::vector<common::Column> columns_of_comparison(const Case& w) {
    if (w.compare == "disk")
        return {{"center_xx", "stress"}, {"center_yy", "stress"}, {"center_xy", "stress"}};
    if (w.compare == "collapse") return {{"front", "length"}};
    return {};
}

inline void add_comparison(const Case& w, const Subject& subject, const Assembly& all,
                           std::vector<double>& row) {
    if (w.compare == "disk") {
        const Stress s = stress_at_center(all, subject.grain, 1.5 * w.problem.mesh().h);
        row.insert(row.end(), {s.xx, s.yy, s.xy});
    }
    if (w.compare == "collapse") row.push_back(front_of(all, share_beyond_front));
}

}  // namespace mpm
