// Runs whose result is a profile: Riemann's problem, shocks at walls, blasts, falling gas; and
// vortices.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/run/writers.hpp"
#include "flip/theory/finished_run.hpp"

namespace flip {

/// Two gases that met at a plane, against the exact solution in the cells.
///   L1(q) = dx/L sum_i |q_i - mean of the exact q over cell i|
/// note:   cells to which the ends of the mesh could have sent a signal are compared all the same
inline void compare_riemann(const FinishedRun& run) {
    const Case& w = run.w;
    const double t = run.state.time;
    if (!(t > 0)) return;
    const theory::RiemannSolution exact = riemann_of(w);
    const std::string source = "exact solution of Riemann's problem";
    const std::vector<double> rho = mean_over_z(w.grid, run.cells.rho),
                              vx = mean_over_z(w.grid, run.cells.vx),
                              p = mean_over_z(w.grid, run.cells.p),
                              e = mean_over_z(w.grid, run.cells.e);
    std::vector<double> x, u, rho_exact, u_exact, p_exact, e_exact;
    double density = 0, velocity = 0, star = 0, star_cells = 0;
    const double dx = w.grid.x.spacing(), cells = static_cast<double>(w.grid.x.cells);
    for (std::size_t n = 0; n < rho.size(); ++n) {
        x.push_back(w.grid.x.at(static_cast<double>(n) + 0.5) - w.frame_x * t);
        u.push_back(vx[n] - w.frame_x);
        const double xi = (x[n] - w.interface) / t, half = 0.5 * dx / t;
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
    run.summary.result("L1_density", density / std::max(w.left.density, w.right.density), "", 0,
                       w.theory_tolerance, source + "; relative to the larger density");
    const double jump = std::fabs(exact.left_contact - exact.left.velocity) +
                        std::fabs(exact.right_contact - exact.right.velocity);
    run.summary.result_info("L1_velocity", velocity, "velocity", source);
    run.summary.result_info("L1_velocity_over_jump", jump > 0 ? velocity / jump : 0, "",
                            "relative to the changes of velocity");

    // The gases keep apart where their particles do.
    const Particles& particles = run.state.particles;
    double left = -std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < particles.x_p.size(); ++k) {
        if (particles.material[k] == 0) left = std::max(left, particles.x_p[k]);
        if (particles.material[k] == 1) right = std::min(right, particles.x_p[k]);
    }
    const double contact = w.interface + 0.5 * (exact.left_contact + exact.right_contact) * t;
    if (std::isfinite(left) && std::isfinite(right) && !exact.has_void) {
        run.summary.result("contact_position", 0.5 * (left + right) - w.frame_x * t, "length",
                           contact, std::max(2 * dx, 0.02 * std::fabs(contact - w.interface)),
                           source + "; middle between the particles of both gases");
        run.summary.result_info("contact_overlap", (left - right) / dx, "dx",
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

/// Gas that has run into a wall: the plateau behind the shock, and how fast the shock moves off.
inline void compare_struck_wall(const FinishedRun& run) {
    const Case& w = run.w;
    const StruckWall wall = struck_wall(w);
    const double dx = w.grid.x.spacing(), R = wall.shock.speed_from_wall * run.state.time;
    const std::string source = "balance of mass, momentum and energy across the shock";
    const detail::FromWall profile = detail::from_wall(w, run.cells);
    const double from = std::max(0.2 * R, 6 * dx), to = R - std::max(0.15 * R, 5 * dx);
    double count = 0, sum = 0, squares = 0;
    std::vector<double> exact;
    for (std::size_t n = 0; n < profile.rho.size(); ++n) {
        exact.push_back(profile.distance[n] < R ? wall.shock.density : wall.density);
        if (profile.distance[n] < from || profile.distance[n] > to) continue;
        count += 1, sum += profile.rho[n], squares += profile.rho[n] * profile.rho[n];
    }
    if (w.compare == "piston" && std::isfinite(wall.shock.mach))
        run.summary.result_info("theory_mach", wall.shock.mach, "", source);
    if (count > 0) {
        const double mean = sum / count;
        run.result("density_behind_shock", mean, "mass/length^3", wall.shock.density, source);
        run.summary.result_info("density_scatter",
                                std::sqrt(std::max(0.0, squares / count - mean * mean)),
                                "mass/length^3", "rms over the cells behind the shock");
    }
    const auto times = run.history.column("time"), distance = run.history.column("shock_distance");
    run.result("shock_speed", slope(times, distance, times.size() / 2), "velocity",
               wall.shock.speed_from_wall, source + "; from the wall, in the second half");
    run.summary.result("shock_distance", distance.back(), "length",
                       wall.shock.speed_from_wall * times.back(),
                       std::max(3 * dx, w.theory_tolerance * R), source);
    run.summary.result_info("wall_density_over_theory", profile.rho[0] / wall.shock.density, "",
                            "wall heating: the cell at the wall");
    common::write_table(run.profile, {{"distance", "length", profile.distance},
                                      {"rho", "mass/length^3", profile.rho},
                                      {"rho_exact", "mass/length^3", exact}});
}

/// The blast wave against Sedov's solution.
inline void compare_sedov(const FinishedRun& run) {
    const Case& w = run.w;
    const Blast blast = blast_of(w);
    const double t = run.state.time, R = blast.radius(t);
    const std::string source = "Sedov's similarity solution";
    const double radius = run.history.column("shock_radius").back(),
                 R_then = blast.radius(run.history.column("time").back());
    run.result("shock_radius", radius, "length", R_then,
               source + "; outer half height of the density");
    const RadialProfile profile = radial_profile(w, run.cells, blast.x, blast.z);
    std::vector<double> rho_exact, v_exact, p_exact;
    const double D = t > 0 ? theory::blast_speed(blast.wave, blast.energy, blast.density, t) : 0;
    for (const double r : profile.r) {
        const theory::BlastPoint at = theory::blast_point(blast.wave, R > 0 ? r / R : 2);
        rho_exact.push_back(blast.density * at.density);
        v_exact.push_back(D * at.velocity);
        p_exact.push_back(blast.density * D * D * at.pressure);
    }
    const double peak = *std::max_element(profile.rho.begin(), profile.rho.end());
    run.summary.result_info("peak_density_ratio", peak / blast.density, "",
                            "exact: " + format((blast.wave.gamma + 1) / (blast.wave.gamma - 1)));
    common::write_table(run.profile, {{"r", "length", profile.r},
                                      {"rho", "mass/length^3", profile.rho},
                                      {"v_r", "velocity", profile.v_r},
                                      {"p", "pressure", profile.p},
                                      {"rho_exact", "mass/length^3", rho_exact},
                                      {"v_exact", "velocity", v_exact},
                                      {"p_exact", "pressure", p_exact}});
}

/// Cold gas that falls into a plane or a line. In the plane every method of this kind is known to
/// err near the middle, so that what it gives there stands beside theory without a verdict.
inline void compare_noh(const FinishedRun& run) {
    const Case& w = run.w;
    const RegionCase& region = region_with_flow(w, "radial");
    const theory::NohProblem noh = noh_of(w);
    const double t = run.state.time, R = theory::noh_shock_radius(noh, t);
    const theory::NohState behind = theory::noh_state(noh, 0.5 * R, std::max(t, 1e-300));
    const std::string source = "Noh's exact solution";
    const RadialProfile profile = radial_profile(w, run.cells, region.center_x, region.center_z);
    double sum = 0, area = 0;
    std::vector<double> exact;
    for (std::size_t n = 0; n < profile.r.size(); ++n) {
        const double r = profile.r[n];
        exact.push_back(t > 0 ? theory::noh_state(noh, r, t).density : noh.density);
        if (r < 0.3 * R || r > 0.8 * R) continue;
        const double ring = noh.dimension == 2 ? r : 1;
        sum += ring * profile.rho[n], area += ring;
    }
    const double plateau = area > 0 ? sum / area : 0;
    const double radius = run.history.column("shock_radius").back(),
                 R_then = theory::noh_shock_radius(noh, run.history.column("time").back());
    if (noh.dimension == 1) {
        run.result("plateau_density", plateau, "mass/length^3", behind.density, source);
        run.result("shock_radius", radius, "length", R_then, source);
    } else {
        run.summary.result_info("plateau_density_over_theory", plateau / behind.density, "",
                                source + ": " + format(behind.density));
        run.summary.result_info("shock_radius_over_theory", R_then > 0 ? radius / R_then : 0, "",
                                source + ": " + format(R_then));
    }
    run.summary.result_info("middle_density_over_theory", profile.rho[0] / behind.density, "",
                            "wall heating: the ring in the middle");
    common::write_table(run.profile, {{"r", "length", profile.r},
                                      {"rho", "mass/length^3", profile.rho},
                                      {"v_r", "velocity", profile.v_r},
                                      {"p", "pressure", profile.p},
                                      {"rho_exact", "mass/length^3", exact}});
}

/// Gresho's vortex, which should turn for ever: what one turn leaves of it.
///   kept = (at the end / at the start)^(turn / duration)
inline void compare_gresho(const FinishedRun& run) {
    const Case& w = run.w;
    const RegionCase& region = region_with_flow(w, "gresho");
    const double t = run.state.time, turn = pi * region.width / region.speed;
    if (!(t > 0)) return;
    const std::string source = "exact: it turns for ever; of one turn";
    const auto times = run.history.column("time");
    if (!(times.back() > 0)) return;
    const auto kept = [&](const char* name) {
        const auto values = run.history.column(name);
        const double ratio = values.back() / values.front();
        return ratio > 0 ? std::pow(ratio, std::fabs(turn) / times.back()) : 0.0;
    };
    run.summary.result("kinetic_energy_kept", kept("kinetic_in_frame"), "", 1, w.theory_tolerance,
                       source);
    run.summary.result("angular_momentum_kept", kept("swirl"), "", 1, w.theory_tolerance, source);
    run.summary.result_info("turns", t / std::fabs(turn), "", "of the core");
    run.summary.result_info("largest_divergence", run.history.largest("divergence"), "speed/dx",
                            "after the implicit pressure");
    const RadialProfile profile =
        radial_profile(w, run.cells, region.center_x + w.frame_x * t,
                       region.center_z + w.frame_z * t, w.frame_x, w.frame_z);
    std::vector<double> exact;
    for (const double r : profile.r)
        exact.push_back(region.speed * detail::gresho(2 * r / region.width).v);
    common::write_table(run.profile, {{"r", "length", profile.r},
                                      {"v_phi", "velocity", profile.v_phi},
                                      {"v_r", "velocity", profile.v_r},
                                      {"p", "pressure", profile.p},
                                      {"v_exact", "velocity", exact}});
}

/// A disk that turns rigidly in a trap.
/// note:   PIC's transfer loses 2 h^2/(3 R^2) in each step; blends lose their part of that
inline void compare_rotation(const FinishedRun& run) {
    const Case& w = run.w;
    const RegionCase& region = region_with_flow(w, "rotation");
    const double rate = region.speed / region.width, h = w.grid.x.spacing();
    const double L = run.totals.angular_momentum / run.history.first("angular_momentum"),
                 K = run.totals.kinetic / run.history.first("kinetic");
    run.summary.result_info("revolutions", rate * run.state.time / (2 * pi), "", "of the disk");
    const bool keeps = run.program == "flip" && (w.transfer == "flip" || w.transfer == "apic");
    if (keeps) {
        const std::string source = "exact: rigid rotation for ever";
        run.summary.result("angular_momentum_kept", L, "", 1, w.theory_tolerance, source);
        run.summary.result("kinetic_energy_kept", K, "", 1, w.theory_tolerance, source);
        return;
    }
    std::string source = "measured; exact: 1";
    if (run.program == "flip" && w.transfer == "pic" && region.shape == "disk") {
        const double steps = static_cast<double>(run.history.column("time").size()) - 1;
        const double once = 1 - theory::round_trip_loss(h, region.radius);
        source = "measured; 2 h^2/(3 R^2) lost in each step leave " + format(std::pow(once, steps));
    }
    run.summary.result_info("angular_momentum_kept", L, "", source);
    run.summary.result_info("kinetic_energy_kept", K, "", source);
}

}  // namespace flip
