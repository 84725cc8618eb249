// Whole runs of a program of the material point method, without files for figures.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "tests/support/any_summary.hpp"

namespace facts {

/// Runs a case into a folder of its own. out: what it has left there.
/// in: name, of the folder; arguments, a case file and overrides; the exit status that is expected
inline Run run_mpm(const std::string& program, const std::string& name,
                   const std::string& arguments, int status = 0) {
    return run_into(name, program,
                    arguments +
                        " output.particles_interval=0 output.fringes_interval=0 "
                        "output.grains_interval=0",
                    status);
}

/// Blocks of two materials on one incline, each with a friction of its own against the plate, and
/// the case of the program: g (sin - mu cos).
inline void check_two_blocks(const std::string& program, double tolerance) {
    // The names of a pair in either order; what no pair has is friction 0.9, where both would
    // stick. With more than 0.3, sliding of an elastic block is not steady any more.
    const Run r = run_mpm(
        program, "pairs",
        program +
            "/cases/incline_block.toml theory.compare=none contact.friction=0.9 "
            "material.glass.E=1e6 material.glass.density=1000 grain.second.shape=box "
            "grain.second.x=1.2 grain.second.y=0.25 grain.second.width=0.4 "
            "grain.second.height=0.2 grain.second.material=glass pair.one.b=plate "
            "pair.one.friction=0.1 pair.two.a=plate pair.two.b=glass pair.two.friction=0.2");
    const auto& time = r.column("time");
    const std::size_t half = time.size() / 2;
    for (const auto& [block, mu] : {std::pair("block", 0.1), std::pair("second", 0.2)}) {
        const auto& p = r.column(std::string("momentum_x_") + block);
        const double acceleration = (p.back() - p[half]) / (80 * (time.back() - time[half])),
                     expected = 10 * (0.5 - mu * std::sqrt(0.75));
        CAPTURE(block);
        CHECK(std::fabs(acceleration - expected) <= tolerance * expected);
    }
}

/// A regular polygon with obtuse corners, eight cells across, stands on a rough plate as long as
/// its weight points into its base, tan theta < tan(pi/sides), wherever the corners are in their
/// cells.
inline void check_polygon_stands(const std::string& program, long sides, double tan_below,
                                 double tan_above, const std::string& more = "") {
    const double angle = std::numbers::pi / double(sides);
    REQUIRE((tan_below < std::tan(angle) && std::tan(angle) < tan_above));
    char text[400];
    for (const double x : {0.5, 0.5125}) {
        for (const double slope : {tan_below, tan_above}) {
            INFO(program << " " << sides << " sides, x = " << x << ", tan theta = " << slope);
            std::snprintf(text, sizeof text,
                          " grain.block.sides=%ld grain.block.angle=%g grain.block.x=%g "
                          "grain.block.y=%.15g load.gravity_x=%g ",
                          sides, 180 / double(sides) - 90, x, 0.15 + 0.1 * std::cos(angle),
                          10 * slope);
            const Run r = run_mpm(program, "stands",
                                  program +
                                      "/cases/incline_block.toml theory.compare=none "
                                      "grid.length_x=1 grid.cells_y=20 grain.block.shape=polygon "
                                      "grain.block.radius=0.1 grain.plate.x=0.5 "
                                      "grain.plate.width=1 load.gravity_y=-10 contact.friction=1 "
                                      "material.default.viscosity=2e-4 load.rise=0.3 time.end=0.6" +
                                      text + more);
            const double kinetic = r.column("kinetic").back();
            CHECK((slope == tan_below ? kinetic <= 1e-3 : kinetic >= 1));
        }
    }
}

/// A bond breaks between two rows, and the error of the time says so: where steps are too long for
/// the tolerance it is not measured. The strength is 2^-1/2 of the largest stress, so that w t =
/// pi/4.
inline void check_breaking_times(const std::string& program) {
    for (const std::string more :
         {"time.alpha=0.2", "time.alpha=0.5", "time.alpha=0.6", "time.alpha=0.66",
          "time.alpha=0.68", "time.alpha=0.7", "time.alpha=0.1 output.history_steps=4",
          "time.alpha=0.2 output.history_steps=4"}) {
        const Run r = run_mpm(program, "breaks_between",
                              program + "/cases/bonded_bar.toml --threads 1 " + more);
        const auto& breaks = r.summary["results"]["bond_breaks"];
        const auto& time = r.column("time");
        INFO(more << ": " << breaks.dump());
        const double error = breaks.value("error", 0.0), exact = 1.25, within = 0.03 * exact;
        CHECK(error == about(0.5 * (time[1] - time[0])));
        CHECK(breaks["verdict"] == (error <= within ? "PASS" : "NOT MEASURED"));
        CHECK(std::fabs(breaks["value"].get<double>() - exact) <= error + 0.01 * exact);
    }
}

/// A block between two wider rigid plates to which it is bonded, pulled slowly: the plates bear E times its strain
/// on its own width, whatever they would weigh and wherever they are on the mesh, and a bond breaks at its strength.
inline void check_pulled_block(const std::string& program) {
    std::filesystem::create_directories(folder_of_test());
    const std::string path = folder_of_test() + "/pulled.toml";
    std::ofstream(path)
        << "grid = {cells_x = 16, cells_y = 40, length_x = 0.4}\n"
           "load = {rise = 0.5, damping = 20}\ntime.end = 1.35\n"
           "[material]\nglass = {E = 1000, nu = 0, density = 1}\n"
           "steel = {law = 'rigid'}\n"
           "[grain]\nfloor = {shape = 'box', material = 'steel', x = 0.2, y = 0.15, "
           "width = 0.3, height = 0.1}\n"
           "block = {shape = 'box', material = 'glass', x = 0.2, y = 0.45, "
           "width = 0.2, height = 0.5}\n"
           "lid = {shape = 'box', material = 'steel', x = 0.2, y = 0.75, "
           "width = 0.3, height = 0.1, velocity_y = 0.001}\n"
           "[bond]\nall = {tension = 2}\n";
    for (const std::string more : {"", "material.steel.density=1", "grid.low_y=0.0125",
                                   "grid.low_x=0.006 grain.block.width=0.1"}) {
        CAPTURE(more);
        const Run r = run_mpm(program, "pulled", path + " " + more);
        const double width = more.ends_with("=0.1") ? 0.1 : 0.2;
        const auto &time = r.column("time"), &force = r.column("force_y_lid"),
                   &travel = r.column("travel_y_lid");
        // Plates between lines of nodes hold the half cells beside them, together a twentieth of the block.
        const double within = more == "grid.low_y=0.0125" ? 0.07 : 0.02;
        double largest = 0;
        for (std::size_t n = 0; n < time.size(); ++n) {
            largest = std::max(largest, -force[n] / width);
            if (time[n] < 0.5 || time[n] > 1) continue;
            CHECK(std::fabs(-force[n] / (1000 * width * travel[n] / 0.5) - 1) <= within);
        }
        CHECK(std::fabs(largest / 2 - 1) <= 0.01);
        CHECK(r.column("broken_bonds").back() >= 1);
    }
}

/// A cylinder of four cells in radius that rolls: what it may lose while its hops are expected.
inline void check_rolling(const Run& r) {
    check_results(r, 3);
    CHECK(std::fabs(r.value("acceleration") / (10 / 3.0) - 1) <= 0.07);
}

}  // namespace facts
