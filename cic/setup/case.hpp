// Everything a case file of cic can say: plain values with their defaults. The plasma has none: its
// species are in the case file. What each value means stands in describe_case.hpp.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "cic/gather_field.hpp"
#include "cic/move_particles.hpp"
#include "cic/poisson.hpp"
#include "common/run/parameters.hpp"

namespace cic {

/// One species; the components of a vector are _x, _y, _z.
struct SpeciesCase {
    std::string name;
    double density = 1, charge = -1, mass = 1;
    std::string motion = "mobile";    // or fixed: a uniform background without particles
    std::string profile = "uniform";  // or layer, disk, point
    double center_x = 0, center_z = 0, half_width = 0;
    long particles_per_cell = 64;
    std::string loading = "quiet";  // or random, lattice
    double drift_x = 0, drift_y = 0, drift_z = 0;
    double temperature_x = 0, temperature_y = 0, temperature_z = 0;
    std::string start = "drift";  // or ExB: the drift in the field at t = 0
    long mode_x = 1, mode_z = 0;
    double amplitude = 0, ripple = 0;
    std::string wave = "standing";  // or traveling
    double emission = 0, emission_temperature = 1;

    bool mobile() const { return motion == "mobile"; }
};

/// What meets a wall.
struct WallCase {
    std::string field = "grounded";    // or floating
    std::string particles = "absorb";  // or reflect, and at x_low source
    double potential = 0;
};

/// A complete input; see units.hpp.
struct Case {
    common::Grid grid{{128, 0, 2 * pi / 0.6123724356957945, true}, {1, 0, 1, true}};
    long dimensions = 1;
    std::string boundary_x = "periodic", boundary_z = "periodic";
    std::array<WallCase, 4> walls;

    double dt = 0.1, end = 60;
    double energy_limit = 10;

    std::string weighting = "cic", conserving = "momentum", stencil = "five_point";
    double gauss_sign = 1;
    MagneticField B;
    long sort_interval = 25;
    long seed = 1;
    std::vector<SpeciesCase> species;

    // What the run is compared with.
    std::string compare = "none";  // see theory/comparisons.hpp
    std::string model = "plasma";  // or mesh
    long mode_x = 1, mode_z = 0;
    double near = 0;
    double growth_tolerance = 0.01, frequency_tolerance = 0.005;

    // How often, in 1/omega_p; 0: never.
    double fields_interval = 0, particles_interval = 0, phase_interval = 0;
    long modes = 0;
    long phase_bins_x = 128, phase_bins_v = 128;
    double phase_v_max = 0;
    bool spectrum = false, vtk = false;
    long checkpoint_steps = 0;

    /// The weighting, the scheme and the dimensions as numbers.
    Scheme scheme() const {
        return {weighting == "ngp" ? 0 : (weighting == "cic" ? 1 : 2), conserving == "energy",
                static_cast<int>(dimensions)};
    }
    bool magnetized() const { return B.size() > 0; }
    bool is_box() const { return boundary_x == "wall" && boundary_z == "wall"; }
    bool has_walls() const { return boundary_x == "wall" || boundary_z == "wall"; }
};

using common::format;

/// Words and numbers as one sentence.
template <class... Pieces>
std::string sentence(const Pieces&... pieces) {
    const auto text = [](const auto& piece) {
        using Piece = std::decay_t<decltype(piece)>;
        if constexpr (std::is_integral_v<Piece>)
            return std::to_string(piece);
        else if constexpr (std::is_floating_point_v<Piece>)
            return common::format(piece);
        else
            return std::string(piece);
    };
    return (text(pieces) + ...);
}

/// Ends the program with a sentence about impossible input.
template <class... Pieces>
void refuse(bool is_impossible, const Pieces&... pieces) {
    if (is_impossible) throw common::InputError(sentence(pieces...));
}

}  // namespace cic
