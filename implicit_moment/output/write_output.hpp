// Snapshots for the figures: fields on nodes, and a thinned sample of the particles.
#pragma once

#include <string>
#include <vector>

#include "common/run/writers.hpp"
#include "implicit_moment/output/diagnostics.hpp"

namespace implicit_moment {

/// One quantity brought to the nodes 0..N of both directions by averaging the places beside each
/// node, x fastest.
/// in:     f, ghosts filled.
inline std::vector<double> on_all_nodes(const Grid& grid, Place place, const double* f) {
    std::vector<double> values;
    const long s = grid.stride();
    for (long j = 0; j <= grid.z.cells; ++j) {
        for (long i = 0; i <= grid.x.cells; ++i) {
            const long n = grid.index(i, j);
            const long left = place.half_x ? 1 : 0, down = place.half_z ? s : 0;
            values.push_back(0.25 * (f[n] + f[n - left] + f[n - down] + f[n - left - down]));
        }
    }
    return values;
}

/// Writes fields_NNNNNN.dat (and .vti): E, B, A_y; mean velocity and charge density of every
/// species; total J. Units of units.hpp.
inline void write_fields(const common::Snapshot& at, const Grid& grid, const FieldState& field,
                         const Plasma& plasma, const std::vector<Moments>& moments) {
    std::vector<std::vector<double>> data;
    std::vector<std::string> names, units;
    const auto add = [&](const std::string& name, const std::string& unit,
                         std::vector<double> values) {
        names.push_back(name);
        units.push_back(unit);
        data.push_back(std::move(values));
    };
    const Field A_y = flux_function(grid, field.B);
    add("A_y", "B*d_i", on_all_nodes(grid, on_nodes, A_y.data()));
    for (std::size_t a = 0; a < 3; ++a) {
        const std::string letter(1, "xyz"[a]);
        const long offset = a * grid.size();
        add("E_" + letter, "m_i*c*omega_pi/e",
            on_all_nodes(grid, electric.place[a], field.E.all.data() + offset));
        add("B_" + letter, "m_i*c*omega_pi/e",
            on_all_nodes(grid, magnetic.place[a], field.B.all.data() + offset));
    }
    std::array<std::vector<double>, 3> total;
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const Particles& particles = plasma.species[k];
        auto rho = on_all_nodes(grid, on_nodes, moments[k].rho.data());
        const std::array<const Field*, 3> J{&moments[k].J_x, &moments[k].J_y, &moments[k].J_z};
        for (std::size_t a = 0; a < 3; ++a) {
            auto J_a = on_all_nodes(grid, electric.place[a], J[a]->data());
            if (total[a].empty()) total[a].assign(J_a.size(), 0.0);
            std::vector<double> velocity(J_a.size());
            for (std::size_t n = 0; n < J_a.size(); ++n) {
                total[a][n] += J_a[n];
                velocity[n] = std::fabs(rho[n]) > 1e-12 ? J_a[n] / rho[n] : 0.0;
            }
            add(std::string("v_") + "xyz"[a] + "_" + particles.name, "c", std::move(velocity));
        }
        for (double& r : rho) r /= n0;
        add("rho_" + particles.name, "e*n0", std::move(rho));
    }
    for (std::size_t a = 0; a < 3 && !moments.empty(); ++a) {
        for (double& j : total[a]) j /= n0;
        add(std::string("J_") + "xyz"[a], "e*n0*c", std::move(total[a]));
    }

    const common::SampledAxis x{"x", "d_i", grid.x.low, grid.x.spacing(), nodes_x(grid)};
    const common::SampledAxis z{"z", "d_i", grid.z.low, grid.z.spacing(), nodes_z(grid)};
    std::vector<common::ScalarColumn> columns;
    for (std::size_t k = 0; k < data.size(); ++k) columns.push_back({names[k], units[k], data[k]});
    common::write_fields(at, "fields", x, z, columns);
    if (at.also.vtk) common::write_vti(at, "fields", {x, {"y", "d_i", 0, 1, 1}, z}, columns, {});
}

/// Writes particles_NNNNNN.dat (and .vtp): every n-th particle of each species, at most
/// most_particles_written in all; v, or u = gamma v of relativistic ones.
/// in:     u_at, (species, particle) -> its u at the time of the file
template <class VelocityAt>
inline void write_particles(const common::Snapshot& at, const Plasma& plasma,
                            const Case& parameters, const VelocityAt& u_at) {
    const long all = common::sum_over_ranks(plasma.count()), every = common::every_nth_written(all);
    std::array<std::vector<double>, 6> data;
    for (std::size_t k = 0; k < plasma.species.size(); ++k) {
        const Particles& p = plasma.species[k];
        std::array<std::vector<double>, 6> of_rank;
        // The first of ours whose number among all is a multiple.
        const long before = sum_before_rank(p.count());
        for (long n = (every - before % every) % every; n < p.count(); n += every) {
            const Velocity<double> u = u_at(p, n);
            const std::array<double, 6> row{double(k), p.x_p[n], p.z_p[n], u.x, u.y, u.z};
            for (std::size_t a = 0; a < 6; ++a) of_rank[a].push_back(row[a]);
        }
        for (std::size_t a = 0; a < 6; ++a) {
            const std::vector<double> of_all = common::gather_in_turn(of_rank[a]);
            data[a].insert(data[a].end(), of_all.begin(), of_all.end());
        }
    }
    const bool is_u = parameters.is_relativistic();
    const std::string v = is_u ? "u_" : "v_";
    common::Snapshot sample = at;
    sample.particles = all;
    common::write_table(sample, "particles",
                        {{"species", "", data[0]},
                         {"x", "d_i", data[1]},
                         {"z", "d_i", data[2]},
                         {v + "x", "c", data[3]},
                         {v + "y", "c", data[4]},
                         {v + "z", "c", data[5]}});
    if (at.also.vtk) {
        const std::vector<double> zero(data[0].size(), 0.0);
        common::write_vtp(
            at, "particles", {"position", "d_i", data[1], zero, data[2]},
            {{"species", "", data[0]}},
            {{is_u ? "momentum_per_mass" : "velocity", "c", data[3], data[4], data[5]}});
    }
}

}  // namespace implicit_moment
