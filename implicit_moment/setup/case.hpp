// Everything a case file of implicit_moment can say: plain values with their defaults, which are
// the GEM challenge. describe_case.hpp has their names, units and ranges.
#pragma once

#include <string>
#include <vector>

#include "common/grid.hpp"
#include "common/run/output_file.hpp"
#include "common/run/sentence.hpp"
#include "implicit_moment/explicit_em/boris_push.hpp"
#include "implicit_moment/move_particles.hpp"
#include "implicit_moment/solve_field.hpp"

namespace implicit_moment {

using common::format, common::refuse, common::sentence, common::warn;

/// A Harris current sheet, from which every plasma parameter follows; lengths in d_i, and
/// B0 = 1/(c/v_A).
struct HarrisCase {
    double mass_ratio = 25;         // m_i/m_e
    double light_over_alfven = 20;  // c/v_A at n0 and B0
    double temperature_ratio = 5;   // T_i/T_e
    double thickness = 0.5;         // lambda
    double background = 0.2;        // n_inf/n0
    double perturbation = 0.1;      // psi0/(B0 d_i)
    double guide_field = 0;         // B_y/B0, uniform
    double normal_field = 0;        // B_z/B0 in the middle row: a tail, see tail_sheet.hpp
    long particles = 200000;        // of both species together
    bool operator==(const HarrisCase&) const = default;
};

/// A thin Harris sheet in the plane of the current, where the lower-hybrid drift instability and
/// the kink live: x along the current, z across the sheet, the field along -+y; lengths in units of
/// the half-thickness L of B_y = -B0 tanh(z/L).
struct CurrentSheetCase {
    double mass_ratio = 180;        // m_i/m_e
    double light_over_alfven = 40;  // c/v_A at n0 and B0
    double temperature_ratio = 4;   // T_i/T_e
    double drift = 1;               // u_i/v_i, v_i = (2 T_i/m_i)^(1/2): L = rho_i/drift
    double background = 0.01;       // density at rest [n0]
    double length_x = 4;            // of the box [L]; these two set the lengths of the grid
    double length_z = 9;            // [L]
    long particles = 800000;        // of both species together
    bool operator==(const CurrentSheetCase&) const = default;
};

/// One species of a uniform plasma; the n-th component of a vector is _x, _y, _z.
struct SpeciesCase {
    std::string name;
    double density = 1;                                              // [n0]
    double charge = 1;                                               // [e]
    double mass = 1;                                                 // [m_i]
    double drift_x = 0, drift_y = 0, drift_z = 0;                    // v, or gamma v [c]
    double temperature_x = 0, temperature_y = 0, temperature_z = 0;  // [m_i c^2]
    double wave_x = 0, wave_y = 0, wave_z = 0;     // velocity amplitude of the seeded mode [c]
    double phase_x = 0, phase_y = 0, phase_z = 0;  // its phase [degrees]
    bool operator==(const SpeciesCase&) const = default;
};

/// A uniform plasma in uniform fields, with one seeded mode cos(k x + phase).
struct UniformCase {
    double B_x = 0, B_y = 0, B_z = 0;                 // [m_i c omega_pi / e]
    double E_x = 0, E_y = 0, E_z = 0;                 // at t = 0
    long particles_per_cell = 64;                     // of each species
    long mode_x = 1, mode_z = 0;                      // wave number in units of 2 pi / length
    double wave_B_x = 0, wave_B_y = 0, wave_B_z = 0;  // field amplitudes of the seeded mode
    double wave_E_x = 0, wave_E_y = 0, wave_E_z = 0;
    double phase_B_x = 0, phase_B_y = 0, phase_B_z = 0;  // [degrees]
    double phase_E_x = 0, phase_E_y = 0, phase_E_z = 0;
    std::vector<SpeciesCase> species;
    bool operator==(const UniformCase&) const = default;
};

/// A complete input of implicit_moment or of explicit_em. Lengths in d_i, times in 1/omega_pi,
/// velocities in c; see units.hpp.
struct Case {
    common::Grid grid{{64, -12.8, 25.6, true}, {64, -6.4, 12.8, false}};
    std::string boundary_x = "periodic", boundary_z = "wall";
    double dt = 0.3, end = 800;
    std::string setup = "harris", loading = "quiet";
    long seed = 1;
    HarrisCase harris;
    CurrentSheetCase current_sheet;
    UniformCase uniform;
    FieldSettings field;
    MoverSettings mover;
    LeapfrogSettings leapfrog;

    // What a uniform run is compared with.
    std::string wave = "none";      // which of wave_theory.hpp
    std::string component = "E_x";  // the field component whose seeded mode is followed
    double near = 0;  // frequency near which the root is looked for; 0: the fastest growing root

    // How often, in 1/omega_pi; 0: never.
    double fields_interval = 0, particles_interval = 0, profile_interval = 0;
    common::FileFormats also;
    long checkpoint_steps = 0;
    long history_steps = 1;  // steps from one row of history.dat to the next

    // The Harris sheet of which a case says nothing: its particles are those of the talk's two runs.
    HarrisCase initial_harris() const {
        HarrisCase h;
        if (leapfrog.chosen) h.particles = 9120000;
        return h;
    }
    // Which set-up it is: a Harris sheet seen across its current or along it, or a uniform plasma.
    bool is_across_current() const { return setup == "harris"; }
    bool is_along_current() const { return setup == "current_sheet"; }
    bool is_uniform() const { return setup == "uniform"; }
    // Whether u_p of the particles is gamma v.
    bool is_relativistic() const {
        return leapfrog.chosen ? leapfrog.relativistic : mover.relativistic;
    }
    // Whether the ends of a sheet across its current are walls.
    bool is_tail() const { return is_across_current() && !grid.x.periodic; }
};

}  // namespace implicit_moment
