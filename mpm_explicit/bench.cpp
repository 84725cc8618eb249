// How fast the loop of mpm_explicit.cpp is, and where its time goes: the same calls with a clock
// between them, on a million particles in 18 and in 2000 grains that a plate presses, with friction,
// by one thread and by two. `make bench` runs it.
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/step.hpp"
#include "tests/support/core_limits.hpp"

namespace {

using namespace mpm_explicit;

// The compressed grains: rows of `columns` and one less disks in a box of width 1, below a plate.
Case compressed(long columns, long rows, double particles) {
    Case w;
    Problem& problem = w.problem;
    const double R = 0.5 / static_cast<double>(columns),
                 height = R * (2 + std::sqrt(3.0) * static_cast<double>(rows - 1));
    PackCase pack;
    pack.name = "disk", pack.columns = columns, pack.rows = rows;
    pack.x = R, pack.y = R, pack.radius = R;
    const double disks = static_cast<double>(rows * columns - rows / 2),
                 area = disks * std::numbers::pi * R * R;
    problem.cells_x = std::lround(0.5 * std::sqrt(particles / area));
    problem.length_x = 1;
    const double h = 1 / static_cast<double>(problem.cells_x);
    GrainCase plate;
    plate.name = "plate", plate.shape = "box", plate.material = "plate";
    plate.x = 0.5, plate.width = 1, plate.height = 4 * h;
    plate.y = height + 2.001 * h, plate.velocity_y = -0.1;
    problem.cells_y = std::lround(std::ceil((plate.y + 2.5 * h) / h));
    MaterialCase rigid, elastic;
    rigid.name = "plate", rigid.law = "rigid";
    elastic.name = "default", elastic.material.E = 1e5;
    problem.materials = {elastic, rigid};
    problem.packs = {pack}, problem.grains = {plate};
    problem.walls = {"frictional", "frictional", "frictional", "open"};
    problem.contact.friction = 0.3;
    return w;
}

common::StepClock time_steps(const Case& w, long steps, int threads, long& particle_count,
                             long& grain_count) {
    common::set_thread_count(threads);
    const Scales scales = scales_of(w);
    const double dt = scales.dt;
    const LinearShape shape;
    State state;
    state.assembly = assemble(w.problem);
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    std::vector<RigidMotion>& rigid = state.assembly.rigid;
    particle_count = particles.count(), grain_count = static_cast<long>(grains.size());
    const std::vector<AnyLaw> laws = laws_of(w.problem);
    const Contact contact(w.problem.contact, grains, state.assembly.bonds);
    GrainNodes nodes(w.problem.mesh(), LinearShape::width, scales.least_mass);
    nodes.sort(grains, particles, state.layout);
    start_leapfrog(shape, laws, contact, w.transfers(), false, dt, nodes, state);
    StepSums sums;

    common::StepClock clock;
    for (long step = 0; step <= steps; ++step) {
        if (step == 1) clock.restart();  // the first step meets empty caches
        // A sort as often as a grain that moves with the plate needs it is rare; here it is counted
        // once.
        if (step == steps) nodes.sort(grains, particles, state.layout);
        clock.lap("sort");
        const BodyForce body = apply_loads(w.problem.loads(), step, dt, rigid);
        take_step(shape, laws, contact, body, w.transfers(), w.frozen, dt, nodes, state, sums,
                  clock);
        add_energies(step, sums.tiles, state.budget);
        add_work(nodes.tiles(), sums.tiles, sums.nodes, sums.contact, state.budget);
        clock.lap("move");
    }
    return clock;
}

// What a particle takes with linear shapes and Hooke's law, counted in the code; where it is in its
// cell, 12. put: momentum and moments 4, V sigma 3; for a node its S and grad S 3, eight sums 16, force 8.
// stress: gradient 10 per node and 4, halfway 16, two turns 18 each, law and energies 71; force 3, and 10
// per node. move: 11 per node, FLIP and PIC 8, position 8, sums of energies and momenta 32.
struct Loop {
    const char* name;
    support::Count count;
};
const std::vector<Loop> loops{
    {"put", {12 + 7 + 4 * (3 + 16 + 8), 72}},  // x, v, m, V, three stresses
    {"stress", {12 + 4 * 10 + 4 + 16 + 2 * 18 + 71 + 12 + 3 + 4 * 10, 96}},  // x; V, four and back
    {"move", {12 + 4 * 11 + 8 + 8 + 32, 72}}};                               // m; x, v and back

}  // namespace

int main() {
    constexpr long steps = 40;
    std::printf(
        "mpm_explicit, compressed grains, linear shape functions, contact and friction, %ld "
        "steps\n\n",
        steps);
    std::printf("%8s %10s %8s %16s %9s %7s %7s %7s %8s %7s %7s\n", "grains", "particles", "threads",
                "particle-steps/s", "speed-up", "put", "stress", "nodes", "contact", "move",
                "sort");
    long particles = 0, grains = 0;
    std::vector<double> one_thread, seconds;
    for (const auto& [columns, rows] : {std::pair(5L, 4L), std::pair(45L, 45L)}) {
        const Case w = compressed(columns, rows, 1e6);
        for (const int threads : {1, 2}) {
            const common::StepClock clock = time_steps(w, steps, threads, particles, grains);
            const double rate =
                static_cast<double>(particles) * static_cast<double>(steps) / clock.total();
            if (threads == 1) one_thread.push_back(rate);
            if (threads == 1 && seconds.empty())
                for (const Loop& loop : loops)
                    seconds.push_back(clock.seconds(loop.name) /
                                      static_cast<double>(particles * steps));
            const auto percent = [&](const char* part) {
                return 100 * clock.seconds(part) / clock.total();
            };
            std::printf(
                "%8ld %10ld %8d %16.4g %9.2f %6.1f%% %6.1f%% %6.1f%% %7.1f%% %6.1f%% %6.1f%%\n",
                grains, particles, threads, rate, rate / one_thread.back(), percent("put"),
                percent("stress"), percent("nodes"), percent("contact"), percent("move"),
                percent("sort"));
        }
    }
    const double peak = support::peak_flops<double>(), triad = support::triad_bytes();
    support::print_limits(peak, triad);
    for (std::size_t k = 0; k < seconds.size(); ++k)
        support::print_use(loops[k].name, seconds[k], loops[k].count, peak, triad);
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    std::printf(
        "\ntime per particle-step, many grains over few: %.2f; %zu bytes carried by a particle; "
        "peak "
        "memory %.1f MiB\n",
        one_thread.front() / one_thread.back(), Particles{}.all().size() * sizeof(double),
        static_cast<double>(usage.ru_maxrss) / 1024);
    return 0;
}
