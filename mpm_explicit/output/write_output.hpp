// Files for the figures: particles, one line per grain, and the fringes of a polariscope.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "common/run/writers.hpp"
#include "mpm_explicit/assembly.hpp"
#include "mpm_explicit/output/fringes.hpp"
#include "mpm_explicit/setup/case_of_grains.hpp"
#include "mpm_explicit/setup/plan_grains.hpp"

namespace mpm {

inline constexpr long most_particles_written = 40000;

namespace detail {

// Positions of a grain that straddles the ends of a periodic mesh, as they are seen.
inline double seen(const Mesh& mesh, double x) {
    return mesh.periodic_x ? x - mesh.length_x() * std::floor((x - mesh.x_low) / mesh.length_x())
                           : x;
}

}  // namespace detail

/// Writes particles_NNNNNN.dat (and .vtp): all of them, or a random sample of about
/// most_particles_written.
inline void write_particles(const std::string& folder, long step, const Case& w,
                            const Assembly& all) {
    const Particles& at = all.particles;
    const Mesh mesh = w.problem.mesh();
    const long every = (at.count() + most_particles_written - 1) / most_particles_written;
    std::array<std::vector<double>, 11> data;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        const Grain& grain = all.grains[g];
        for (long p = grain.begin; p < grain.end; ++p) {
            const bool kept =
                every <= 1 || common::uniform(7, 7, static_cast<std::uint64_t>(p), 0) *
                                      static_cast<double>(every) <
                                  1;
            if (!kept) continue;
            const auto n = static_cast<std::size_t>(p);
            const std::array<double, 11> row{detail::seen(mesh, at.x_p[n]),
                                             at.y_p[n],
                                             at.vx_p[n],
                                             at.vy_p[n],
                                             static_cast<double>(g),
                                             at.sxx_p[n],
                                             at.syy_p[n],
                                             at.sxy_p[n],
                                             at.szz_p[n],
                                             at.V_p[n],
                                             at.yield_p[n]};
            for (std::size_t a = 0; a < row.size(); ++a) data[a].push_back(row[a]);
        }
    }
    const std::vector<common::ScalarColumn> columns{
        {"x", "length", data[0]},         {"y", "length", data[1]},
        {"v_x", "velocity", data[2]},     {"v_y", "velocity", data[3]},
        {"grain", "", data[4]},           {"s_xx", "stress", data[5]},
        {"s_yy", "stress", data[6]},      {"s_xy", "stress", data[7]},
        {"s_zz", "stress", data[8]},      {"V", "volume", data[9]},
        {"plastic_strain", "1", data[10]}};
    common::write_table(folder + common::numbered("particles", step, "dat"), columns);
    if (w.vtk) {
        const std::vector<double> zero(data[0].size(), 0.0);
        common::write_vtp(folder + common::numbered("particles", step, "vtp"),
                          {"position", "length", data[0], data[1], zero},
                          {columns.begin() + 4, columns.end()},
                          {{"velocity", "velocity", data[2], data[3], zero}});
    }
}

/// Writes grains_NNNNNN.dat, one line per grain: number, center of mass, mean velocity, mass, mean
/// stress over the grain, whether rigid.
inline void write_grains(const std::string& folder, long step, const Assembly& all) {
    const Particles& at = all.particles;
    std::array<std::vector<double>, 10> data;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        const Grain& grain = all.grains[g];
        double m = 0, V = 0, x = 0, y = 0, vx = 0, vy = 0, sxx = 0, syy = 0, sxy = 0;
        for (long k = grain.begin; k < grain.end; ++k) {
            const auto p = static_cast<std::size_t>(k);
            m += at.m_p[p], x += at.m_p[p] * at.x_p[p], y += at.m_p[p] * at.y_p[p];
            vx += at.m_p[p] * at.vx_p[p], vy += at.m_p[p] * at.vy_p[p];
            V += at.V_p[p], sxx += at.V_p[p] * at.sxx_p[p], syy += at.V_p[p] * at.syy_p[p];
            sxy += at.V_p[p] * at.sxy_p[p];
        }
        const std::array<double, 10> row{
            static_cast<double>(g), x / m, y / m, vx / m, vy / m, m, sxx / V, syy / V, sxy / V,
            grain.rigid ? 1.0 : 0.0};
        for (std::size_t a = 0; a < row.size(); ++a) data[a].push_back(row[a]);
    }
    common::write_table(folder + common::numbered("grains", step, "dat"),
                        {{"grain", "", data[0]},
                         {"x", "length", data[1]},
                         {"y", "length", data[2]},
                         {"v_x", "velocity", data[3]},
                         {"v_y", "velocity", data[4]},
                         {"mass", "mass", data[5]},
                         {"s_xx", "stress", data[6]},
                         {"s_yy", "stress", data[7]},
                         {"s_xy", "stress", data[8]},
                         {"rigid", "", data[9]}});
}

/// Writes fringes_NNNNNN.dat: the principal stress difference of elastic grains on pixels.
inline void write_fringe_raster(const std::string& folder, long step, const Case& w,
                                const Assembly& all) {
    const Mesh mesh = w.problem.mesh();
    write_fringes(folder + common::numbered("fringes", step, "dat"),
                  draw_fringes(all.particles, all.grains, mesh, whole(mesh),
                               static_cast<int>(w.pixels_per_cell)));
}

/// Writes pack.txt: the grains of the case, to be read again as a pack of kind "file".
inline void write_pack_of(const std::string& folder, const Case& w) {
    std::vector<PackedGrain> grains;
    for (const PlannedGrain& plan : plan_grains(w.problem, materials_of(w.problem)))
        grains.push_back({plan.name, plan.outline});
    write_pack(folder + "pack.txt", grains);
}

}  // namespace mpm
