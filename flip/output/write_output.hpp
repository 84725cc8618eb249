// Files for the figures: the fluid on the cells, and a thinned sample of the particles.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "common/run/writers.hpp"
#include "flip/setup/case.hpp"
#include "flip/state.hpp"
#include "flip/theory/profiles.hpp"

namespace flip {

/// Writes fields_NNNNNN.dat (and .vti): rho, v_x, v_z, p, e at the middles of the cells, and the
/// density of each material; without z and v_z on a mesh of one row, with v_theta where the fluid turns
/// about the axis.
/// in:     cells, zero where there is no fluid
inline void write_fields(const common::Snapshot& at, const Case& parameters,
                         const CellFields& cells) {
    const Grid& grid = parameters.grid;
    const bool plane = parameters.moves_along_z();
    std::vector<std::vector<double>> data;
    std::vector<common::ScalarColumn> columns;
    const auto add = [&](const std::string& name, const std::string& unit, const Field& f) {
        std::vector<double>& values = data.emplace_back();
        visit_cells(grid, [&](long c, double, double) { values.push_back(f[c]); });
        columns.push_back({name, unit, values});
    };
    add("rho", "mass/length^3", cells.rho);
    add("v_x", "velocity", cells.vx);
    if (plane) add("v_z", "velocity", cells.vz);
    const bool swirl = cells.v_theta.size() > 0;
    if (swirl) add("v_theta", "velocity", cells.v_theta);
    add("p", "pressure", cells.p);
    add("e", "velocity^2", cells.e);
    for (std::size_t k = 0; k < cells.rho_of.size() && k < parameters.materials.size(); ++k)
        add("rho_" + parameters.materials[k].name, "mass/length^3", cells.rho_of[k]);

    const common::SampledAxis x{"x", "length", grid.x.at(0.5), grid.x.spacing(), grid.x.cells};
    const common::SampledAxis z{plane ? "z" : "", "length", grid.z.at(0.5), grid.z.spacing(),
                                grid.z.cells};
    common::write_fields(at, "fields", x, z, columns);
    if (!at.also.vtk) return;
    const std::vector<double> zero(data[0].size(), 0.0);
    columns.erase(columns.begin() + 1, columns.begin() + (plane ? 3 : 2) + (swirl ? 1 : 0));
    common::write_vti(at, "fields", {x, {"y", "length", 0, 1, 1}, z}, columns,
                      {{"velocity", "velocity", data[1], swirl ? data[plane ? 3 : 2] : zero,
                        plane ? data[2] : zero}});
}

/// Writes particles_NNNNNN.dat (and .vtp): position, material and, where particles carry them,
/// velocity, also about the axis, and internal energy. One particle, drawn at random, stands for each
/// group of neighbors in memory, so that there are at most most_particles_written.
inline void write_particles(const common::Snapshot& at, const Case& parameters,
                            const Particles& particles) {
    const bool plane = parameters.moves_along_z();
    const long count = particles.count();
    const long every = common::every_nth_written(count);
    const bool moving = has(particles.vx_p);
    const bool swirl = particles.swirl;
    std::vector<double> x, z, material, vx, vz, e, v_theta;
    for (long from = 0; from < count; from += every) {
        const auto group = double(std::min(every, count - from));
        const double draw = common::uniform(7, 7, std::uint64_t(from), 0);
        const auto p = std::size_t(from + long(draw * group));
        x.push_back(particles.x_p[p]);
        z.push_back(particles.z_p[p]);
        material.push_back(particles.material[p]);
        if (swirl) v_theta.push_back(particles.L_p[p] / particles.x_p[p]);
        if (!moving) continue;
        vx.push_back(particles.vx_p[p]);
        vz.push_back(particles.vz_p[p]);
        e.push_back(particles.e_p[p]);
    }
    std::vector<common::ScalarColumn> columns{{"x", "length", x}};
    if (plane) columns.push_back({"z", "length", z});
    columns.push_back({"material", "", material});
    if (swirl) columns.push_back({"v_theta", "velocity", v_theta});
    if (moving) {
        columns.push_back({"v_x", "velocity", vx});
        if (plane) columns.push_back({"v_z", "velocity", vz});
        columns.push_back({"e", "velocity^2", e});
    }
    common::Snapshot sample = at;
    sample.particles = count;
    common::write_table(sample, "particles", columns);
    if (!at.also.vtk) return;
    const std::vector<double> zero(x.size(), 0.0);
    std::vector<common::ScalarColumn> scalars{{"material", "", material}};
    std::vector<common::VectorColumn> vectors;
    if (moving) {
        scalars.push_back({"e", "velocity^2", e});
        vectors.push_back({"velocity", "velocity", vx, swirl ? v_theta : zero, vz});
    } else if (swirl) {
        scalars.push_back({"v_theta", "velocity", v_theta});
    }
    common::write_vtp(at, "particles", {"position", "length", x, zero, z}, scalars, vectors);
}

}  // namespace flip
