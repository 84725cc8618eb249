// What a run of any scheme keeps: rows of history, files when they are due, why it failed, and what is
// conserved. The energies and where they went are the scheme's own budget.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/run/run.hpp"
#include "mpm_explicit/contact.hpp"
#include "mpm_explicit/output/write_output.hpp"
#include "mpm_explicit/theory/compare_elastic.hpp"

namespace mpm {

class Recorder {
   public:
    /// in: budget_columns, what the rows of the budget hold; among them "kinetic", "elastic",
    ///     "energy", "external" and what is left when all is counted, called `rest`
    Recorder(const Case& parameters, const Scales& scales, const Assembly& all,
             const std::vector<common::Column>& budget_columns, const std::string& rest,
             common::History& history)
        : parameters_(parameters),
          scales_(scales),
          subject_(subject_of(parameters, all.grains)),
          rest_(rest) {
        std::vector<common::Column> columns{{"time", "time"}};
        columns.insert(columns.end(), budget_columns.begin(), budget_columns.end());
        columns.insert(columns.end(), {{"momentum_x", "momentum"},
                                       {"momentum_y", "momentum"},
                                       {"contacts", "1"},
                                       {"contact_force", "force"}});
        const auto& grains = all.grains;
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
        for (std::size_t b = 0; b < std::min(all.bonds.size(), most_followed); ++b) {
            const std::string number = std::to_string(b + 1);
            columns.push_back({"bond_normal_" + number, "stress"});
            columns.push_back({"bond_shear_" + number, "stress"});
        }
        if (!all.bonds.empty()) columns.push_back({"broken_bonds", "1"});
        for (const common::Column& column : columns_of_comparison(parameters))
            columns.push_back(column);
        history.columns(columns);
    }

    /// Writes the files that are due at this step, before it.
    void snapshot(long step, const Assembly& all, const common::Run& run) const {
        const std::string folder = run.path("");
        if (due(parameters_.particles_interval, step))
            write_particles(folder, step, parameters_, all);
        if (due(parameters_.grains_interval, step)) write_grains(folder, step, all);
        if (due(parameters_.fringes_interval, step))
            write_fringe_raster(folder, step, parameters_, all);
        if (parameters_.pack && step == 0) write_pack_of(folder, parameters_);
    }

    bool row_is_due(long step) const { return step % parameters_.history_steps == 0; }

    /// Writes a row of the history.
    /// in: time, the budget and the momenta of every grain then; dt and what contact did, of the step
    void write_row(double time, double dt, const std::vector<double>& budget_row,
                   const std::vector<double>& momentum_x, const std::vector<double>& momentum_y,
                   const ContactSums& contact, const Assembly& all, common::Run& run) {
        row_ = {time};
        row_.insert(row_.end(), budget_row.begin(), budget_row.end());
        double sum_x = 0, sum_y = 0;
        for (const double p : momentum_x) sum_x += p;
        for (const double p : momentum_y) sum_y += p;
        row_.insert(row_.end(), {sum_x, sum_y, contact.nodes, contact.impulse / dt});
        for (std::size_t g = 0; g < all.grains.size(); ++g) {
            if (std::find(free_.begin(), free_.end(), g) != free_.end())
                row_.insert(row_.end(), {momentum_x[g], momentum_y[g]});
            if (std::find(rigid_.begin(), rigid_.end(), g) != rigid_.end()) {
                const RigidMotion& is = all.rigid[g];
                row_.insert(row_.end(), {is.push_x, is.push_y, is.travel_x, is.travel_y});
            }
        }
        const auto& bonds = all.bonds;
        for (std::size_t b = 0; b < std::min(bonds.size(), most_followed); ++b)
            row_.insert(row_.end(), {bonds[b].normal_stress, bonds[b].shear_stress});
        if (!bonds.empty())
            row_.push_back(static_cast<double>(std::count_if(
                bonds.begin(), bonds.end(), [](const Bond& bond) { return bond.broken; })));
        add_comparison(parameters_, subject_, all, row_);
        run.history.row(row_);
    }

    /// Looks at what a step has made.
    /// in:     tiles, sums over the particles of every tile: their kinetic energy, the smallest
    ///         ratio of volumes after and before (least_V), and how far they reach; start, the energy
    ///         at t = 0; external, the work of the loads since; now, the energy
    /// errors: NumericalError for an energy beyond the limit, an inverted volume, or a particle that
    ///         has left the mesh, with grain, place and time
    template <class Sums>
    void refuse_failure(long step, const std::vector<Sums>& tiles, const GrainNodes& nodes,
                        const Assembly& all, double start, double external, double now,
                        const common::History& history) {
        refuse_particles(step, tiles, nodes, all);
        // After a restart, what was put in before it counts as well.
        if (!looked_back_)
            for (const double before : history.column("external"))
                largest_load_ = std::max(largest_load_, std::fabs(before));
        looked_back_ = true;
        largest_load_ = std::max(largest_load_, std::fabs(external));
        refuse_energy(step, all, start + largest_load_, now);
    }

