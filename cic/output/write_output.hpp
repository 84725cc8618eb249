// Files for the figures: fields on nodes, a thinned sample of the particles, f(x, v) and f(v) in
// bins, and the spectrum of the field.
#pragma once

#include <gsl/gsl_fft_complex.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cic/output/diagnostics.hpp"
#include "common/run/history.hpp"
#include "common/run/writers.hpp"

namespace cic {

/// Writes fields_NNNNNN.dat (and .vti): rho, phi, E_x, E_z on nodes, density of every species; E of
/// the energy-conserving scheme is that of the edge behind the node.
inline void write_fields(const common::Snapshot& at_time, const Case& parameters,
                         const State& state, const Field& rho_g, const FieldState& field) {
    const Grid& grid = parameters.grid;
    const bool plane = parameters.dimensions == 2;
    std::vector<std::vector<double>> data;
    std::vector<std::string> names, units;
    const auto add = [&](const std::string& name, const std::string& unit, const auto& at) {
        std::vector<double> values;
        for (long j = 0; j <= (plane ? grid.z.cells : 0); ++j)
            for (long i = 0; i <= grid.x.cells; ++i) values.push_back(at(grid.index(i, j)));
        names.push_back(name), units.push_back(unit), data.push_back(std::move(values));
    };
    add("rho", "n0*e", [&](long n) { return rho_g[n]; });
    add("phi", "m*velocity^2/e", [&](long n) { return field.phi[n]; });
    add("E_x", "m*velocity*omega_p/e", [&](long n) { return double(field.E_g[n].x); });
    if (plane) add("E_z", "m*velocity*omega_p/e", [&](long n) { return double(field.E_g[n].z); });
    DepositScratch scratch;
    for (const Particles& s : state.species) {
        // As a density of particles: at walls without the images of the energy-conserving scheme.
        Field charge = Field::Zero(grid.size());
        add_charge(s, grid, parameters.scheme(), scratch, charge);
        common::fold_ghosts(grid, common::on_nodes, {1, 1}, charge.data());
        const double weight = s.q_p != 0 ? 1 / s.q_p : 0;
        add("particles_" + s.name, "1/volume", [&](long n) { return charge[n] * weight; });
    }

    const common::SampledAxis x{"x", "length", grid.x.low, grid.x.spacing(), grid.x.cells + 1};
    const common::SampledAxis z{plane ? "z" : "", "length", grid.z.low, grid.z.spacing(),
                                plane ? grid.z.cells + 1 : 1};
    std::vector<common::ScalarColumn> columns;
    for (std::size_t k = 0; k < data.size(); ++k) columns.push_back({names[k], units[k], data[k]});
    common::write_fields(at_time, "fields", x, z, columns);
    if (at_time.also.vtk)
        common::write_vti(at_time, "fields", {x, {"y", "length", 0, 1, 1}, z}, columns, {});
}

/// Writes particles_NNNNNN.dat (and .vtp): a random sample of each species, about
/// most_particles_written in all; positions at t^n, velocities half a step before. In one dimension
/// there are no columns of what particles do not have.
inline void write_particles(const common::Snapshot& at_time, const Case& parameters,
                            const State& state) {
    const long every = common::every_nth_written(state.count());
    std::array<std::vector<double>, 6> data;
    for (std::size_t k = 0; k < state.species.size(); ++k) {
        const Particles& s = state.species[k];
        const auto at = [](const std::vector<Real>& values, long p) {
            return values.empty() ? 0.0 : double(values[p]);
        };
        const long before = begin_of_rank(s.count_of_all(), common::rank());
        std::array<std::vector<double>, 6> own;
        // Radical inverses repeat themselves: a stride of many particles would draw a pattern.
        for (long p = 0; p < s.count(); ++p) {
            if (every > 1 &&
                common::uniform(7, 7, std::uint64_t(before + p), 0) * double(every) >= 1)
                continue;
            const std::array<double, 6> row{double(k),     at(s.x_p, p),  at(s.z_p, p),
                                            at(s.vx_p, p), at(s.vy_p, p), at(s.vz_p, p)};
            for (std::size_t a = 0; a < 6; ++a) own[a].push_back(row[a]);
        }
        for (std::size_t a = 0; a < 6; ++a) {
            const std::vector<double> of_all = common::gather_in_turn(own[a]);
            data[a].insert(data[a].end(), of_all.begin(), of_all.end());
        }
    }
    const bool plane = parameters.dimensions == 2, magnetized = parameters.magnetized();
    std::vector<common::ScalarColumn> columns{{"species", "", data[0]}, {"x", "length", data[1]}};
    if (plane) columns.push_back({"z", "length", data[2]});
    columns.push_back({"v_x", "velocity", data[3]});
    if (magnetized) columns.push_back({"v_y", "velocity", data[4]});
    if (magnetized || plane) columns.push_back({"v_z", "velocity", data[5]});
    common::Snapshot sample = at_time;
    sample.particles = state.count();
    sample.note = sentence(" velocities at ", at_time.time - 0.5 * parameters.dt);
    common::write_table(sample, "particles", columns);
    if (at_time.also.vtk) {
        const std::vector<double> zero(data[0].size(), 0.0);
        common::write_vtp(at_time, "particles", {"position", "length", data[1], zero, data[2]},
                          {{"species", "", data[0]}},
                          {{"velocity", "velocity", data[3], data[4], data[5]}});
    }
}

/// Largest speed that the bins of f(x, v) must hold, from the start of the run.
inline double phase_v_max(const Case& parameters) {
    if (parameters.phase_v_max > 0) return parameters.phase_v_max;
    double most = 0;
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile())
            most = std::max(
                most, 1.8 * std::fabs(s.drift_x) +
                          std::max(s.distribution_max, 5 * std::sqrt(s.temperature_x / s.mass)));
    return most > 0 ? most : 1;
}

