// What a run of any scheme keeps: rows of history, files when they are due, why it failed, and what
// is conserved. The energies and where they went are the scheme's own budget.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/run/run.hpp"
#include "mpm_explicit/contact.hpp"
#include "mpm_explicit/output/overlap.hpp"
#include "mpm_explicit/output/write_output.hpp"
#include "mpm_explicit/theory/compare_plates.hpp"
#include "mpm_explicit/theory/compare_rotation.hpp"
#include "mpm_explicit/theory/judge_overlap.hpp"

namespace mpm {

/// The part of a recorder that no scheme changes.
class Recorder {
   public:
    /// in: rest, the column of the energy that is left when all is counted
    Recorder(const Case& parameters, const theory::SchemeFacts& scheme, const Scales& scales,
             const Assembly& all, std::span<const theory::Comparison> comparisons,
             const std::string& rest)
        : parameters_(parameters),
          scales_(scales),
          planned_{parameters, scheme},
          comparison_(theory::comparison_of(parameters, comparisons)),
          rest_(rest) {
        std::size_t free = 0, rigid = 0;
        for (std::size_t g = 0; g < all.grains.size(); ++g) {
            std::size_t& number = all.grains[g].rigid ? rigid : free;
            if (number < most_tracked) tracked_.push_back(g), ++number;
        }
    }

    /// Writes the files that are due at this step, before it.
    void snapshot(long step, const Assembly& all, const common::Run& run) const {
        const common::Snapshot at{run.path("."), step, double(step) * scales_.dt, parameters_.also};
        if (due(parameters_.particles_interval, step)) write_particles(at, parameters_, all);
        if (due(parameters_.grains_interval, step)) write_grains(at, all);
        if (due(parameters_.fringes_interval, step)) write_fringe_raster(at, parameters_, all);
        if (parameters_.pack && step == 0) write_pack_of(run.path(""), parameters_);
    }

    bool is_end(long step) const { return step == scales_.steps; }

    /// Whether a row of the history belongs to t^n; one belongs to the end.
    bool row_is_due(long step) const {
        return step % parameters_.history_steps == 0 || is_end(step);
    }

    /// Adds what every scheme records beside its energies: momenta, contacts, tracked grains,
    /// bonds, and what the comparison with theory needs.
    /// in: momenta of every grain; pairs that press at nodes, and the sum of their impulses
    void add_to(common::Row& row, const std::vector<Momenta>& momenta, double contacts,
                double impulse, const Assembly& all) const {
        Momenta sum;
        for (const Momenta& one : momenta)
            sum.x += one.x, sum.y += one.y, sum.angular += one.angular;
        row.add("momentum_x", "momentum", sum.x);
        row.add("momentum_y", "momentum", sum.y);
        // About the origin of the mesh, as those of the grains.
        row.add("angular_momentum", "momentum*length", sum.angular);
        row.add("contacts", "1", contacts);
        row.add("contact_force", "force", impulse / scales_.dt);
        const Mesh mesh = parameters_.problem.mesh();
        if (planned_.scheme.implicit && all.grains.size() > 1)
            row.add("overlap", "h", deepest_overlap(all, mesh) / mesh.h);
        for (const std::size_t g : tracked_) {
            const std::string& name = all.grains[g].name;
            if (all.grains[g].rigid) {
                const RigidMotion& motion = all.rigid[g];
                row.add("force_x_" + name, "force", motion.push_x);
                row.add("force_y_" + name, "force", motion.push_y);
                row.add("travel_x_" + name, "length", motion.travel_x);
                row.add("travel_y_" + name, "length", motion.travel_y);
            } else {
                row.add("momentum_x_" + name, "momentum", momenta[g].x);
                row.add("momentum_y_" + name, "momentum", momenta[g].y);
                row.add("angular_momentum_" + name, "momentum*length", momenta[g].angular);
            }
        }
        const auto& bonds = all.bonds;
        for (std::size_t b = 0; b < std::min(bonds.size(), most_tracked); ++b) {
            const std::string number = std::to_string(b + 1);
            row.add("bond_normal_" + number, "stress", bonds[b].normal_stress);
            row.add("bond_shear_" + number, "stress", bonds[b].shear_stress);
        }
        const auto broken =
            std::count_if(bonds.begin(), bonds.end(), [](const Bond& bond) { return bond.broken; });
        if (!bonds.empty()) row.add("broken_bonds", "1", double(broken));
        if (comparison_ != nullptr && comparison_->columns != nullptr)
            comparison_->columns(planned_, all, row);
    }

    /// Looks at what a step has made.
    /// in:     tiles, sums over the particles of every tile: their kinetic energy, the smallest
    ///         ratio of volumes after and before (least_V), and how far they reach; start, the
    ///         energy at t = 0; external, the work of the loads since; now, the energy
    /// errors: NumericalError for an energy beyond the limit, an inverted volume, or a particle
    ///         that has left the mesh, with grain, place and time
    template <class Sums>
    void refuse_failure(long step, const std::vector<Sums>& tiles, const GrainNodes& nodes,
                        const Assembly& all, double start, double external, double now,
                        const common::History& history) {
        refuse_particles(step, tiles, nodes, all);
        // After a restart, what was put in before it counts as well.
        if (!largest_load_) largest_load_ = history.largest("external");
        largest_load_ = std::max(*largest_load_, std::fabs(external));
        refuse_energy(step, all, start + *largest_load_, now);
    }

