// Two gases that met at a plane, against the exact solution of Riemann's problem.
#pragma once

#include <limits>

#include "flip/theory/comparison.hpp"
#include "flip/theory/riemann.hpp"

namespace flip {

/// The Riemann problem of a case, in the frame of theory.
inline theory::RiemannSolution riemann_of(const Case& parameters) {
    const auto side = [&](const SideCase& s) {
        return theory::GasState{s.density, s.velocity - parameters.frame_x, s.pressure, s.gamma,
                                s.p_infinity};
    };
    return theory::solve_riemann(side(parameters.left), side(parameters.right));
}

/// Needs two half-spaces without gravity, and ends in x.
inline void validate_riemann(const Case& parameters, const Refusal& refuse) {
    refuse(parameters.setup != "riemann", " needs setup.kind = \"riemann\"");
    refuse(parameters.grid.x.periodic, " needs ends in x, and they are periodic: make them open");
    refuse(parameters.gravity_x != 0 || parameters.gravity_z != 0 || parameters.trap != 0,
           " is for fluid without gravity or trap");
    riemann_of(parameters);
}

/// Pressure and velocity between the waves.
inline std::string predict_riemann(const Case& parameters, const std::string&, double) {
    const theory::RiemannSolution s = riemann_of(parameters);
    return sentence("pressure ", s.left_of_contact.pressure, " and velocity ", s.left_contact,
                    " at the contact");
}

/// Warns where the waves leave the mesh before the end.
inline void warn_of_riemann(const Case& parameters, std::vector<std::string>& warnings) {
    const theory::RiemannSolution exact = riemann_of(parameters);
    const double left =
                     parameters.interface + (exact.left_head + parameters.frame_x) * parameters.end,
                 right = parameters.interface +
                         (exact.right_head + parameters.frame_x) * parameters.end;
    warn(warnings, left < parameters.grid.x.low || right > parameters.grid.x.high(),
         "at time.end the waves are at x = ", left, " and ", right,
         ", beyond the ends of the mesh, which the exact solution does not know");
}

/// Density, velocity, contact and pressure between the waves.
///   L1(q) = dx/L sum_i |q_i - mean of the exact q over cell i|
/// note:   cells to which the ends of the mesh could have sent a signal are compared all the same
inline void compare_riemann(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const double t = run.state.time;
    if (!(t > 0)) return;
    const theory::RiemannSolution exact = riemann_of(parameters);
    const std::string source = "exact solution of Riemann's problem";
    const std::vector<double> rho = mean_over_z(parameters.grid, run.cells.rho),
                              vx = mean_over_z(parameters.grid, run.cells.vx),
                              p = mean_over_z(parameters.grid, run.cells.p),
                              e = mean_over_z(parameters.grid, run.cells.e);
    std::vector<double> x, u, rho_exact, u_exact, p_exact, e_exact;
    double density = 0, velocity = 0, star = 0, star_cells = 0;
    const double dx = parameters.grid.x.spacing(),
                 cells = static_cast<double>(parameters.grid.x.cells);
    for (std::size_t n = 0; n < rho.size(); ++n) {
        x.push_back(parameters.grid.x.at(static_cast<double>(n) + 0.5) - parameters.frame_x * t);
        u.push_back(vx[n] - parameters.frame_x);
        const double xi = (x[n] - parameters.interface) / t, half = 0.5 * dx / t;
        const theory::Conserved mean = theory::mean_between(exact, xi - half, xi + half);
        const theory::GasState at = theory::sample(exact, xi);
        rho_exact.push_back(mean.mass);
        u_exact.push_back(mean.mass > 0 ? mean.momentum / mean.mass : at.velocity);
        p_exact.push_back(at.pressure);
        e_exact.push_back(at.density > 0 ? (at.pressure + at.gamma * at.p_infinity) /
                                               ((at.gamma - 1) * at.density)
                                         : 0);
        density += std::fabs(rho[n] - mean.mass) / cells;
        velocity += rho[n] > 0 ? std::fabs(u[n] - u_exact[n]) / cells : 0;
        // A few cells away from the waves.
        if (xi - 4 * half > exact.left_tail && xi + 4 * half < exact.right_tail)
            star += p[n], star_cells += 1;
    }
    run.absolute_result("L1_density",
                        density / std::max(parameters.left.density, parameters.right.density), "",
                        0, source + "; relative to the larger density");
    const double jump = std::fabs(exact.left_contact - exact.left.velocity) +
                        std::fabs(exact.right_contact - exact.right.velocity);
    run.info("L1_velocity", velocity, "velocity", source);
    run.info("L1_velocity_over_jump", jump > 0 ? velocity / jump : 0, "",
             "relative to the changes of velocity");

    // The gases keep apart where their particles do.
    const Particles& particles = run.state.particles;
    double left = -std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < particles.x_p.size(); ++k) {
        if (particles.material[k] == 0) left = std::max(left, particles.x_p[k]);
        if (particles.material[k] == 1) right = std::min(right, particles.x_p[k]);
    }
    const double contact =
        parameters.interface + 0.5 * (exact.left_contact + exact.right_contact) * t;
    if (std::isfinite(left) && std::isfinite(right) && !exact.has_void) {
        run.summary.result("contact_position", 0.5 * (left + right) - parameters.frame_x * t,
                           "length", contact,
                           std::max(2 * dx, 0.02 * std::fabs(contact - parameters.interface)),
                           source + "; middle between the particles of both gases");
        run.info("contact_overlap", (left - right) / dx, "dx",
                 "how far particles of one gas are among those of the other");
    }
    if (star_cells > 0)
        run.result("star_pressure", star / star_cells, "pressure", exact.left_of_contact.pressure,
                   source);
    common::write_table(run.profile, {{"x", "length", x},
                                      {"rho", "mass/length^3", rho},
                                      {"u", "velocity", u},
                                      {"p", "pressure", p},
                                      {"e", "velocity^2", e},
                                      {"rho_exact", "mass/length^3", rho_exact},
                                      {"u_exact", "velocity", u_exact},
                                      {"p_exact", "pressure", p_exact},
                                      {"e_exact", "velocity^2", e_exact}});
}

inline constexpr Comparison riemann_comparison{
    "riemann", validate_riemann, predict_riemann, warn_of_riemann,
    nullptr,   compare_riemann,  Rows::any,       Frame::moves_along_x};

}  // namespace flip
