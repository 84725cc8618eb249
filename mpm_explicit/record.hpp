// What a run keeps: the ledger, one row of history, files when they are due, and the results at the
// end.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/mpm/write_output.hpp"
#include "common/session.hpp"
#include "mpm_explicit/compare_with_theory.hpp"
#include "mpm_explicit/initial_state.hpp"

namespace mpm_explicit {

/// What one step has summed up.
struct StepSums {
    std::vector<StripSums> strips;
    NodeWork nodes;
    ContactSums contact;
};

class Recorder {
   public:
    Recorder(const Case& wanted, const Scales& scales, const State& state, common::History& history)
        : wanted_(wanted), scales_(scales), subject_(subject_of(wanted, state.assembly.grains)) {
        std::vector<common::Column> columns{{"time", "time"}};
        for (const char* name :
             {"kinetic", "elastic", "energy", "energy_14", "energy_15", "external", "contact",
              "friction", "bond", "damping", "plastic", "volume", "pic", "remap", "budget"})
            columns.push_back({name, "energy"});
        columns.push_back({"momentum_x", "momentum"}),
            columns.push_back({"momentum_y", "momentum"});
        columns.push_back({"contacts", "1"}), columns.push_back({"contact_force", "force"});
        const auto& grains = state.assembly.grains;
        for (std::size_t g = 0; g < grains.size(); ++g) {
            if (!grains[g].rigid && free_.size() < most_followed) {
                free_.push_back(g);
                columns.push_back({"momentum_x_" + grains[g].name, "momentum"});
                columns.push_back({"momentum_y_" + grains[g].name, "momentum"});
            }
            if (grains[g].rigid && rigid_.size() < most_followed) {
                rigid_.push_back(g);
                columns.push_back({"force_x_" + grains[g].name, "force"});
                columns.push_back({"force_y_" + grains[g].name, "force"});
                columns.push_back({"travel_x_" + grains[g].name, "length"});
                columns.push_back({"travel_y_" + grains[g].name, "length"});
            }
        }
        for (std::size_t b = 0; b < std::min(state.assembly.bonds.size(), most_followed); ++b) {
            const std::string number = std::to_string(b + 1);
            columns.push_back({"bond_normal_" + number, "stress"});
            columns.push_back({"bond_shear_" + number, "stress"});
        }
        if (!state.assembly.bonds.empty()) columns.push_back({"broken_bonds", "1"});
        for (const common::Column& column : columns_of_comparison(wanted))
            columns.push_back(column);
        history.columns(columns);
    }

    /// Writes the files that are due at this step, before it.
    void snapshot(long step, const State& state, common::Session& session) const {
        const std::string folder = session.path("");
        if (due(wanted_.particles_interval, step))
            write_particles(folder, step, wanted_, state.assembly);
        if (due(wanted_.grains_interval, step)) write_grains(folder, step, state.assembly);
        if (due(wanted_.fringes_interval, step))
            write_fringe_raster(folder, step, wanted_, state.assembly);
        if (wanted_.pack && step == 0) write_pack_of(folder, wanted_);
    }

    /// Enters a step into the ledger and writes its row of the history.
    /// errors: NumericalError for an energy beyond the limit, an inverted volume, or a particle that
    ///         has left the mesh, with grain, place and time
    void record(long step, const StepSums& sums, const GrainNodes& nodes, State& state,
                common::Session& session) {
        Ledger& l = state.ledger;
        enter_energies(step, sums.strips, l);
        look_back(session.history);
        const bool finite =
            std::all_of(sums.strips.begin(), sums.strips.end(), [](const StripSums& s) {
                return std::isfinite(s.kinetic) && std::isfinite(s.product);
            });
        if (finite && step % wanted_.history_steps == 0)
            write_row(static_cast<double>(step) * scales_.dt, sums, state, session);
        refuse_failure(step, sums, nodes, state);
        enter_work(nodes.strips(), sums.strips, sums.nodes, sums.contact, l);
    }