    /// The run after its last step, for comparison with theory.
    theory::Run ended(long step, const Assembly& all, const common::History& history) const {
        const std::vector<Material> materials = materials_of(parameters_.problem);
        return {parameters_, scales_,
                all,         history,
                subject_,    static_cast<double>(step) * scales_.dt,
                materials,   plan_grains(parameters_.problem, materials)};
    }

    /// What was conserved: the budget of the energy, momentum, and residuals of the scheme's own.
    /// in: residuals, column of the history and name in the summary [energy]
    void finish_conservation(const std::vector<std::pair<std::string, std::string>>& residuals,
                             const Assembly& all, common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        const auto largest = [&](const std::string& name) {
            double most = 0;
            for (const double value : history.column(name)) most = std::max(most, std::fabs(value));
            return most;
        };
        const double size = largest("kinetic") + largest("elastic");
        summary.conservation("largest_" + rest_, largest(rest_), "energy");
        summary.conservation("largest_" + rest_ + "_over_energy",
                             size > 0 ? largest(rest_) / size : 0, "1");
        for (const auto& [column, name] : residuals)
            summary.conservation(name, largest(column), "energy");
        const auto p_x = history.column("momentum_x"), p_y = history.column("momentum_y");
        summary.conservation("momentum_x_change", p_x.back() - p_x.front(), "momentum");
        summary.conservation("momentum_y_change", p_y.back() - p_y.front(), "momentum");
        summary.performance("particles", static_cast<double>(all.particles.count()));
        summary.performance("grains", static_cast<double>(all.grains.size()));
    }

   private:
    // Whether a multiple of the interval falls on this step.
    bool due(double interval, long step) const {
        if (!(interval > 0)) return false;
        const double multiple = std::round(static_cast<double>(step) * scales_.dt / interval);
        return std::lround(multiple * interval / scales_.dt) == step;
    }

    std::string when(long step) const {
        return " at step " + std::to_string(step) +
               ", t = " + common::format(static_cast<double>(step) * scales_.dt);
    }

    static std::string place_of(const Particles& at, std::size_t p) {
        return " at (" + common::format(at.x_p[p]) + ", " + common::format(at.y_p[p]) + ")";
    }

    template <class Sums>
    void refuse_particles(long step, const std::vector<Sums>& tiles, const GrainNodes& nodes,
                          const Assembly& all) const {
        const Mesh& mesh = nodes.mesh();
        const Particles& at = all.particles;
        // Grains may straddle the ends of a periodic mesh, but no particle is a whole length away.
        const double beyond = mesh.periodic_x ? mesh.length_x() : 0, left = mesh.x_low - beyond,
                     right = mesh.x_high() + beyond;
        for (std::size_t k = 0; k < tiles.size(); ++k) {
            const Sums& s = tiles[k];
            const Tile& tile = nodes.tiles()[k];
            const auto g = static_cast<std::size_t>(tile.grain);
            const Grain& grain = all.grains[g];
            const RigidMotion& is = all.rigid[g];
            const bool inside = !(s.x_least < left || s.x_most > right || s.y_least < mesh.y_low ||
                                  s.y_most > mesh.y_high());
            const bool finite = std::isfinite(grain.rigid ? is.vx + is.vy : s.kinetic);
            if (inside && finite && s.least_V > 0) continue;
            const auto place = [&](const auto& is_bad) {
                for (long p = tile.begin; p < tile.end; ++p)
                    if (is_bad(static_cast<std::size_t>(p)))
                        return place_of(at, static_cast<std::size_t>(p));
                return " near" + place_of(at, static_cast<std::size_t>(tile.begin)).substr(3);
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
    }

    void refuse_energy(long step, const Assembly& all, double put_in, double now) const {
        if (std::isfinite(now) && !(parameters_.energy_limit > 0 &&
                                    now > parameters_.energy_limit * put_in && put_in > 0))
            return;
        const Particles& at = all.particles;
        // Name the grain that moves fastest.
        std::size_t fastest = 0, whose = 0;
        double most = -1;
        for (std::size_t g = 0; g < all.grains.size(); ++g) {
            const Grain& grain = all.grains[g];
            for (long p = grain.begin; p < grain.end && !grain.rigid; ++p) {
                const auto n = static_cast<std::size_t>(p);
                const double speed = std::hypot(at.vx_p[n], at.vy_p[n]);
                if (speed > most) most = speed, fastest = n, whose = g;
            }
        }
        throw common::NumericalError(
            "the energy is " + common::format(now) + ", and " + common::format(put_in) +
            " was put in," + when(step) + "; fastest is grain '" + all.grains[whose].name + "'" +
            place_of(at, fastest) +
            ": reduce time.alpha, refine the mesh, or allow more with time.energy_limit");
    }

    static constexpr std::size_t most_followed = 16;
    const Case& parameters_;
    const Scales& scales_;
    Subject subject_;
    std::string rest_;
    std::vector<std::size_t> free_, rigid_;
    std::vector<double> row_;
    double largest_load_ = 0;  // work of the loads so far, where it was largest
    bool looked_back_ = false;
};

}  // namespace mpm
