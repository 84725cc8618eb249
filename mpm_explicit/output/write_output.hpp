// Files for the figures: particles, one line per grain, and the fringes of a polariscope.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "common/run/history.hpp"
#include "common/run/writers.hpp"
#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/output/fringes.hpp"
#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/setup/plan_grains.hpp"

namespace mpm {

inline constexpr long most_particles_written = 40000;  // in a file

/// Rows of equal columns, as columns for a file.
struct Table {
    std::vector<common::Column> names;
    std::vector<std::vector<double>> values;

    void add(const common::Row& row) {
        names = row.columns;
        values.resize(names.size());
        for (std::size_t k = 0; k < names.size(); ++k) values[k].push_back(row.values[k]);
    }
    std::vector<common::ScalarColumn> columns() const {
        std::vector<common::ScalarColumn> all;
        for (std::size_t k = 0; k < names.size(); ++k)
            all.push_back({names[k].name, names[k].unit, values[k]});
        return all;
    }
};

/// Writes particles_NNNNNN.dat (and .vtp): all of them, or a random sample of about
/// most_particles_written.
/// note:   positions are those inside of a periodic mesh
inline void write_particles(const common::Snapshot& at_time, const Case& parameters,
                            const Assembly& all) {
    const Particles& at = all.particles;
    const Mesh mesh = parameters.problem.mesh();
    const double length = mesh.length_x();
    const long every = (at.count() + most_particles_written - 1) / most_particles_written;
    std::vector<long> shown, grain_of;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        for (long p = all.grains[g].begin; p < all.grains[g].end; ++p) {
            if (every > 1 && !(common::uniform(7, 7, p, 0) * double(every) < 1)) continue;
            shown.push_back(p), grain_of.push_back(long(g));
        }
    }
    std::vector<std::vector<double>> data;
    std::vector<common::ScalarColumn> columns;
    const auto add = [&](const char* name, const char* unit, const auto& value) {
        std::vector<double>& column = data.emplace_back();
        for (const long p : shown) column.push_back(value(p));
        columns.push_back({name, unit, column});
    };
    const auto add_plain = [&](const char* name, const char* unit,
                               const std::vector<double>& values) {
        add(name, unit, [&](long p) { return values[p]; });
    };
    add("x", "length", [&](long p) {
        const double x = at.x_p[p];
        return mesh.periodic_x ? x - length * std::floor((x - mesh.x_low) / length) : x;
    });
    add_plain("y", "length", at.y_p);
    add_plain("v_x", "velocity", at.vx_p);
    add_plain("v_y", "velocity", at.vy_p);
    columns.push_back({"grain", "", data.emplace_back(grain_of.begin(), grain_of.end())});
    add_plain("s_xx", "stress", at.sxx_p);
    add_plain("s_yy", "stress", at.syy_p);
    add_plain("s_xy", "stress", at.sxy_p);
    add_plain("s_zz", "stress", at.szz_p);
    add_plain("V", "volume", at.V_p);
    add_plain("plastic_strain", "1", at.yield_p);
    common::Snapshot sample = at_time;
    sample.particles = at.count();
    common::write_table(sample, "particles", columns);
    if (at_time.also.vtk) {
        const std::vector<double> zero(shown.size(), 0.0);
        common::write_vtp(at_time, "particles", {"position", "length", data[0], data[1], zero},
                          {columns.begin() + 4, columns.end()},
                          {{"velocity", "velocity", data[2], data[3], zero}});
    }
}

/// Writes grains_NNNNNN.dat, one line per grain: number, center of mass, mean velocity, mass, mean
/// stress over the grain, whether rigid.
inline void write_grains(const common::Snapshot& at_time, const Assembly& all) {
    const Particles& at = all.particles;
    Table table;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        const Grain& grain = all.grains[g];
        double m = 0, V = 0, x = 0, y = 0, vx = 0, vy = 0, sxx = 0, syy = 0, sxy = 0;
        for (long p = grain.begin; p < grain.end; ++p) {
            m += at.m_p[p], x += at.m_p[p] * at.x_p[p], y += at.m_p[p] * at.y_p[p];
            vx += at.m_p[p] * at.vx_p[p], vy += at.m_p[p] * at.vy_p[p];
            V += at.V_p[p], sxx += at.V_p[p] * at.sxx_p[p], syy += at.V_p[p] * at.syy_p[p];
            sxy += at.V_p[p] * at.sxy_p[p];
        }
        common::Row row;
        row.add("grain", "", double(g));
        row.add("x", "length", x / m);
        row.add("y", "length", y / m);
        row.add("v_x", "velocity", vx / m);
        row.add("v_y", "velocity", vy / m);
        row.add("mass", "mass", m);
        row.add("s_xx", "stress", sxx / V);
        row.add("s_yy", "stress", syy / V);
        row.add("s_xy", "stress", sxy / V);
        row.add("rigid", "", grain.rigid ? 1 : 0);
        table.add(row);
    }
    common::write_table(at_time, "grains", table.columns());
}

/// Writes a raster for gnuplot: columns x y stress_difference pressure grain, an empty line after
/// each row of pixels. Between the grains stand NaN NaN -1: pictures need every pixel, and a script
/// asks column 5, for an expression of NaN is undefined whatever it says.
/// exact: places have ten digits and stresses six, enough for a picture; on failure nothing appears
///        under `path`
inline void write_fringes(const common::Snapshot& at_time, const FringeRaster& raster) {
    const auto digits = [](double value, int precision) {
        char text[32];
        const auto end =
            std::to_chars(text, text + sizeof text, value, std::chars_format::general, precision);
        return std::string(text, end.ptr);
    };
    std::vector<std::string> columns;
    for (long i = 0; i < raster.x.count; ++i) columns.push_back(digits(raster.x.at(i), 10) + " ");

    common::OutputFile file(at_time.path("fringes", "dat"));
    common::writers_detail::begin_table(file,
                                        {{"x", "length", {}},
                                         {"y", "length", {}},
                                         {"stress_difference", "stress", {}},
                                         {"pressure", "stress", {}},
                                         {"grain", "", {}}},
                                        &at_time);
    for (long j = 0; j < raster.y.count; ++j) {
        const std::string y = digits(raster.y.at(j), 10) + " ";
        for (long i = 0; i < raster.x.count; ++i) {
            const std::size_t pixel = raster.pixel(i, j);
            file.text(columns[i]);
            file.text(y);
            if (raster.grain[pixel] < 0) {
                file.text("NaN NaN -1\n");
                continue;
            }
            file.text(digits(raster.stress_difference[pixel], 6) + " ");
            file.text(digits(raster.pressure[pixel], 6) + " ");
            file.number(long(raster.grain[pixel]));
            file.text("\n");
        }
        file.text("\n");
    }
    file.finish();
}

/// Writes fringes_NNNNNN.dat: the principal stress difference of elastic grains on pixels.
inline void write_fringe_raster(const common::Snapshot& at_time, const Case& parameters,
                                const Assembly& all) {
    write_fringes(at_time, draw_fringes(all.particles, all.grains, parameters.problem.mesh(),
                                        int(parameters.pixels_per_cell)));
}

/// Writes pack.txt: the grains of the case, to be read again as a pack of kind "file".
inline void write_pack_of(const std::string& folder, const Case& parameters) {
    std::vector<PackedGrain> grains;
    for (const PlannedGrain& plan :
         plan_grains(parameters.problem, materials_of(parameters.problem)))
        grains.push_back({plan.name, plan.outline});
    write_pack(folder + "pack.txt", grains);
}

}  // namespace mpm