    /// The results of the whole run, after its last step.
    void finish(long step, const State& state, common::Session& session) const {
        const common::History& history = session.history;
        common::Summary& summary = session.summary;
        if (history.all().empty()) return;
        const std::vector<Material> materials = materials_of(wanted_.problem);
        const theory::Run run{wanted_,        scales_,
                              state.assembly, history,
                              subject_,       static_cast<double>(step) * scales_.dt,
                              materials,      plan_grains(wanted_.problem, materials)};
        compare_with_theory(run, summary);
        const auto largest = [&](const char* name) {
            double most = 0;
            for (const double value : history.column(name)) most = std::max(most, std::fabs(value));
            return most;
        };
        const double size = largest("kinetic") + largest("elastic");
        summary.conservation("largest_budget", largest("budget"), "energy");
        summary.conservation("largest_budget_over_energy", size > 0 ? largest("budget") / size : 0,
                             "1");
        summary.conservation("largest_remap_error", largest("remap"), "energy");
        const auto p_x = history.column("momentum_x"), p_y = history.column("momentum_y");
        summary.conservation("momentum_x_change", p_x.back() - p_x.front(), "momentum");
        summary.conservation("momentum_y_change", p_y.back() - p_y.front(), "momentum");
        summary.performance("particles", static_cast<double>(state.assembly.particles.count()));
        summary.performance("grains", static_cast<double>(state.assembly.grains.size()));
    }

   private:
    // Whether a multiple of the interval falls on this step.
    bool due(double interval, long step) const {
        if (!(interval > 0)) return false;
        const double multiple = std::round(static_cast<double>(step) * scales_.dt / interval);
        return std::lround(multiple * interval / scales_.dt) == step;
    }

    void write_row(double time, const StepSums& sums, const State& state,
                   common::Session& session) {
        const Ledger& l = state.ledger;
        row_ = {time,        l.kinetic,   l.elastic,  l.kinetic + l.elastic,
                l.energy_14, l.energy_15, l.external, l.contact,
                l.friction,  l.bond,      l.damping,  l.plastic,
                l.volume,    l.pic,       l.remap,    l.budget()};
        double momentum_x = 0, momentum_y = 0;
        for (const double p : l.momentum_x) momentum_x += p;
        for (const double p : l.momentum_y) momentum_y += p;
        row_.insert(row_.end(), {momentum_x, momentum_y, sums.contact.nodes,
                                 sums.contact.impulse / scales_.dt});
        for (std::size_t g = 0; g < state.assembly.grains.size(); ++g) {
            if (std::find(free_.begin(), free_.end(), g) != free_.end())
                row_.insert(row_.end(), {l.momentum_x[g], l.momentum_y[g]});
            if (std::find(rigid_.begin(), rigid_.end(), g) != rigid_.end()) {
                const RigidMotion& is = state.assembly.rigid[g];
                row_.insert(row_.end(), {is.push_x, is.push_y, is.travel_x, is.travel_y});
            }
        }
        const auto& bonds = state.assembly.bonds;
        for (std::size_t b = 0; b < std::min(bonds.size(), most_followed); ++b)
            row_.insert(row_.end(), {bonds[b].normal_stress, bonds[b].shear_stress});
        if (!bonds.empty())
            row_.push_back(static_cast<double>(std::count_if(
                bonds.begin(), bonds.end(), [](const Bond& bond) { return bond.broken; })));
        add_comparison(wanted_, subject_, state.assembly, row_);
        session.history.row(row_);
    }

    // After a restart: what was put in before it.
    void look_back(const common::History& history) {
        if (looked_back_) return;
        looked_back_ = true;
        if (history.all().empty()) return;
        for (const double external : history.column("external"))
            largest_load_ = std::max(largest_load_, std::fabs(external));
    }

