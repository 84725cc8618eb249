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
    const double change = std::fabs(wave.behind.velocity - wave.front.velocity),
                 weakness = theory::sound_speed(wave.front) / std::max(change, 1e-300);
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

/// Density, velocity and pressure against the exact solution, on each side of the contact by the
/// scales of that side, and where the waves are.
///   L1(q) = dx/swept sum_i |q_i - mean of the exact q over cell i| / largest q of that side
/// Densities of a side leave out the three cells next to the contact, whose mass may be that of
/// the other gas; the error of the whole mesh has them all. Windows of L1 errors and of places
/// follow from the mesh; theory.tolerance is that of the values between the waves,
/// besides what the mesh takes from the pressure beside a fan.
/// note:   cells to which the ends of the mesh could have sent a signal are compared all the same
inline void compare_riemann(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const double t = run.state.time;
    if (const WaveEnds ends = wave_ends(parameters, t); ends.beyond(parameters))
        return run.not_measured("L1_density", "the waves are at x = ", ends.left, " and ",
                                ends.right,
                                ", beyond the ends of the mesh, which the exact solution does not "
                                "know: lower time.end below ",
                                ends.leaves, ", or lengthen the mesh");
    const theory::RiemannSolution exact = riemann_of(parameters);
    const std::array<RiemannWave, 2> waves = waves_of(exact, t);
    const std::string source = "exact solution of Riemann's problem";
    const std::vector<double> rho = mean_over_z(parameters.grid, run.cells.rho),
                              vx = mean_over_z(parameters.grid, run.cells.vx),
                              p = mean_over_z(parameters.grid, run.cells.p),
                              e = mean_over_z(parameters.grid, run.cells.e);
    const double dx = parameters.grid.x.spacing(),
                 contact = 0.5 * (exact.left_contact + exact.right_contact);
    std::vector<double> x, u, rho_exact, u_exact, p_exact, e_exact;
    double L1_rho = 0, L1_u = 0, star_p = 0, star_cells = 0, star_mass = 0, star_momentum = 0;
    double L1_rho_of[2] = {0, 0}, L1_p_of[2] = {0, 0};
    const int soft = waves[1].pressure() <= waves[0].pressure();
    for (std::size_t n = 0; n < rho.size(); ++n) {
        x.push_back(parameters.grid.x.at(double(n) + 0.5) - parameters.frame_x * t);
        u.push_back(vx[n] - parameters.frame_x);
        const double xi = (x[n] - parameters.interface) / t, half = 0.5 * dx / t;
        const theory::Conserved mean = theory::mean_between(exact, xi - half, xi + half);
        const theory::GasState at = theory::sample(exact, xi);
        const int side = xi > contact;
        const double beside = side ? xi - exact.right_contact : exact.left_contact - xi;
        rho_exact.push_back(mean.mass);
        u_exact.push_back(mean.mass > 0 ? mean.momentum / mean.mass : at.velocity);
        p_exact.push_back(at.pressure);
        e_exact.push_back(at.density > 0 ? (at.pressure + at.gamma * at.p_infinity) /
                                               ((at.gamma - 1) * at.density)
                                         : 0);
        L1_rho += dx * std::fabs(rho[n] - mean.mass);
        L1_rho_of[side] += beside > 6 * half ? dx * std::fabs(rho[n] - mean.mass) : 0;
        L1_p_of[side] += dx * std::fabs(p[n] - at.pressure);
        L1_u += rho[n] > 0 ? dx * std::fabs(u[n] - u_exact[n]) : 0;
        // A few cells away from the waves, in the gas of the lower pressures: with the cells that have
        // no particle, and so no pressure, since the others have the more of it.
        if (side == soft && xi - 8 * half > exact.left_tail && xi + 8 * half < exact.right_tail) {
            star_p += p[n], star_cells += 1;
            star_mass += rho[n], star_momentum += rho[n] * u[n];
        }
    }

    // What the mesh allows: cells times jumps, and a thousandth. A window as large as half of what it
    // is relative to sees nothing.
    const std::string cells_swept = sentence("the waves have swept ", waves[0].swept / dx, " and ",
                                             waves[1].swept / dx, " cells");
    std::string advice = advice_on_viscosity(parameters);
    if (parameters.per_cell_x < 64)
        advice += sentence(advice.empty() ? "" : ", and ", "more than ", parameters.per_cell_x,
                           " particles per cell along x");
    // Liquids that hold tension need particles that carry their volume, in flip.
    const bool holds = parameters.left.tension > 0 || parameters.right.tension > 0;
    if (advice.empty())
        advice = run.program == "pic" && !holds ? "flip, or finer cells" : "finer cells";
    else if (run.program == "pic" && !holds)
        advice +=
            ", or flip: pic converges on finer meshes only with more particles in their cells";
    if (run.program == "pic" && holds)
        advice +=
            ", or flip with flip.density = \"particles\": a liquid under tension needs particles "
            "that carry their volume";
    const std::string usual =
        sentence(cells_swept, ": below 15 raise time.end or refine the mesh; else take ", advice,
                 hint_on_viscosity(parameters));
    run.hint(usual);
    const auto judge_L1 = [&](const std::string& name, double value, double allowed,
                              const std::string& what) {
        if (allowed < 0.5) return run.summary.result("L1_" + name, value, "", 0, allowed, what);
        run.not_measured("L1_" + name, cells_swept,
                         ", too few for an error: raise time.end, or refine the mesh");
    };
    // A place that may be off by half of the way to the next wave sees nothing either.
    const auto judge_place = [&](const std::string& name, double found, double expected,
                                 double shift, double way, const std::string& what) {
        if (2 * shift < way)
            return run.summary.result(name, found, "length", expected, shift, what);
        run.not_measured(name, "it is ", way / dx,
                         " cells away from where it would be confused, and may be off by ",
                         shift / dx, ": raise time.end, or refine the mesh");
    };
    const double at_contact[] = {exact.left_of_contact.density, exact.right_of_contact.density};
    double allowed_rho =  // at a void two surfaces
        1.5 *
        (exact.has_void ? at_contact[0] + at_contact[1] : std::fabs(at_contact[0] - at_contact[1])),
           allowed_u = 0, speed = 0, swept = 0;
    for (int side = 0; side < 2; ++side) {
        const RiemannWave& wave = waves[side];
        if (wave.front.density == 0) continue;
        const theory::GasState &a = wave.front, &b = wave.behind;
        const double cells = allowed_cells(wave, wave.swept / dx), per = dx / wave.swept,
                     jump = std::fabs(b.density - a.density), density = wave.density(),
                     pressure = wave.pressure();
        judge_L1("density_" + wave.side, L1_rho_of[side] / (wave.swept * density),
                 1e-3 + per * (cells * jump / density + 0.5),
                 "the " + wave.side + " gas beyond 3 cells from the contact");
        judge_L1("pressure_" + wave.side, L1_p_of[side] / (wave.swept * pressure),
                 1e-3 + per * cells * std::fabs(b.pressure - a.pressure) / pressure,
                 "the " + wave.side + " gas");
        allowed_rho += cells * jump;
        allowed_u += cells * std::fabs(b.velocity - a.velocity);
        speed += std::fabs(b.velocity - a.velocity), swept += wave.swept;
    }
    const double density = std::max(parameters.left.density, parameters.right.density),
                 length = parameters.grid.x.length;
    judge_L1("density", L1_rho / (density * length), 1e-3 + allowed_rho * dx / (density * length),
             "whole mesh; relative to the larger density");
    if (const std::string contact_lies = hint_on_contact(run, exact, contact * t);
        !contact_lies.empty())
        run.hint(contact_lies);
    if (speed > 0)
        judge_L1("velocity_over_jump", L1_u / (speed * swept),
                 1e-3 + allowed_u * dx / (speed * swept), "relative to the changes of velocity");
    run.hint(usual);
    run.info("L1_velocity", L1_u / length, "velocity", source + "; mean over the mesh");

    // The gases keep apart where their particles do.
    const Particles& particles = run.state.particles;
    double left = -std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < particles.x_p.size(); ++k) {
        if (particles.material[k] == 0) left = std::max(left, particles.x_p[k]);
        if (particles.material[k] == 1) right = std::min(right, particles.x_p[k]);
    }
    if (std::isfinite(left) && std::isfinite(right) && !exact.has_void) {
        judge_place("contact_position", 0.5 * (left + right) - parameters.frame_x * t,
                    parameters.interface + contact * t, allowed_shift * dx,
                    speed > 0  // else both gases stay as they are
                        ? std::max(std::fabs(contact) * t, std::min(waves[0].swept, waves[1].swept))
                        : std::numeric_limits<double>::infinity(),
                    "middle between the particles of both gases");
        run.info("contact_overlap", (left - right) / dx, "dx",
                 "how far particles of one gas are among those of the other");
    }

    // Where the pressure has changed by half in a shock, by a tenth and nine tenths in a fan.
    for (const RiemannWave& wave : waves) {
        if (wave.front.density == 0) continue;
        const bool shock = wave.head == wave.tail, to_left = &wave == &waves[0];
        const double shift =
            shock ? allowed_shift : allowed_fan_shift * allowed_cells(wave, wave.swept / dx);
        const std::vector<std::pair<std::string, double>> parts =
            shock ? std::vector<std::pair<std::string, double>>{{"_shock", 0.5}}
                  : std::vector<std::pair<std::string, double>>{{"_fan_head", 0.1},
                                                                {"_fan_tail", 0.9}};
        for (const auto& [name, part] : parts) {
            const double expected = parameters.interface + wave.at_part(exact, part) * t,
                         rise = wave.behind.pressure - wave.front.pressure,
                         level = wave.front.pressure + part * rise;
            const std::size_t N = x.size();
            double found = std::numeric_limits<double>::quiet_NaN();
            for (std::size_t n = 1; n < N && std::isnan(found); ++n) {
                const std::size_t in = to_left ? n : N - 1 - n, out = to_left ? n - 1 : N - n;
                if ((p[in] - level) * rise >= 0 && (p[out] - level) * rise < 0)
                    found = x[out] + (level - p[out]) / (p[in] - p[out]) * (x[in] - x[out]);
            }
            if (std::fabs(rise) < 1e-3 * std::fabs(wave.front.pressure))
                run.not_measured(wave.side + name,
                                 "it changes the pressure by less than a thousandth: make the "
                                 "sides differ, or take the results of the other wave");
            else if (std::isnan(found))
                run.not_measured(wave.side + name, "the pressure does not cross ", level,
                                 ", its level: refine the mesh, or raise time.end");
            else
                judge_place(wave.side + name, found, expected, shift * dx,
                            std::fabs(expected - parameters.interface - wave.contact * t),
                            sentence(source, "; where ", 100 * part,
                                     " % of the change of pressure is done"));
        }
    }
    if (exact.has_void) {
        const auto [first, last] = std::ranges::minmax_element(particles.x_p);
        const double foremost = exact.left.density > 0 ? *last : *first;
        run.info("foremost_particle", (foremost - parameters.interface) / t - parameters.frame_x,
                 "velocity", "mean, from the interface");
    } else if (star_mass > 0) {
        const RiemannWave& wave = waves[soft];
        const double expected = wave.behind.pressure,
                     change = wave.head == wave.tail ? 0 : wave.front.pressure - expected;
        run.summary.result("star_pressure", star_p / star_cells, "pressure", expected,
                           parameters.theory_tolerance * std::fabs(expected) +
                               allowed_beside_fan(wave.swept / dx) * change,
                           source + "; in the " + wave.side + " gas");
        if (speed > 0)
            run.absolute_result("star_velocity_error",
                                (star_momentum / star_mass - contact) / speed, "", 0,
                                "relative to the changes of velocity");
    } else {
        run.summary.not_measured("star_pressure",
                                 "no cell with fluid is 4 cells away from both waves: raise "
                                 "time.end, or refine the mesh");
    }
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