    /// The results of the comparison with theory, after the last step.
    void compare_with_theory(long step, const Assembly& all, common::Run& run) const {
        const theory::FinishedRun ended{planned_, scales_, all, run.history,
                                        double(step) * scales_.dt};
        theory::judge_free_grains(ended, run.summary);
        theory::judge_held_grain(ended, run.summary);
        theory::judge_weight(ended, run.summary);
        if (comparison_ != nullptr && comparison_->result != nullptr)
            comparison_->result(ended, run.summary);
        theory::judge_overlap(ended, run.summary);
    }

    /// What was conserved: the budget of the energy, and momentum.
    void finish_conservation(const Assembly& all, common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        const double size = history.largest("kinetic") + history.largest("elastic"),
                     rest = history.largest(rest_);
        summary.conservation("largest_" + rest_, rest, "energy");
        summary.conservation("largest_" + rest_ + "_over_energy", size > 0 ? rest / size : 0, "1");
        const auto p_x = history.column("momentum_x"), p_y = history.column("momentum_y");
        summary.conservation("momentum_x_change", p_x.back() - p_x.front(), "momentum");
        summary.conservation("momentum_y_change", p_y.back() - p_y.front(), "momentum");
        summary.performance("particles", double(all.particles.count()));
        summary.performance("grains", double(all.grains.size()));
    }

   private:
    // Whether a multiple of the interval falls on this step, or the end of the run.
    bool due(double interval, long step) const {
        if (!(interval > 0)) return false;
        if (is_end(step)) return true;
        const double multiple = std::round(double(step) * scales_.dt / interval);
        return std::lround(multiple * interval / scales_.dt) == step;
    }

    std::string when(long step) const {
        return " at step " + std::to_string(step) + ", t = " + format(double(step) * scales_.dt);
    }

    static std::string place_of(const Particles& at, long p) {
        return " at (" + format(at.x_p[p]) + ", " + format(at.y_p[p]) + ")";
    }

    template <class Sums>
    void refuse_particles(long step, const std::vector<Sums>& tiles, const GrainNodes& nodes,
                          const Assembly& all) const {
        const Mesh& mesh = nodes.mesh();
        const Particles& at = all.particles;
        // Grains may straddle the ends of a periodic mesh, but no particle is a whole length away.
        const double beyond = mesh.periodic_x ? mesh.length_x() : 0, left = mesh.x_low - beyond,
                     right = mesh.x_high() + beyond;
        const auto outside = [&](double x_least, double x_most, double y_least, double y_most) {
            return x_least < left || x_most > right || y_least < mesh.y_low ||
                   y_most > mesh.y_high();
        };
        for (std::size_t k = 0; k < tiles.size(); ++k) {
            const Sums& s = tiles[k];
            const Tile& tile = nodes.tiles()[k];
            const Grain& grain = all.grains[tile.grain];
            const RigidMotion& motion = all.rigid[tile.grain];
            const bool finite = std::isfinite(grain.rigid ? motion.vx + motion.vy : s.kinetic);
            if (s.least_V > 0 && finite && !outside(s.x_least, s.x_most, s.y_least, s.y_most))
                continue;
            const std::string whose = "a particle of grain '" + grain.name + "'";
            // Shows the first particle of the tile that is bad.
            const auto fail = [&](const std::string& what, const auto& is_bad,
                                  const std::string& rest) {
                long p = tile.begin;
                while (p < tile.end && !is_bad(p)) ++p;
                throw common::NumericalError(what + place_of(at, p < tile.end ? p : tile.begin) +
                                             rest);
            };
            if (!(s.least_V > 0))
                fail(
                    "the volume of " + whose, [&](long p) { return !(at.V_p[p] > 0); },
                    " is inverted" + when(step) +
                        ": reduce time.alpha, refine the mesh, or load the grain more slowly");
            if (!finite)
                fail(
                    "the velocity of " + whose,
                    [&](long p) { return !std::isfinite(at.vx_p[p] + at.vy_p[p]); },
                    " is not finite" + when(step + 1) + ": reduce time.alpha");
            fail(
                whose + " has left the mesh",
                [&](long p) { return outside(at.x_p[p], at.x_p[p], at.y_p[p], at.y_p[p]); },
                when(step + 1) +
                    (grain.rigid ? ": widen the mesh, or end its motion before that"
                                 : ": widen the mesh, put a wall there, or reduce time.alpha if "
                                   "the grain has burst"));
        }
    }

    void refuse_energy(long step, const Assembly& all, double put_in, double now) const {
        if (std::isfinite(now) && !(parameters_.energy_limit > 0 &&
                                    now > parameters_.energy_limit * put_in && put_in > 0))
            return;
        const Particles& at = all.particles;
        // Name the grain that moves fastest.
        long fastest = 0;
        std::size_t whose = 0;
        double most = -1;
        for (std::size_t g = 0; g < all.grains.size(); ++g) {
            const Grain& grain = all.grains[g];
            for (long p = grain.begin; p < grain.end && !grain.rigid; ++p) {
                const double speed = std::hypot(at.vx_p[p], at.vy_p[p]);
                if (speed > most) most = speed, fastest = p, whose = g;
            }
        }
        throw common::NumericalError(
            "the energy is " + format(now) + ", and " + format(put_in) + " was put in," +
            when(step) + "; fastest is grain '" + all.grains[whose].name + "'" +
            place_of(at, fastest) +
            ": reduce time.alpha, refine the mesh, or allow more with time.energy_limit");
    }

    static constexpr std::size_t most_tracked = 16;  // free grains, rigid ones, bonds
    const Case& parameters_;
    const Scales& scales_;
    theory::PlannedCase planned_;
    const theory::Comparison* comparison_;  // null: none
    std::string rest_;
    std::vector<std::size_t> tracked_;    // grains
    std::optional<double> largest_load_;  // largest work of the loads so far
};

}  // namespace mpm
