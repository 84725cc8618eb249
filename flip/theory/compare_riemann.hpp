// Two gases that met at a plane, against the exact solution of Riemann's problem.
#pragma once

#include <array>
#include <limits>

#include "flip/theory/comparison.hpp"
#include "flip/theory/riemann.hpp"

namespace flip {

/// The Riemann problem of a case, in the frame of theory. Liquids that hold no tension part at p = 0.
inline theory::RiemannSolution riemann_of(const Case& parameters) {
    const auto side = [&](const SideCase& s) {
        return theory::GasState{s.density, s.velocity - parameters.frame_x, s.pressure, s.gamma,
                                s.p_infinity};
    };
    const double tension = std::min(parameters.left.tension, parameters.right.tension);
    return theory::solve_riemann(side(parameters.left), side(parameters.right), -tension);
}

/// Needs two half-spaces without gravity, and ends in x.
inline void validate_riemann(const Case& parameters, const Refusal& refuse) {
    refuse(parameters.setup != "riemann", " needs setup.kind = \"riemann\"");
    refuse(parameters.grid.x.periodic, " needs ends in x, and they are periodic: make them open");
    validate_no_force(parameters, refuse);
    const double tension = std::min(parameters.left.tension, parameters.right.tension);
    refuse(tension > 0 && riemann_of(parameters).has_void,
           " knows no liquids that break: they part faster than the tension that both hold, ",
           tension, ", lets them: take tension = 0");
}

/// Pressure and velocity between the waves.
inline std::string predict_riemann(const Case& parameters, const std::string&, double) {
    const theory::RiemannSolution s = riemann_of(parameters);
    return sentence("pressure ", s.left_of_contact.pressure, " and velocity ", s.left_contact,
                    " at the contact");
}

/// Where the waves are at a time, and when the first of them leaves the mesh.
struct WaveEnds {
    double left, right, leaves;
    bool beyond(const Case& parameters) const {
        return left < parameters.grid.x.low || right > parameters.grid.x.high();
    }
};
inline WaveEnds wave_ends(const Case& parameters, double t) {
    const theory::RiemannSolution exact = riemann_of(parameters);
    const double left = exact.left_head + parameters.frame_x,
                 right = exact.right_head + parameters.frame_x, at = parameters.interface;
    const auto time = [](double way, double speed) {
        return way * speed > 0 ? way / speed : std::numeric_limits<double>::infinity();
    };
    return {at + left * t, at + right * t,
            std::min(time(parameters.grid.x.low - at, left),
                     time(parameters.grid.x.high() - at, right))};
}

/// Warns of an end of the mesh that sends a wave into a gas: a wall where the gas moves, an open end
/// where it comes in, one where it leaves slower than sound towards another pressure, and an inflow
/// that brings another state.
inline void warn_of_end(const Case& parameters, bool low, std::vector<std::string>& warnings) {
    const SideCase& s = low ? parameters.left : parameters.right;
    const BoundaryCase& end = parameters.boundaries[low ? x_low : x_high];
    if (s.density == 0) return;
    const double c = theory::sound_speed(
                     {s.density, s.velocity, s.pressure, s.gamma, s.p_infinity}),
                 outward = low ? -s.velocity : s.velocity, much = 1e-3;
    const GasCase& in = end.inflow;
    const bool open = end.kind == "open", flows = end.kind == "inflow",
               comes_in = outward < -much * c,
               same = std::fabs(in.density - s.density) <= much * s.density &&
                      std::fabs(in.pressure - s.pressure) <= much * s.density * c * c &&
                      std::fabs(in.velocity_x - s.velocity) <= much * c;
    const std::string name = low ? "x_low" : "x_high",
                      wave = ", sends a wave into the mesh that the exact solution does not know: ";
    const auto state = [](double density, double pressure, double velocity) {
        return sentence("density ", density, ", pressure ", pressure, ", velocity ", velocity);
    };
    if (flows)
        return warn(warnings, !same, "inflow.", name, " with ",
                    state(in.density, in.pressure, in.velocity_x), ", where the gas has ",
                    state(s.density, s.pressure, s.velocity), wave, "take that");
    warn(warnings, open ? comes_in : std::fabs(outward) > much * c, "boundary.", name, " = \"",
         end.kind, "\", where the gas moves with ", s.velocity, wave,
         comes_in ? sentence("take \"inflow\" with the gas of ", low ? "left" : "right")
                  : std::string("take \"open\""));
    warn(warnings,
         open && !comes_in && outward < c &&
             std::fabs(end.pressure - s.pressure) > much * s.density * c * c,
         "boundary.pressure_", name, " = ", end.pressure, ", where the gas has ", s.pressure, wave,
         "take that");
}

/// Warns of ends that send waves, where the waves leave the mesh before the end, and where they leave so
/// little between them that cells are empty, whose pressure is 0.
inline void warn_of_riemann(const Case& parameters, std::vector<std::string>& warnings) {
    for (const bool low : {true, false}) warn_of_end(parameters, low, warnings);
    const WaveEnds ends = wave_ends(parameters, parameters.end);
    warn(warnings, ends.beyond(parameters), "at time.end the waves are at x = ", ends.left, " and ",
         ends.right,
         ", beyond the ends of the mesh, which the exact solution does not know: lower time.end "
         "below ",
         ends.leaves, ", or lengthen the mesh");
    const theory::RiemannSolution s = riemann_of(parameters);
    const double left = s.left_of_contact.density / parameters.left.density,
                 right = s.right_of_contact.density / parameters.right.density,
                 along = double(parameters.per_cell_x) * std::min(left, right),
                 enough = double(parameters.per_cell_x) / along;
    warn(warnings, !s.has_void && along < 1, "between the waves a cell will have ", along,
         " particles along x, and one without any has no pressure: ",
         enough < 64 ? sentence("raise particles.per_cell_x above ", enough)
                     : std::string("take sides that part more slowly"));
}

/// A wave of the exact solution, and the gas that it has swept.
struct RiemannWave {
    std::string side;                // left or right
    theory::GasState front, behind;  // the gas before and after it
    double head, tail, contact;      // speeds
    double swept;                    // length, from its head to the contact
    /// The largest density and pressure of that gas.
    double density() const { return std::max(front.density, behind.density); }
    double pressure() const {
        return std::max(std::fabs(front.pressure), std::fabs(behind.pressure));
    }
    double jump_of_velocity() const { return std::fabs(behind.velocity - front.velocity); }
    /// The speed at which it has changed the pressure by a part of its whole change.
    double at_part(const theory::RiemannSolution& exact, double part) const {
        double low = head, high = tail;
        const double level = front.pressure + part * (behind.pressure - front.pressure);
        for (int n = 0; n < 60 && low != high; ++n) {
            const double middle = 0.5 * (low + high), p = theory::sample(exact, middle).pressure;
            ((p > level) == (front.pressure > level) ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }
};

/// Both waves at a time t > 0.
inline std::array<RiemannWave, 2> waves_of(const theory::RiemannSolution& s, double t) {
    return {{{"left", s.left, s.left_of_contact, s.left_head, s.left_tail, s.left_contact,
              (s.left_contact - s.left_head) * t},
             {"right", s.right, s.right_of_contact, s.right_head, s.right_tail, s.right_contact,
              (s.right_head - s.right_contact) * t}}};
}

/// The L1 error that is allowed to a wave, in cells times its jump: 1.5 times that of Godunov's
/// first-order method. Its shocks are three to four cells wide, its fans err by dx |log dx|; and it
/// diffuses waves so weak that they hardly steepen or spread, like sound.
///   1.5 max[1, 0.3 log2 n, min(sqrt(n), c/|du|)/2]
/// in:     wave; n, how many cells of gas it has swept
/// source: Tadmor and Tang, SIAM J. Numer. Anal. 36, 1739 (1999), for fans; the factors from a code
///         of that method, tests/support/godunov.hpp
inline double allowed_cells(const RiemannWave& wave, double n) {
    // [allowed]
    const double weakness =
        theory::sound_speed(wave.front) / std::max(wave.jump_of_velocity(), 1e-300);
    return 1.5 * std::max({1.0, 0.3 * std::log2(n), 0.5 * std::min(std::sqrt(n), weakness)});
    // [/allowed]
}

/// How far the pressure between the waves may be off beside a fan, as a part of what the fan changes:
/// 1.5 times the error of Godunov's method, 0.042/sqrt(n) at most. It smears the corner at the tail
/// as heat spreads, over sqrt(n) of the n cells.
inline double allowed_beside_fan(double n) { return 1.5 * 0.042 / std::sqrt(n); }

/// Within how many cells a shock and the contact are to be found; head and tail of a fan, within 1.5
/// times what is allowed to its L1 error.
inline constexpr double allowed_shift = 2, allowed_fan_shift = 1.5;

/// What to do where the contact lies in its cell: as measured, beside a liquid of a thousand times its
/// impedance a gas is 14 per cent too fast where that is the border of a cell, and 3 too slow in the middle.
/// in:     way, of the contact
/// out:    empty where it lies well, or has crossed cells
inline std::string hint_on_contact(const FinishedRun& run, const theory::RiemannSolution& exact,
                                   double way) {
    const auto impedance = [](const theory::GasState& s) {
        return s.density * theory::sound_speed(s);
    };
    const common::Axis& axis = run.parameters.grid.x;
    const double left = impedance(exact.left), right = impedance(exact.right),
                 ratio = std::max(left, right) / std::max(std::min(left, right), 1e-300),
                 dx = axis.spacing(), in_cells = (run.parameters.interface - axis.low) / dx,
                 off = std::fabs(in_cells - std::floor(in_cells) - 0.5);
    if (run.program != "flip" || exact.has_void || ratio < 100 || std::fabs(way) > dx || off < 0.2)
        return "";
    return sentence(
        "the contact has moved ", way / dx, " cells; as long as that is below 1 the ",
        "velocity of the lighter fluid depends on where it is in its cell, whatever ",
        "the mesh: put it in the middle, setup.interface = ", axis.at(std::floor(in_cells) + 0.5),
        "; if that is not all, keep flip.transfer ", "= \"flip\" and flip.mass = \"lumped\"");
}

/// The cells of a run along x, in the frame of theory, beside the exact solution.
struct RiemannProfile {
    theory::RiemannSolution exact;
    std::array<RiemannWave, 2> waves;
    double t, dx, interface;  // where the gases met
    double contact;           // its velocity; at a void that of the middle
    std::vector<double> x, rho, u, p, e;
    std::vector<double> rho_exact, u_exact;  // means over a cell
    std::vector<double> p_exact, e_exact;    // in its middle
    double xi(std::size_t n) const { return (x[n] - interface) / t; }
    int side(std::size_t n) const { return xi(n) > contact; }
    double change_of_velocity() const {
        double sum = 0;
        for (const RiemannWave& wave : waves)
            if (wave.front.density > 0) sum += wave.jump_of_velocity();
        return sum;
    }
};

inline RiemannProfile riemann_profile(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const theory::RiemannSolution exact = riemann_of(parameters);
    const double t = run.state.time, dx = parameters.grid.x.spacing(), half = 0.5 * dx / t;
    RiemannProfile profile{exact,
                           waves_of(exact, t),
                           t,
                           dx,
                           parameters.interface,
                           0.5 * (exact.left_contact + exact.right_contact),
                           {},
                           mean_over_z(parameters.grid, run.cells.rho),
                           mean_over_z(parameters.grid, run.cells.vx),
                           mean_over_z(parameters.grid, run.cells.p),
                           mean_over_z(parameters.grid, run.cells.e),
                           {},
                           {},
                           {},
                           {}};
    for (std::size_t n = 0; n < profile.rho.size(); ++n) {
        profile.x.push_back(parameters.grid.x.at(double(n) + 0.5) - parameters.frame_x * t);
        profile.u[n] -= parameters.frame_x;
        const double xi = profile.xi(n);
        const theory::Conserved mean = theory::mean_between(exact, xi - half, xi + half);
        const theory::GasState at = theory::sample(exact, xi);
        profile.rho_exact.push_back(mean.mass);
        profile.u_exact.push_back(mean.mass > 0 ? mean.momentum / mean.mass : at.velocity);
        profile.p_exact.push_back(at.pressure);
        profile.e_exact.push_back(at.density > 0 ? (at.pressure + at.gamma * at.p_infinity) /
                                                       ((at.gamma - 1) * at.density)
                                                 : 0);
    }
    return profile;
}

/// What a deviation is most likely due to.
inline std::string hint_on_riemann(const FinishedRun& run, const std::string& cells_swept) {
    const Case& parameters = run.parameters;
    std::string advice = advice_on_viscosity(parameters);
    if (parameters.per_cell_x < 64)
        advice += sentence(advice.empty() ? "" : ", and ", "more than ", parameters.per_cell_x,
                           " particles per cell along x");
    // Liquids that hold tension need particles that carry their volume, in flip.
    const bool holds = parameters.left.tension > 0 || parameters.right.tension > 0;
    if (advice.empty())
        advice = run.program == "pic" && !holds ? "flip" : "finer cells";
    else if (run.program == "pic" && !holds)
        advice +=
            ", or flip: pic converges on finer meshes only with more particles in their cells";
    if (run.program == "pic" && holds)
        advice +=
            ", or flip with flip.density = \"particles\": a liquid under tension needs particles "
            "that carry their volume";
    return sentence(cells_swept, ": below 15 raise time.end or refine the mesh; else take ", advice,
                    hint_on_viscosity(parameters));
}

/// Density, velocity and pressure, on each side of the contact by the scales of that side.
///   L1(q) = dx/swept sum_i |q_i - mean of the exact q over cell i| / largest q of that side
/// Densities of a side leave out the three cells next to the contact, whose mass may be that of
/// the other gas; the error of the whole mesh has them all. The mesh allows cells times jumps, and a
/// thousandth.
inline void judge_riemann_errors(const FinishedRun& run, const RiemannProfile& r) {
    const theory::RiemannSolution& exact = r.exact;
    double L1_rho = 0, L1_u = 0, L1_rho_of[2] = {0, 0}, L1_p_of[2] = {0, 0};
    for (std::size_t n = 0; n < r.x.size(); ++n) {
        const int side = r.side(n);
        const double rho_off = r.dx * std::fabs(r.rho[n] - r.rho_exact[n]),
                     beside = side ? r.xi(n) - exact.right_contact : exact.left_contact - r.xi(n);
        L1_rho += rho_off;
        L1_rho_of[side] += beside > 3 * r.dx / r.t ? rho_off : 0;
        L1_p_of[side] += r.dx * std::fabs(r.p[n] - r.p_exact[n]);
        L1_u += r.rho[n] > 0 ? r.dx * std::fabs(r.u[n] - r.u_exact[n]) : 0;
    }
    const std::string cells_swept = sentence("the waves have swept ", r.waves[0].swept / r.dx,
                                             " and ", r.waves[1].swept / r.dx, " cells"),
                      usual = hint_on_riemann(run, cells_swept);
    run.hint(usual);
    // A window as large as half of what it is relative to sees nothing.
    const auto judge = [&](const std::string& name, double value, double allowed,
                           const std::string& what) {
        if (allowed < 0.5) return run.summary.result("L1_" + name, value, "", 0, allowed, what);
        run.not_measured("L1_" + name, cells_swept,
                         ", too few for an error: raise time.end, or refine the mesh");
    };
    const double rho_left = exact.left_of_contact.density,
                 rho_right = exact.right_of_contact.density;
    double allowed_rho =  // at a void two surfaces
        1.5 * (exact.has_void ? rho_left + rho_right : std::fabs(rho_left - rho_right)),
           allowed_u = 0, swept = 0;
    for (const RiemannWave& wave : r.waves) {
        if (wave.front.density == 0) continue;
        const int side = &wave == &r.waves[1];
        const double cells = allowed_cells(wave, wave.swept / r.dx), per = r.dx / wave.swept,
                     jump = std::fabs(wave.behind.density - wave.front.density),
                     rise = std::fabs(wave.behind.pressure - wave.front.pressure),
                     density = wave.density(), pressure = wave.pressure();
        judge("density_" + wave.side, L1_rho_of[side] / (wave.swept * density),
              1e-3 + per * (cells * jump / density + 0.5),
              "the " + wave.side + " gas beyond 3 cells from the contact");
        judge("pressure_" + wave.side, L1_p_of[side] / (wave.swept * pressure),
              1e-3 + per * cells * rise / pressure, "the " + wave.side + " gas");
        allowed_rho += cells * jump;
        allowed_u += cells * wave.jump_of_velocity();
        swept += wave.swept;
    }
    const double density = std::max(run.parameters.left.density, run.parameters.right.density),
                 length = run.parameters.grid.x.length, change = r.change_of_velocity();
    judge("density", L1_rho / (density * length), 1e-3 + allowed_rho * r.dx / (density * length),
          "whole mesh; relative to the larger density");
    const std::string contact_lies = hint_on_contact(run, exact, r.contact * r.t);
    if (!contact_lies.empty()) run.hint(contact_lies);
    if (change > 0)
        judge("velocity_over_jump", L1_u / (change * swept),
              1e-3 + allowed_u * r.dx / (change * swept), "relative to the changes of velocity");
    run.hint(usual);
    run.info("L1_velocity", L1_u / length, "velocity",
             "exact solution of Riemann's problem; mean over the mesh");
}

/// Where something is. A place that may be off by half of the way to the next wave sees nothing.
inline void judge_place(const FinishedRun& run, const std::string& name, double found,
                        double expected, double shift, double way, const std::string& what) {
    const double dx = run.parameters.grid.x.spacing();
    if (2 * shift < way) return run.summary.result(name, found, "length", expected, shift, what);
    run.not_measured(name, "it is ", way / dx,
                     " cells away from where it would be confused, and may be off by ", shift / dx,
                     ": raise time.end, or refine the mesh");
}

/// The contact, where the gases keep apart as their particles do.
inline void judge_contact_position(const FinishedRun& run, const RiemannProfile& r) {
    const Particles& particles = run.state.particles;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double left = -infinity, right = infinity;
    for (std::size_t k = 0; k < particles.x_p.size(); ++k) {
        if (particles.material[k] == 0) left = std::max(left, particles.x_p[k]);
        if (particles.material[k] == 1) right = std::min(right, particles.x_p[k]);
    }
    if (!std::isfinite(left) || !std::isfinite(right) || r.exact.has_void) return;
    judge_place(
        run, "contact_position", 0.5 * (left + right) - run.parameters.frame_x * r.t,
        r.interface + r.contact * r.t, allowed_shift * r.dx,
        r.change_of_velocity() > 0  // else both gases stay as they are
            ? std::max(std::fabs(r.contact) * r.t, std::min(r.waves[0].swept, r.waves[1].swept))
            : infinity,
        "middle between the particles of both gases");
    run.info("contact_overlap", (left - right) / r.dx, "dx",
             "how far particles of one gas are among those of the other");
}

/// Where the pressure has changed by a part of its whole change: by half in a shock, by a tenth and
/// nine tenths in a fan.
inline void judge_wave_position(const FinishedRun& run, const RiemannProfile& r,
                                const RiemannWave& wave, const std::string& name, double part) {
    const bool to_left = wave.side == "left", shock = wave.head == wave.tail;
    const double expected = r.interface + wave.at_part(r.exact, part) * r.t,
                 rise = wave.behind.pressure - wave.front.pressure,
                 level = wave.front.pressure + part * rise,
                 shift = shock ? allowed_shift
                               : allowed_fan_shift * allowed_cells(wave, wave.swept / r.dx);
    const std::size_t N = r.x.size();
    double found = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t n = 1; n < N && std::isnan(found); ++n) {
        const std::size_t in = to_left ? n : N - 1 - n, out = to_left ? n - 1 : N - n;
        if ((r.p[in] - level) * rise >= 0 && (r.p[out] - level) * rise < 0)
            found = r.x[out] + (level - r.p[out]) / (r.p[in] - r.p[out]) * (r.x[in] - r.x[out]);
    }
    if (std::fabs(rise) < 1e-3 * std::fabs(wave.front.pressure))
        run.not_measured(name,
                         "it changes the pressure by less than a thousandth: make the "
                         "sides differ, or take the results of the other wave");
    else if (std::isnan(found))
        run.not_measured(name, "the pressure does not cross ", level,
                         ", its level: refine the mesh, or raise time.end");
    else
        judge_place(run, name, found, expected, shift * r.dx,
                    std::fabs(expected - r.interface - wave.contact * r.t),
                    sentence("exact solution of Riemann's problem; where ", 100 * part,
                             " % of the change of pressure is done"));
}

/// Pressure and velocity between the waves, a few cells away from them, in the gas of the lower
/// pressures: with the cells that have no particle, and so no pressure, since the others have the more
/// of it.
inline void judge_between_waves(const FinishedRun& run, const RiemannProfile& r) {
    const int soft = r.waves[1].pressure() <= r.waves[0].pressure();
    const RiemannWave& wave = r.waves[soft];
    const double far = 4 * r.dx / r.t;
    double p = 0, cells = 0, mass = 0, momentum = 0;
    for (std::size_t n = 0; n < r.x.size(); ++n) {
        const double xi = r.xi(n);
        if (r.side(n) != soft || !(xi - far > r.exact.left_tail && xi + far < r.exact.right_tail))
            continue;
        p += r.p[n], cells += 1;
        mass += r.rho[n], momentum += r.rho[n] * r.u[n];
    }
    if (!(mass > 0))
        return run.summary.not_measured("star_pressure",
                                        "no cell with fluid is 4 cells away from both waves: raise "
                                        "time.end, or refine the mesh");
    const double expected = wave.behind.pressure,
                 fan = wave.head == wave.tail ? 0 : wave.front.pressure - expected,
                 change = r.change_of_velocity();
    // Of weak waves a part of what the stronger one changes, and a thousandth of the pressure.
    double size = 1e-3 / run.parameters.theory_tolerance * std::fabs(expected);
    for (const RiemannWave& one : r.waves)
        size = std::max(size, std::fabs(expected - one.front.pressure));
    run.summary.result("star_pressure", p / cells, "pressure", expected,
                       run.parameters.theory_tolerance * std::min(size, std::fabs(expected)) +
                           allowed_beside_fan(wave.swept / r.dx) * fan,
                       "exact solution of Riemann's problem; in the " + wave.side + " gas");
    if (change > 0)
        run.absolute_result("star_velocity_error", (momentum / mass - r.contact) / change, "", 0,
                            "relative to the changes of velocity");
}

/// Errors against the exact solution, and where the waves are. Windows follow from the mesh;
/// theory.tolerance is that of the values between the waves, besides what the mesh takes from the
/// pressure beside a fan.
/// note:   cells to which the ends of the mesh could have sent a signal are compared all the same
inline void compare_riemann(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    if (const WaveEnds ends = wave_ends(parameters, run.state.time); ends.beyond(parameters))
        return run.not_measured("L1_density", "the waves are at x = ", ends.left, " and ",
                                ends.right,
                                ", beyond the ends of the mesh, which the exact solution does not "
                                "know: lower time.end below ",
                                ends.leaves, ", or lengthen the mesh");
    const RiemannProfile r = riemann_profile(run);
    judge_riemann_errors(run, r);
    judge_contact_position(run, r);
    for (const RiemannWave& wave : r.waves) {
        if (wave.front.density == 0) continue;
        if (wave.head == wave.tail) {
            judge_wave_position(run, r, wave, wave.side + "_shock", 0.5);
            continue;
        }
        judge_wave_position(run, r, wave, wave.side + "_fan_head", 0.1);
        judge_wave_position(run, r, wave, wave.side + "_fan_tail", 0.9);
    }
    if (r.exact.has_void) {
        const auto [first, last] = std::ranges::minmax_element(run.state.particles.x_p);
        const double foremost = r.exact.left.density > 0 ? *last : *first;
        run.info("foremost_particle", (foremost - r.interface) / r.t - parameters.frame_x,
                 "velocity", "mean, from the interface");
    } else {
        judge_between_waves(run, r);
    }
    common::write_table(run.profile, {{"x", "length", r.x},
                                      {"rho", "mass/length^3", r.rho},
                                      {"u", "velocity", r.u},
                                      {"p", "pressure", r.p},
                                      {"e", "velocity^2", r.e},
                                      {"rho_exact", "mass/length^3", r.rho_exact},
                                      {"u_exact", "velocity", r.u_exact},
                                      {"p_exact", "pressure", r.p_exact},
                                      {"e_exact", "velocity^2", r.e_exact}});
}

inline constexpr Comparison riemann_comparison{
    "riemann", validate_riemann, predict_riemann, warn_of_riemann,
    nullptr,   compare_riemann,  Rows::any,       Frame::moves_along_x};

}  // namespace flip
