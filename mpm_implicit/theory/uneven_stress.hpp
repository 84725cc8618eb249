// Stress that alternates from particle to particle: noise that has grown in what is pressed (04b, "A held grain
// rings"). It has elastic energy and no force.
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "common/run/run.hpp"
#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/grains/materials.hpp"
#include "mpm_explicit/setup/problem.hpp"
#include "mpm_implicit/setup/case.hpp"

namespace mpm_implicit {

/// The part of the elastic energy that is of stress less its mean in the cell, grain by grain.
/// note:   A grain of n cells across that is bent has 1/n^2; held ones of the cases have 0.03 and less.
inline double uneven_stress(const Assembly& all, const std::vector<Material>& materials,
                            const Mesh& mesh) {
    struct Cell {
        double V = 0, energy = 0;
        Stress sum;
    };
    const Particles& at = all.particles;
    double uneven = 0, total = 0;
    for (const Grain& grain : all.grains) {
        if (grain.rigid) continue;
        const Compliance twice_energy(materials[grain.material]);
        std::map<std::pair<long, long>, Cell> cells;
        for (long p = grain.begin; p < grain.end; ++p) {
            const auto place = [&](double x) { return std::lround(std::floor(x / mesh.h)); };
            Cell& cell = cells[{place(at.x_p[p] - mesh.x_low), place(at.y_p[p] - mesh.y_low)}];
            const Stress s = at.stress(std::size_t(p));
            const double V = at.V_p[p];
            cell.V += V, cell.energy += 0.5 * V * twice_energy(s, s);
            cell.sum = {cell.sum.xx + V * s.xx, cell.sum.yy + V * s.yy, cell.sum.xy + V * s.xy,
                        cell.sum.zz + V * s.zz};
        }
        for (const auto& [place, cell] : cells) {
            total += cell.energy;
            uneven += cell.energy - 0.5 * twice_energy(cell.sum, cell.sum) / cell.V;
        }
    }
    return total > 0 ? uneven / total : 0;
}

/// Warns where a tenth of the energy of grains that hardly move any more is such noise.
inline void warn_of_noise(const Case& parameters, const ThetaScheme& scheme, double dt,
                          const Assembly& all, common::Run& run) {
    const double elastic = run.history.column("elastic").back(),
                 kinetic = run.history.column("kinetic").back();
    if (scheme.theta >= 0.505 || !(elastic > 10 * kinetic)) return;
    const double part =
        uneven_stress(all, materials_of(parameters.problem), parameters.problem.mesh());
    if (part > 0.1)
        run.summary.late_warnings.push_back(
            "a part " + format(part) +
            " of the elastic energy at the end is of stress that alternates within cells: noise "
            "has grown in what is pressed, and forces may be too small by as much; set "
            "method.theta = 0.6 or material.<name>.viscosity = " +
            format(0.1 * dt) + ", or refine what is bent and has fewer than four cells across");
}

}  // namespace mpm_implicit
