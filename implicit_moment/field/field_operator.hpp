// The operator of the field equations, A E = (1 + S chi S) E + a^2 curl curl E.   [IMM-10]
//
// Applied, E visits the places of the mesh:
//
//     E  edges, nodes --curl--> B  z-edges, faces, x-edges --curl--> edges, nodes   times a^2
//     E  --smooth S--> as particles feel it --chi--> their current --smooth S--> as the field sees it
//
// chi is a 3 x 3 tensor on nodes (predict_current.hpp), or 4 pi theta dt times the mass matrix
// (mass_matrix.hpp); S is the smoothing; walls enter through the ghosts. A is never built as a matrix.
#pragma once

#include <array>
#include <string>

#include "common/gmres.hpp"
#include "common/newton_krylov.hpp"
#include "implicit_moment/field/apply_mass_matrix.hpp"
#include "implicit_moment/field/waves.hpp"
#include "implicit_moment/predict_current.hpp"

namespace implicit_moment {

/// How the field equations are solved.
struct FieldSettings {
    std::string response = "moments";    // or "mass_matrix": the current that E drives
    std::string rotation = "particles";  // or "mesh": what R of [IMM-12] turns, with moments
    std::string B_level =
        "by_response";             // or "start", "middle": time of the B that rotates particles
    std::string solver = "gmres";  // or "newton_krylov"
    double theta = 0.5;            // time level of E
    double tolerance = 0;          // residual over right-hand side; 0: what the response needs
    long max_iterations = 200;
    SmoothingSettings smoothing;

    bool uses_mass_matrix() const { return response == "mass_matrix"; }
    // A plasma that drifts with V needs it: rotated in B^n, its own current drives transverse waves at the rate
    // omega_p V/2c, which conservation of energy does not exclude.
    bool rotates_in_the_middle() const {
        return B_level == "middle" || (B_level == "by_response" && uses_mass_matrix());
    }
    bool rotates_on_mesh() const { return rotation == "mesh"; }
    // With the mass matrix the energy is as exact as the solution.
    double solved_to() const {
        return tolerance > 0 ? tolerance : uses_mass_matrix() ? 1e-12 : 1e-8;
    }
};

/// The room in which the field equations are solved: nothing of it is state, or is read before it is
/// written in the same step, but for the zeros of places that no loop writes.
struct FieldSolver {
    Grid grid;
    FieldSettings settings;
    NodeWaves waves;
    PlasmaResponse response;  // of the moments
    MassMatrix mass;          // of the particles themselves, where the case asks for it
    Field gauss;              // G^{n+theta} of solve_field.hpp
    Field scratch;
    VectorField source, ghosted, curl_E, chi_E;
    FieldWaves field_waves;                     // for the preconditioner,
    std::array<std::vector<float>, 9> inverse;  // the inverse of each of them, by entry,
    std::array<std::vector<float>, 2> half_z;   // and e^{-i k dz/2}
    common::GmresWorkspace krylov;
    common::NewtonWorkspace newton;

    FieldSolver(const Grid& g, const FieldSettings& s)
        : grid(g),
          settings(s),
          waves(g),
          response(g),
          mass(g),
          gauss(Field::Zero(g.size())),
          scratch(Field::Zero(g.size())),
          source(g),
          ghosted(g),
          curl_E(g),
          chi_E(g),
          field_waves(g) {
        krylov.components = newton.linear.components = 3;
    }
};

/// out = (1 + S chi S) E + a^2 curl curl E on the unknowns of E, zero elsewhere.
/// in:     a = c theta dt; E, any values where no unknowns are; solver.response.chi or solver.mass.
/// note:   particles feel the smoothed field and their current is smoothed; with chi between the
///         same two smoothings the predicted current does the work that the particles receive.
inline void apply_field_operator(FieldSolver& solver, double a, const Eigen::VectorXd& E,
                                 Eigen::VectorXd& out) {
    const Grid& grid = solver.grid;
    const SmoothingSettings& smoothing = solver.settings.smoothing;
    VectorField &ghosted = solver.ghosted, &curl_E = solver.curl_E, &chi_E = solver.chi_E;
    const long m = grid.size();
    const double* e = E.data();
    double *copy = ghosted.all.data(), *sum = out.data();
    for_each_point(grid, [=](long n) {
        copy[n] = e[n], copy[n + m] = e[n + m], copy[n + 2 * m] = e[n + 2 * m];
    });
    fill_ghosts(grid, electric, ghosted);
    curl_of_electric(grid, ghosted.all.data(), curl_E.all.data());
    fill_ghosts(grid, magnetic, curl_E);
    curl_of_magnetic(grid, curl_E.all.data(), out.data());
    if (mirrors_plasma(grid)) fill_ghosts(grid, felt(grid), ghosted);
    smooth(grid, felt(grid), smoothing, ghosted.all.data(), solver.scratch);
    if (solver.settings.uses_mass_matrix()) {
        apply_mass_matrix(grid, solver.mass, ghosted.all.data(), chi_E.all.data());
    } else {
        apply_tensor(grid, solver.response.chi, ghosted.all.data(), false, solver.response.scratch,
                     chi_E.all.data());
        fill_ghosts(grid, felt(grid), chi_E);
    }
    smooth(grid, felt(grid), smoothing, chi_E.all.data(), solver.scratch);
    const double by_current = solver.settings.uses_mass_matrix() ? 4 * pi * a / c : 1;
    const double* driven = chi_E.all.data();
    const auto add = [=](long n) { sum[n] = e[n] + by_current * driven[n] + a * a * sum[n]; };
    for_each_point(grid, [=](long n) { add(n), add(n + m), add(n + 2 * m); });
    keep_unknowns(grid, out.data());
}

}  // namespace implicit_moment