    void refuse_failure(long step, const StepSums& sums, const GrainNodes& nodes,
                        const State& state) {
        const Mesh& mesh = nodes.mesh();
        const Particles& at = state.assembly.particles;
        const auto when = [&](long n) {
            return " at step " + std::to_string(n) +
                   ", t = " + common::shown(static_cast<double>(n) * scales_.dt);
        };
        const auto place_of = [&](std::size_t n) {
            return " at (" + common::shown(at.x_p[n]) + ", " + common::shown(at.y_p[n]) + ")";
        };
        // Grains may straddle the ends of a periodic mesh, but no particle is a whole length away.
        const double beyond = mesh.periodic_x ? mesh.length_x() : 0, left = mesh.x_low - beyond,
                     right = mesh.x_high() + beyond;
        for (std::size_t k = 0; k < sums.strips.size(); ++k) {
            const StripSums& s = sums.strips[k];
            const Strip& strip = nodes.strips()[k];
            const auto g = static_cast<std::size_t>(strip.grain);
            const Grain& grain = state.assembly.grains[g];
            const RigidMotion& is = state.assembly.rigid[g];
            const bool inside = !(s.x_least < left || s.x_most > right || s.y_least < mesh.y_low ||
                                  s.y_most > mesh.y_high());
            const bool finite = std::isfinite(grain.rigid ? is.vx + is.vy : s.kinetic);
            if (inside && finite && s.least_V > 0) continue;
            const auto place = [&](const auto& is_bad) {
                for (long p = strip.begin; p < strip.end; ++p)
                    if (is_bad(static_cast<std::size_t>(p)))
                        return place_of(static_cast<std::size_t>(p));
                return " near" + place_of(static_cast<std::size_t>(strip.begin)).substr(3);
            };
            if (!(s.least_V > 0))
                throw common::NumericalError(
                    "the volume of a particle of grain '" + grain.name + "'" +
                    place([&](std::size_t n) { return !(at.V_p[n] > 0); }) + " is inverted" +
                    when(step) +
                    ": reduce time.alpha, refine the mesh, or load the grain more slowly");
            if (!finite)
                throw common::NumericalError(
                    "the velocity of a particle of grain '" + grain.name + "'" +
                    place([&](std::size_t n) { return !std::isfinite(at.vx_p[n] + at.vy_p[n]); }) +
                    " is not finite" + when(step + 1) + ": reduce time.alpha");
            throw common::NumericalError(
                "a particle of grain '" + grain.name + "' has left the mesh" +
                place([&](std::size_t n) {
                    return at.x_p[n] < left || at.x_p[n] > right || at.y_p[n] < mesh.y_low ||
                           at.y_p[n] > mesh.y_high();
                }) +
                when(step + 1) +
                ": widen the mesh, put a wall there, or reduce time.alpha if the grain has burst");
        }
        const Ledger& l = state.ledger;
        largest_load_ = std::max({largest_load_, std::fabs(l.external)});
        const double put_in = l.start + largest_load_, now = l.kinetic + l.elastic;
        if (std::isfinite(now) &&
            !(wanted_.energy_limit > 0 && now > wanted_.energy_limit * put_in && put_in > 0))
            return;
        // Name the grain that moves fastest.
        std::size_t fastest = 0, whose = 0;
        double most = -1;
        for (std::size_t g = 0; g < state.assembly.grains.size(); ++g) {
            const Grain& grain = state.assembly.grains[g];
            for (long p = grain.begin; p < grain.end && !grain.rigid; ++p) {
                const auto n = static_cast<std::size_t>(p);
                const double speed = std::hypot(at.vx_p[n], at.vy_p[n]);
                if (speed > most) most = speed, fastest = n, whose = g;
            }
        }
        throw common::NumericalError(
            "the energy is " + common::shown(now) + ", and " + common::shown(put_in) +
            " was put in," + when(step) + "; fastest is grain '" +
            state.assembly.grains[whose].name + "'" + place_of(fastest) +
            ": reduce time.alpha, refine the mesh, or allow more with time.energy_limit");
    }

    static constexpr std::size_t most_followed = 16;
    const Case& wanted_;
    const Scales& scales_;
    Subject subject_;
    std::vector<std::size_t> free_, rigid_;
    std::vector<double> row_;
    double largest_load_ = 0;  // work of the loads so far, where it was largest
    bool looked_back_ = false;
};

}  // namespace mpm_explicit
