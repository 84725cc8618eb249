// Everything a case file of mpm_explicit can say: the problem (problem.hpp), and how it is solved,
// compared and written. mpm_implicit adds its theta scheme in its own case.hpp.
#pragma once

#include <string>
#include <vector>

#include "common/run/output_file.hpp"
#include "mpm_explicit/setup/problem.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// All parameters of a case, as the user gives them.
struct Case {
    Problem problem;

    double alpha = 0.25, dt = 0, end = 2;
    double energy_limit = 10;

    std::string shape = "linear", transfer = "flip";
    double flip = 1, crossing = 0.5;
    bool frozen = false;

    // What the run is compared with.
    std::string compare = "none";
    std::string grain, plate;  // the target grain, and the rigid one whose load counts
    double tolerance = 0.05;

    // How often [time]; 0: never.
    double particles_interval = 0, fringes_interval = 0, grains_interval = 0;
    long history_steps = 1;
    long pixels_per_cell = 8;
    bool pack = false;
    common::FileFormats also;
    long checkpoint_steps = 0;

    /// The shape function.
    Scheme scheme() const {
        return {shape == "linear" ? Scheme::linear
                : shape == "gimp" ? Scheme::gimp
                                  : Scheme::quadratic,
                0.5 / double(problem.per_side)};
    }
    /// What particles take from the nodes.
    Transfer transfers() const {
        return {transfer == "apic"   ? Transfer::affine
                : transfer == "spin" ? Transfer::spin
                                     : Transfer::none,
                transfer == "pic" || transfer == "apic" ? 0 : flip,
                shape == "linear" ? crossing : 0};
    }
};

/// Adds what every scheme asks for to a program's table: problem, time, method.
inline void describe_case(common::ParameterTable& table, Case& parameters) {
    using common::above, common::at_least;
    describe_problem(table, parameters.problem);
    table.group("time");
    table.real("time.alpha", parameters.alpha, "", above(0),
               "CFL number: dt <= alpha h/(c_p + |v|), of the fastest sound and the fastest grain");
    table.real("time.dt", parameters.dt, "time", at_least(0),
               "time step; 0: the largest of which a whole number ends at time.end");
    table.real("time.end", parameters.end, "time", at_least(0), "length of the run");
    table.real("time.energy_limit", parameters.energy_limit, "", at_least(0),
               "the run fails when the energy is this many times what was put in; 0: never");

    table.group("method");
    table.choice("method.shape", parameters.shape, {"linear", "gimp", "quadratic"},
                 "shape function");
    table.real("method.flip", parameters.flip, "", common::between(0, 1),
               "share of FLIP: 1 increments velocities, 0 replaces them (PIC)");
    table.flag("method.frozen", parameters.frozen,
               "particles keep their places: small oscillations");
}

/// Adds comparison and output, and says what may change on restart, the end of the run included.
/// in:     comparison_names, the choices of theory.compare
inline void describe_output(common::ParameterTable& table, Case& parameters,
                            const std::vector<std::string>& comparison_names) {
    using common::at_least, common::between;
    table.group("comparison with theory");
    table.choice("theory.compare", parameters.compare, comparison_names,
                 "what the run is compared with");
    table.text("theory.grain", parameters.grain,
               "the target grain; empty: the first that is not rigid");
    table.text("theory.plate", parameters.plate,
               "the rigid grain whose load counts; empty: mean of all");
    table.real("theory.tolerance", parameters.tolerance, "", between(0, 10),
               "of the result, relative");

    table.group("output");
    table.whole("output.history_steps", parameters.history_steps, "step", between(1, 1e9),
                "steps between rows of the history");
    table.real("output.particles_interval", parameters.particles_interval, "time", at_least(0),
               "time between particles files; 0: none");
    table.real("output.fringes_interval", parameters.fringes_interval, "time", at_least(0),
               "time between rasters of the principal stress difference; 0: none");
    table.whole("output.pixels_per_cell", parameters.pixels_per_cell, "", between(1, 64),
                "of the raster");
    table.real("output.grains_interval", parameters.grains_interval, "time", at_least(0),
               "time between files with one line per grain; 0: none");
    table.flag("output.pack", parameters.pack,
               "pack.txt: the grains at the start, to be read again");
    table.flag("output.vtk", parameters.also.vtk, "also write .vtp for ParaView");
    table.flag("output.openpmd", parameters.also.openpmd, "also write .h5, HDF5 after openPMD");
    table.whole("output.checkpoint_steps", parameters.checkpoint_steps, "", between(0, 1e9),
                "steps between checkpoints; 0: only when stopped");

    table.renamed({{"mesh.origin_x", "grid.low_x"},
                   {"mesh.origin_y", "grid.low_y"},
                   {"mesh.", "grid."},
                   {"walls.", "boundary."},
                   {"solver.most_iterations", "solver.max_iterations"},
                   {"solver.most_loops", "solver.max_outer_iterations"}});
    table.may_change_on_restart({"time.end", "output.particles_interval", "output.fringes_interval",
                                 "output.grains_interval", "output.pixels_per_cell", "output.vtk",
                                 "output.openpmd", "output.checkpoint_steps"});
}

}  // namespace mpm

namespace mpm_explicit {

using namespace mpm;

/// The table of all parameters.
inline common::ParameterTable describe(Case& parameters,
                                       const std::vector<std::string>& comparison_names) {
    common::ParameterTable table;
    describe_case(table, parameters);
    table.choice("method.transfer", parameters.transfer, {"flip", "pic", "apic", "spin"},
                 "what particles take from nodes: changes of velocity (flip), velocities (pic), "
                 "with their gradients (apic); changes, and the spin around them (spin)");
    table.real(
        "method.crossing", parameters.crossing, "", common::between(0, 1),
        "linear shapes: share of the cell that it leaves in the strain of a particle that crosses "
        "a line of nodes, and nodes of small mass are held; 0: the slide's, which makes energy");
    table.whole(
        "contact.levels", parameters.problem.contact.levels, "", common::between(1, 2),
        "2: contact acts on v_i^0 and v_i^1; 1: on v_i^1 alone, which bursts grains at rest");
    describe_output(table, parameters, comparison_names);
    return table;
}

}  // namespace mpm_explicit