/// Writes phase_NNNNNN.dat, the phase-space density f_s(x, v_x) of every species, and
/// velocities_NNNNNN.dat, f_s(v_x). What is faster than the bins reach is left out.
/// exact:  sum f dx dv (times L_z in two dimensions) is the number of particles in the bins
inline void write_phase_space(const common::Snapshot& at_time, const Case& parameters,
                              const State& state) {
    const long nx = parameters.phase_bins_x, nv = parameters.phase_bins_v;
    const double v_max = phase_v_max(parameters), dv = 2 * v_max / double(nv),
                 dx = parameters.grid.x.length / double(nx),
                 L_z = parameters.dimensions == 2 ? parameters.grid.z.length : 1;
    const common::SampledAxis x{"x", "length", parameters.grid.x.low + 0.5 * dx, dx, nx},
        v{"v_x", "velocity", -v_max + 0.5 * dv, dv, nv};
    std::vector<std::vector<double>> f, f_v;
    for (const Particles& s : state.species) {
        std::vector<double> bins(std::size_t(nx * nv + nv), 0.0);  // f(x, v), f(v)
        const SpeciesCase* from = nullptr;
        for (const SpeciesCase& c : parameters.species)
            if (c.name == s.name) from = &c;
        const double weight = s.m_p / from->mass / (dx * dv * L_z);
        common::in_turn(bins.data(), std::array{0L, std::ssize(bins)}, [&](long) {
            for (std::size_t n = 0; n < s.x_p.size(); ++n) {
                const long i =
                    std::min(nx - 1, long((double(s.x_p[n]) - parameters.grid.x.low) / dx));
                const double bin = std::floor((double(s.vx_p[n]) + v_max) / dv);
                if (!(bin >= 0 && bin < double(nv))) continue;
                const long l = long(bin);
                bins[std::size_t(l * nx + i)] += weight;
                bins[std::size_t(nx * nv + l)] += weight / double(nx);
            }
        });
        f.emplace_back(bins.begin(), bins.begin() + nx * nv);
        f_v.emplace_back(bins.begin() + nx * nv, bins.end());
    }
    std::vector<double> speeds;
    for (long l = 0; l < nv; ++l) speeds.push_back(v.at(l));
    std::vector<common::ScalarColumn> planes, lines{{"v_x", "velocity", speeds}};
    for (std::size_t k = 0; k < f.size(); ++k) {
        planes.push_back({"f_" + state.species[k].name, "n0/velocity", f[k]});
        lines.push_back({"f_" + state.species[k].name, "n0/velocity", f_v[k]});
    }
    common::write_fields(at_time, "phase", x, v, planes);
    common::write_table(at_time, "velocities", lines);
}

/// Writes spectrum.dat: |E|^2 of the recorded modes against frequency, in units of 1/omega_p times
/// the square of the field; negative frequencies travel against x.
///   E(omega, k) = sum_n h_n E_k(t_n) exp(i omega t_n) dt,  h_n Hann's window
inline void write_spectrum(const std::string& path, const Case& parameters,
                           const common::History& history) {
    const auto times = history.column("time");
    const std::size_t count = times.size();
    if (count < 8) return;
    const auto wavetable = gsl_fft_complex_wavetable_alloc(count);
    const auto workspace = gsl_fft_complex_workspace_alloc(count);
    std::vector<double> power;
    for (long m = 1; m <= parameters.modes; ++m) {
        const auto E_k = history.complex_column("E_" + std::to_string(m));
        std::vector<double> z;
        for (std::size_t n = 0; n < count; ++n) {
            const double h = 1 - std::cos(2 * pi * double(n) / double(count));
            z.push_back(h * E_k[n].real() * parameters.dt);
            z.push_back(h * E_k[n].imag() * parameters.dt);
        }
        gsl_fft_complex_inverse(z.data(), 1, count, wavetable, workspace);
        // From the lowest frequency up; the transform divides by count.
        for (std::size_t n = 0; n < count; ++n) {
            const std::size_t from = 2 * ((n + count - count / 2) % count);
            const double factor = double(count) * double(count);
            power.push_back(factor * (z[from] * z[from] + z[from + 1] * z[from + 1]));
        }
    }
    gsl_fft_complex_wavetable_free(wavetable);
    gsl_fft_complex_workspace_free(workspace);

    const double d_omega = 2 * pi / (double(count) * parameters.dt);
    const double k_1 = 2 * pi / parameters.grid.x.length;
    common::write_fields(path,
                         {"omega", "omega_p", -d_omega * double(count / 2), d_omega, long(count)},
                         {"k", "1/length", k_1, k_1, parameters.modes}, {{"power", "E^2", power}});
}

}  // namespace cic
