// A Gaussian of energy that flows over the mesh: how fast the method spreads it.
#pragma once

#include <complex>

#include "flip/theory/comparison.hpp"
#include "flip/theory/diffusion.hpp"

namespace flip {

/// Needs a Gaussian of energy in dust that flows over a periodic mesh in steps of one length.
inline void validate_diffusion(const Case& parameters, const Refusal& refuse) {
    validate_flow(parameters, refuse, "gaussian");
    validate_no_force(parameters, refuse);
    const RegionCase& r = region_with_flow(parameters, "gaussian");
    refuse(!parameters.grid.x.periodic, " needs periodic ends in x");
    refuse(parameters.dt == 0, " needs steps of one length: set time.dt");
    refuse(r.gas.velocity_x == 0, " needs a flow over the mesh: give region.", r.name,
           ".velocity_x");
    refuse(material_of(parameters, r).gamma != 1,
           " needs dust, whose energy has no pressure: set gamma = 1");
    refuse(parameters.plane() && !parameters.grid.z.periodic && !parameters.is(z_low, "slip"),
           " needs periodic ends or slip walls in z");
    refuse(r.amplitude == 0, " needs a blob: give region.", r.name, ".amplitude");
    refuse(10 * r.width > parameters.grid.x.length, " needs a mesh ten times as long as region.",
           r.name, ".width = ", r.width, ", and it is ", parameters.grid.x.length);
}

/// Middle and variance along x of the energy above that of the background.
struct Blob {
    double middle, variance;
};
/// The blob of a Gaussian.
/// note:   the phase of the first Fourier mode finds the middle across a periodic end
inline Blob blob_of(const Case& parameters, const CellFields& cells) {
    const RegionCase& r = region_with_flow(parameters, "gaussian");
    const double background =
        internal_energy(material_of(parameters, r), r.gas.density, r.gas.pressure);
    const Field above =
        cells.rho.cwiseProduct(cells.e - Field::Constant(parameters.grid.size(), background));
    const std::vector<double> heat = mean_over_z(parameters.grid, above);
    const common::Axis& axis = parameters.grid.x;
    const auto at = [&](std::size_t n) { return axis.at(double(n) + 0.5); };
    std::complex<double> turn = 0;
    for (std::size_t n = 0; n < heat.size(); ++n)
        turn += heat[n] * std::polar(1.0, 2 * pi * at(n) / axis.length);
    const double guess = std::arg(turn) / (2 * pi) * axis.length;
    double sum = 0, first = 0, second = 0;
    for (std::size_t n = 0; n < heat.size(); ++n) {
        const double d = apart(axis, guess, at(n));
        sum += heat[n], first += heat[n] * d, second += heat[n] * d * d;
    }
    const double mean = sum != 0 ? first / sum : 0;
    return {guess + mean, sum != 0 ? second / sum - mean * mean : 0};
}

/// The blob of t^n.
inline void track_diffusion(const Snapshot& now, common::Row& row) {
    const Blob blob = blob_of(now.parameters, now.cells);
    row.add("middle", "length", blob.middle);
    row.add("variance", "length^2", blob.variance);
}

/// The diffusivity.
///   variance' = 2 D
inline void compare_diffusion(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const double u = region_with_flow(parameters, "gaussian").gas.velocity_x,
                 dx = parameters.grid.x.spacing();
    const double unit = std::fabs(u) * dx, tolerance = parameters.theory_tolerance * 0.5;
    const double D =
        0.5 * common::slope(run.history.column("time"), run.history.column("variance")) / unit;
    if (run.history.rows() < 3)
        return run.not_measured("diffusivity", "the run has fewer than two steps: raise time.end");
    run.hint("the blob is ", region_with_flow(parameters, "gaussian").width / dx,
             " cells wide: below a dozen the mesh does not see it, so refine it or widen the blob; "
             "cells of few particles mix by another amount, so raise particles.per_cell_x");
    run.info("courant_number", std::fabs(u) * parameters.dt / dx, "", "|u| dt/dx");
    if (run.program != "pic") {
        run.summary.result("diffusivity", D, "u dx", 0, tolerance, "particles carry energy");
        return;
    }
    const double many = theory::harlow_diffusivity(u, dx, parameters.dt),
                 expected = parameters.loading == "lattice"
                                ? theory::harlow_lattice_diffusivity(u, dx, parameters.dt,
                                                                     int(parameters.per_cell_x))
                                : many;
    run.summary.result("diffusivity", D, "u dx", expected / unit, tolerance,
                       "cells mix what enters them");
    run.info("many_particles", many / unit, "u dx", "(1 - C)/2, with many particles in a cell");
}

inline constexpr Comparison diffusion_comparison{
    "diffusion", validate_diffusion, nullptr, nullptr, track_diffusion, compare_diffusion};

}  // namespace flip
