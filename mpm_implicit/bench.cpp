// What a step of mpm_implicit costs: the headline runs, and a pack of a hundred thousand particles
// beside mpm_explicit on the same pack. `make bench` runs it.
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/step.hpp"
#include "mpm_implicit/step.hpp"

namespace {

using namespace mpm;

// Two disks that meet, as in cases/rebound.toml.
Case rebound() {
    Case w;
    MaterialCase elastic;
    elastic.name = "default", elastic.material.E = 1e4;
    w.problem.materials = {elastic};
    for (const double side : {-1.0, 1.0}) {
        GrainCase disk;
        disk.name = side < 0 ? "left" : "right";
        disk.x = 0.6 + 0.25 * side, disk.y = 0.3, disk.radius = 0.2, disk.velocity_x = -0.1 * side;
        w.problem.grains.push_back(disk);
    }
    w.alpha = 1, w.end = 2;
    return w;
}

// Eighteen disks below a plate, as in cases/compressed.toml.
Case compressed(long cells) {
    Case w;
    Problem& problem = w.problem;
    problem.cells_x = cells, problem.length_x = 1;
    const double h = 1 / static_cast<double>(cells), R = 0.1;
    PackCase pack;
    pack.name = "disk", pack.x = pack.y = R;
    GrainCase plate;
    plate.name = plate.material = "plate", plate.shape = "box";
    plate.x = 0.5, plate.width = 1, plate.height = 8 * h;
    plate.y = R * (2 + 3 * std::sqrt(3.0)) + 4.001 * h, plate.velocity_y = -0.1;
    problem.cells_y = std::lround(std::ceil((plate.y + 4.5 * h) / h));
    MaterialCase rigid, elastic;
    rigid.name = "plate", rigid.law = "rigid";
    elastic.name = "default", elastic.material.E = 1e5;
    problem.materials = {elastic, rigid};
    problem.packs = {pack}, problem.grains = {plate};
    problem.walls = {"frictional", "frictional", "frictional", "open"};
    w.alpha = 4, w.end = 0.3;
    return w;
}

double explicit_step(Case w, long first, long steps) {
    using namespace mpm_explicit;
    w.alpha = 0.25;
    const Scales scales = scales_of(w);
    const double dt = scales.dt;
    const LinearShape shape;
    mpm_explicit::State state;
    state.assembly = assemble(w.problem);
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    const std::vector<AnyLaw> laws = laws_of(w.problem);
    const Contact contact(w.problem.contact, grains, state.assembly.bonds);
    GrainNodes nodes(w.problem.mesh(), LinearShape::width, scales.least_mass);
    nodes.sort(grains, particles, state.layout);
    start_leapfrog(shape, laws, contact, w.transfers(), false, dt, nodes, state);
    StepSums sums;
    common::StepClock clock;
    for (long step = 0; step < first + steps; ++step) {
        if (step == first) clock.restart();
        if (nodes.sort_is_due(state.layout)) nodes.sort(grains, particles, state.layout);
        const BodyForce body = mpm::apply_loads(w.problem.loads(), step, dt, state.assembly.rigid);
        take_step(shape, laws, contact, body, w.transfers(), w.frozen, dt, nodes, state, sums,
                  clock);
    }
    return clock.total() / static_cast<double>(steps);
}

struct Split {
    common::StepClock clock;
    long steps = 0, count = 0, iterations = 0, mass_iterations = 0, loops = 0;
};

// in: steps to be run, or 0: to the end; of them, the first are not counted
Split implicit_steps(const Case& w, const mpm_implicit::ThetaScheme& scheme, long first,
                     long steps) {
    using namespace mpm_implicit;
    const Scales scales = scales_of(w);
    const double dt = scales.dt;
    const LinearShape shape;
    mpm_implicit::State state;
    state.assembly = assemble(w.problem);
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    const std::vector<AnyLaw> laws = laws_of(w.problem);
    const Contact contact(contact_rule(w.problem, dt), grains, state.assembly.bonds);
    GrainNodes nodes(w.problem.mesh(), LinearShape::width, scales.least_mass);
    nodes.sort(grains, particles, state.layout);
    mpm_implicit::start_budget(state.assembly, laws, state.budget);
    StepScratch<1> scratch{laws, scheme, contact, w.flip, w.frozen, {}, {}};
    mpm_implicit::StepSums sums;
    Split split;
    for (long step = 0; step < (steps > 0 ? first + steps : scales.steps); ++step) {
        if (step == first) split = {};
        split.clock.resume();
        if (nodes.sort_is_due(state.layout)) nodes.sort(grains, particles, state.layout);
        const BodyForce body = mpm_implicit::apply_loads(
            w.problem.loads(), step, dt, state.assembly.rigid, scratch.solver.force_controls);
        take_step(shape, body, dt, scratch, nodes, state, sums, split.clock);
        add_step(scheme.theta, scheme.consistent(), nodes.tiles(), sums.tiles, sums.nodes,
                 sums.contact, state.budget);
        split.clock.lap("particles");
        const SolveReport& report = sums.solver;
        ++split.steps, split.iterations += report.iterations, split.loops += report.loops;
        split.mass_iterations += report.mass_iterations;
    }
    split.count = particles.count();
    return split;
}

}  // namespace

int main() {
    mpm_implicit::ThetaScheme scheme;
    std::printf("mpm_implicit, theta = 1/2, consistent mass, linear shape functions\n\n");
    std::printf("%-34s %8s %10s %8s %10s\n", "whole runs", "threads", "particles", "steps",
                "seconds");
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        const Split one = implicit_steps(rebound(), scheme, 0, 0);
        std::printf("%-34s %8d %10ld %8ld %10.2f\n", "rebound, alpha = 1", threads, one.count,
                    one.steps, one.clock.total());
        const Split two = implicit_steps(compressed(80), scheme, 0, 0);
        std::printf("%-34s %8d %10ld %8ld %10.2f\n", "compressed, alpha = 4", threads, two.count,
                    two.steps, two.clock.total());
    }

    // A quarter of the way into the compression, every grain bears load.
    const Case pack = compressed(200);
    std::printf("\nthe compressed pack with 1e5 particles; explicit at alpha = 0.25\n");
    std::printf("%7s %6s %10s %10s %9s %9s %6s %6s %7s %7s %7s %7s %7s\n", "threads", "alpha",
                "ms/step", "explicit", "in steps", "ratio", "iter", "loops", "put", "matrix", "v^0",
                "v^theta", "move");
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        const double step = explicit_step(pack, 600, 100);
        for (const double alpha : {4.0, 16.0, 64.0}) {
            Case w = pack;
            w.alpha = alpha;
            const long first = std::lround(150 / alpha) + 1, steps = alpha > 20 ? 4 : 8;
            const Split split = implicit_steps(w, scheme, first, steps);
            const double n = static_cast<double>(split.steps), each = split.clock.total() / n;
            const auto percent = [&](const char* part) {
                return 100 * split.clock.seconds(part) / split.clock.total();
            };
            std::printf(
                "%7d %6.0f %10.1f %10.2f %9.1f %9.2f %6.1f %6.1f %6.1f%% %6.1f%% %6.1f%% %6.1f%% "
                "%6.1f%%\n",
                threads, alpha, 1e3 * each, 1e3 * step, each / step, each / (4 * alpha * step),
                static_cast<double>(split.iterations) / n, static_cast<double>(split.loops) / n,
                percent("put"), percent("matrix"), percent("v_0"), percent("v_theta"),
                percent("particles"));
        }
    }
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    std::printf(
        "\nin steps: an implicit step over an explicit one; ratio: time for equal simulated time, "
        "implicit over explicit; peak memory %.1f MiB\n",
        static_cast<double>(usage.ru_maxrss) / 1024);
    return 0;
}
