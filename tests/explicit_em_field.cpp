// Facts about the leapfrogged field of explicit_em, and about its whole loop.
#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "implicit_moment/explicit_em/setup/check_leapfrog.hpp"
#include "implicit_moment/explicit_em/setup/leapfrog_state.hpp"
#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/output/diagnostics.hpp"
#include "tests/support/any_leapfrog.hpp"

namespace {

using namespace facts;
using implicit_moment::interior;

// Sum of squares of all unknowns.
double squares(const Grid& grid, const VectorField& f) {
    return field_energy(grid, f) * 8 * pi / grid.cell_area();
}

// A mode of one component: cosines, or between walls sines or cosines as its parity says.
double mode(const common::Axis& axis, long number, bool half, int parity, long i) {
    const double angle = pi * real(number) * (real(i) + 0.5 * half) / real(axis.cells);
    return axis.periodic ? std::cos(2 * angle) : parity > 0 ? std::cos(angle) : std::sin(angle);
}
double wave_number(const common::Axis& axis, long number) {
    return (axis.periodic ? 2 : 1) * pi * real(number) / axis.length;
}

// A run of explicit_em in memory.
struct Loop {
    Case parameters;
    State state;
    LeapfrogScratch scratch;

    explicit Loop(const Case& w)
        : parameters(w), state(leapfrog_state(parameters)), scratch(parameters.grid) {}
    void interleave() {
        interleave_field(parameters.grid, parameters.field.smoothing, state.field, scratch);
    }
    void step() {
        interleave();
        take_step(parameters.grid, parameters.dt, parameters.leapfrog, parameters.field.smoothing,
                  scratch, state.plasma.species, state.field);
    }
    // div E - 4 pi rho, rho by definition; its mean in a periodic box has no field.
    Field gauss() const {
        Field rho = Field::Zero(parameters.grid.size()), pass, G = rho;
        for (const Particles& particles : state.plasma.species)
            rho += charge(parameters.grid, parameters.leapfrog.order, felt_charge(parameters.grid),
                          particles);
        const common::Axis &x = parameters.grid.x, &z = parameters.grid.z;
        if (x.periodic && z.periodic)
            rho.array() -= total(parameters.grid, on_nodes, rho) / (x.length * z.length);
        common::fill_ghosts(parameters.grid, on_nodes, felt_charge(parameters.grid), rho.data());
        smooth(parameters.grid, on_nodes, felt_charge(parameters.grid), parameters.field.smoothing,
               rho.data(), pass);
        divergence_of_electric(parameters.grid, state.field.E.all.data(), G);
        G -= 4 * pi * rho;
        common::fill_ghosts(parameters.grid, on_nodes, {-1, -1}, G.data());
        return G;
    }
    std::vector<Moments> moments() {
        interleave();
        return find_moments(parameters.grid, parameters.dt, parameters.leapfrog,
                            state.plasma.species, Images::conductor, scratch);
    }
    double energy() {
        double sum = field_energy(parameters.grid, state.field.E) +
                     field_energy(parameters.grid, state.field.B);
        for (const Moments& m : moments()) sum += m.kinetic_energy;
        return sum;
    }
};

// Hot ions and electrons that fly up to two thirds of a cell per step, in a field that is not zero.
Case hot_plasma(const Grid& grid, long order, long passes) {
    Case w;
    w.grid = grid;
    w.dt = 0.8 * courant_limit(grid);
    w.setup = "uniform", w.loading = "random";
    w.leapfrog = {true, order, true};
    w.field.smoothing = {passes, true};
    w.uniform.particles_per_cell = 8;
    w.uniform.B_y = 0.3;
    SpeciesCase ions, electrons;
    ions.name = "ions", electrons.name = "electrons";
    electrons.charge = -1, electrons.mass = 0.25, electrons.density = 0.8;
    for (SpeciesCase* s : {&ions, &electrons}) {
        s->temperature_x = s->temperature_y = s->temperature_z = 0.25 * s->mass;
        s->drift_x = 0.1 * s->charge, s->drift_z = -0.2 * s->charge, s->drift_y = 0.05;
        w.uniform.species.push_back(*s);
    }
    return w;
}

}  // namespace

// ---- Yee's mesh ---------------------------------------------------------------------------------

TEST_CASE("waves in vacuum have the frequency of Yee's mesh and are not damped") {
    for (const Grid& grid : meshes()) {
        for (const auto& waves : {std::pair{1L, 0L}, {0L, 1L}, {1L, 2L}, {3L, 1L}, {3L, 3L}}) {
            const long m = waves.first, n = waves.second;
            for (const double part : {0.2, 0.9, 0.999}) {
                const double step = part * courant_limit(grid);
                const double omega =
                    yee_frequency(grid, step, wave_number(grid.x, m), wave_number(grid.z, n));
                for (const bool of_B : {false, true}) {
                    // E_y or B_y, with the other field in the plane.
                    const VectorKind& kind = of_B ? magnetic : electric;
                    const Place place = kind.place[1];
                    FieldState field(grid);
                    VectorField& f = of_B ? field.B : field.E;
                    for_each_distinct(grid, place, [&](long i, long j, long k) {
                        f.y()[k] = mode(grid.x, m, place.half_x, kind.parity[1].x, i) *
                                   mode(grid.z, n, place.half_z, kind.parity[1].z, j);
                    });
                    fill_ghosts(grid, kind, f);
                    const Field start = f.all;
                    const VectorField no_current(grid);
                    for (int k = 1; k <= 300; ++k) {
                        advance_field(grid, step, no_current, field);
                        if (k % 50 == 0) {
                            CHECK(largest(f.all - std::cos(k * omega * step) * start) <= 1e-11);
                        }
                    }
                }
            }
        }
    }
}

TEST_CASE("below the limit of light a field in vacuum stays bounded and above it grows") {
    Random random;
    // Even numbers of cells, so that the shortest wave fits.
    const Grid grid{{8, 0, 4, true}, {6, 0, 1.8, true}};
    const auto size_after = [&](double part) {
        FieldState field(grid);
        field.E = random.field(grid, electric);
        const double start = squares(grid, field.E);
        const VectorField no_current(grid);
        double most = 0;
        for (int k = 0; k < 1000; ++k) {
            advance_field(grid, part * courant_limit(grid), no_current, field);
            most = worst({most, squares(grid, field.E) / start});
        }
        return most;
    };
    CHECK(size_after(0.9999) <= 1 + 1e-12);  // a sum of cosines of modes
    CHECK(size_after(1.0005) >= 1e6);
}

TEST_CASE("a vacuum field keeps its leapfrogged energy") {
    Random random;
    for (const Grid& grid : meshes()) {
        FieldState field(grid);
        field.E = random.field(grid, electric), field.B = random.field(grid, magnetic);
        const double dt = 0.95 * courant_limit(grid);
        const auto energy = [&] {  // E^n E^n + B^{n-1/2} B^{n+1/2}
            VectorField curl(grid), before = field.B, after = field.B;
            curl_of_electric(grid, field.E.all.data(), curl.all.data());
            before.all += 0.5 * c * dt * curl.all, after.all -= 0.5 * c * dt * curl.all;
            double product = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                const long from = long(a) * grid.size();
                product += total(grid, magnetic.place[a],
                                 before.all.segment(from, grid.size())
                                     .cwiseProduct(after.all.segment(from, grid.size())));
            }
            return squares(grid, field.E) + product / grid.cell_area();
        };
        const double start = energy();
        const VectorField no_current(grid);
        for (int k = 0; k < 100; ++k) advance_field(grid, dt, no_current, field);
        CHECK(std::fabs(energy() / start - 1) <= 1e-12);
    }
}

TEST_CASE("a step changes div E by the divergence of the current and leaves div B") {
    Random random;
    for (const Grid& grid : meshes()) {
        FieldState field(grid);
        field.E = random.field(grid, electric), field.B = random.field(grid, magnetic);
        const VectorField J = random.field(grid, electric);
        const double dt = 0.7 * courant_limit(grid);
        const auto divergences = [&] {
            std::pair<Field, Field> both{Field::Zero(grid.size()), Field::Zero(grid.size())};
            divergence_of_electric(grid, field.E.all.data(), both.first);
            divergence_of_magnetic(grid, field.B.all.data(), both.second);
            return both;
        };
        Field div_J = Field::Zero(grid.size());
        divergence_of_electric(grid, J.all.data(), div_J);
        const auto before = divergences();
        advance_field(grid, dt, J, field);
        const auto after = divergences();
        CHECK(largest(grid, on_nodes, after.first - before.first + 4 * pi * dt * div_J) <= 1e-13);
        CHECK(largest(grid, on_faces, after.second - before.second) <= 1e-13);
        // J_y, which has no divergence, and ghosts.
        VectorField E = field.E, B = field.B;
        fill_ghosts(grid, electric, E), fill_ghosts(grid, magnetic, B);
        CHECK(E.all == field.E.all);
        CHECK(B.all == field.B.all);
        FieldState rest(grid);
        advance_field(grid, dt, J, rest);
        rest.E.all += 4 * pi * dt * J.all;
        CHECK(largest(grid, electric, rest.E) <= 4 * eps);
    }
}

TEST_CASE("particles are pushed by the smoothed E and by B itself") {
    Random random;
    for (const Grid& grid : meshes()) {
        FieldState field(grid);
        field.E = random.field(grid, electric), field.B = random.field(grid, magnetic);
        for (const SmoothingSettings smoothing :
             {SmoothingSettings{0, true}, {1, false}, {3, true}}) {
            VectorField E = field.E;
            InterleaveScratch scratch(grid);
            Field room;
            const FieldState before = field;
            const VectorKind kind = implicit_moment::felt(grid);
            fill_ghosts(grid, kind, E);
            smooth(grid, kind, smoothing, E.all.data(), room);
            InterleavedField push;
            interleave_field(grid, smoothing, field.E, field.B, scratch, push);
            const InterleavedField expected = pack(grid, E, field.B);
            REQUIRE(push.size() == expected.size());
            long wrong = 0;
            for (std::size_t n = 0; n < push.size(); ++n) {
                wrong += push[n].E_x != expected[n].E_x || push[n].E_y != expected[n].E_y ||
                         push[n].E_z != expected[n].E_z || push[n].B_x != expected[n].B_x ||
                         push[n].B_y != expected[n].B_y || push[n].B_z != expected[n].B_z;
            }
            CHECK(wrong == 0);
            CHECK(field.E.all == before.E.all);
        }
    }
}

// ---- the loop -----------------------------------------------------------------------------------

TEST_CASE("Gauss's law holds at the start and its residual stays to round-off in every step") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            for (const long passes : {0, 2}) {
                Loop loop(hot_plasma(grid, order, passes));
                FieldState& field = loop.state.field;
                const VectorField A = random.field(grid, electric, 0.05);
                VectorField wave(grid);
                curl_of_electric(grid, A.all.data(), wave.all.data());
                fill_ghosts(grid, magnetic, wave);
                field.B.all += wave.all;
                const Field first = loop.gauss(), E = field.E.all;
                CHECK(largest(E) >= 0.01);
                CHECK(largest(grid, on_nodes, first) <= 2e-13);
                Field div_B = Field::Zero(grid.size());
                divergence_of_magnetic(grid, field.B.all.data(), div_B);
                for (int step = 0; step < 20; ++step) {
                    loop.step();
                    CHECK(largest(grid, on_nodes, loop.gauss() - first) <= 2e-13);
                }
                CHECK(largest(field.E.all - E) >= 0.01);
                Field now = Field::Zero(grid.size());
                divergence_of_magnetic(grid, field.B.all.data(), now);
                CHECK(largest(grid, on_faces, now - div_B) <= 2e-14);
            }
        }
    }
}

TEST_CASE("at the start velocities are half a step back and moments bring them forth") {
    for (const Grid& grid : meshes()) {
        for (const auto& [order, passes] : {std::pair{1L, 0L}, {2L, 0L}, {1L, 2L}, {2L, 2L}}) {
            const Case parameters = hot_plasma(grid, order, passes);
            Loop loop(parameters);
            const State loaded = loaded_state(parameters);
            const std::vector<Moments> moments = loop.moments();
            CHECK(largest(loop.state.field.E.all) >= 0.01);
            for (std::size_t s = 0; s < 2; ++s) {
                const Particles& particles = loaded.plasma.species[s];
                Vector momentum = Vector::Zero();
                double energy = 0;
                for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                    const Vector u = velocity(particles, p);
                    momentum += particles.m_p * u;
                    energy += particles.m_p * (std::sqrt(1 + u.squaredNorm()) - 1);
                }
                CHECK(std::fabs(moments[s].kinetic_energy / energy - 1) <= 1e-13);
                for (std::size_t a = 0; a < 3; ++a)
                    CHECK(std::fabs(moments[s].momentum[a] - momentum[long(a)]) <=
                          1e-14 * energy * real(particles.count()));
            }
        }
    }
}

// As many particles in every cell at the same places: then the sums over them are exact, for as
// long as none leaves its cell.
TEST_CASE("cold plasma oscillates with the frequency of the leapfrog and above its limit grows") {
    for (const long order : {1, 2}) {
        for (const long in_cell : {4L, 400L}) {
            for (const double W : {0.1, 0.5, 1.5, 1.99, 2.01}) {
                for (const long k : {1L, 3L}) {
                    Case w;
                    w.grid = {{8, 0, 32, true}, {4, 0, 16, true}};
                    w.dt = W;
                    w.leapfrog = {true, order, true};
                    w.field.smoothing.passes = 0;
                    std::vector<Particles> species(1);
                    Particles& electrons = species[0];
                    electrons.m_p = n0 * w.grid.cell_area() / real(in_cell);
                    electrons.q_p = -electrons.m_p;
                    for (double z = 0.3; z < 4; ++z) {
                        for (double x = 0.5 / real(in_cell); x < 8; x += 1 / real(in_cell)) {
                            add(electrons, w.grid.x.at(x), w.grid.z.at(z),
                                {1e-9 * std::cos(pi / 4 * real(k) * x), 0, 0});
                        }
                    }
                    sort(w.grid, order, electrons);
                    FieldState field(w.grid);
                    LeapfrogScratch scratch(w.grid);
                    std::vector<double> E;
                    for (int step = 0; step < 8; ++step) {
                        interleave_field(w.grid, w.field.smoothing, field, scratch);
                        take_step(w.grid, w.dt, w.leapfrog, w.field.smoothing, scratch, species,
                                  field);
                        E.push_back(mode_amplitude(w.grid, field, "E_x", k, 0).real());
                    }
                    // Quadratic splines see a field that varies within a cell.
                    const double n = real(in_cell), wave = std::cos(pi / 4 * real(k));
                    const double seen = order == 1 ? 1 : (2 + wave) / 3 - (1 - wave) / (6 * n * n);
                    for (std::size_t s = 1; s + 1 < E.size(); ++s) {
                        // cos(omega dt); below -1 it grows.
                        const double turn = (E[s + 1] + E[s - 1]) / (2 * E[s]);
                        CHECK(std::fabs(turn - (1 - 0.5 * W * W * seen)) <= 1e-6);
                        if (in_cell == 400 && W < 2) {
                            const double omega = leapfrog_frequency(
                                std::sqrt(order == 1 ? 1 : (2 + wave) / 3), w.dt);
                            CHECK(std::fabs(std::acos(turn) / (omega * w.dt) - 1) <= 2e-5);
                        }
                    }
                }
            }
        }
    }
}

// Beside it the same plasma, kicked by a field that is averaged to the nodes and gathered with the
// splines of the charge, as momentum-conserving codes do.
TEST_CASE("a plasma at rest is hardly heated by cells of ten Debye lengths" *
          doctest::description("physics")) {
    Case w;
    w.grid = {{16, 0, 16, true}, {16, 0, 16, true}};
    w.dt = 0.5;
    w.setup = "uniform";
    w.field.smoothing.passes = 0;
    w.uniform.particles_per_cell = 16;
    SpeciesCase electrons;
    electrons.name = "electrons", electrons.charge = -1;
    electrons.temperature_x = electrons.temperature_y = electrons.temperature_z = 0.01;
    w.uniform.species.push_back(electrons);
    const Grid& grid = w.grid;
    for (const long order : {1, 2}) {
        w.leapfrog = {true, order, true};
        Loop conserving(w), momentum(w);
        const double start = conserving.energy();
        for (int step = 0; step < 400; ++step) {
            conserving.step();
            // The averages stand where E_y lives, on the nodes.
            const VectorField& E = momentum.state.field.E;
            VectorField on_x(grid), on_z(grid), B(grid);
            for_each_point(grid, [&](long n) {
                on_x.y()[n] = 0.5 * (E.x()[n] + E.x()[n - 1]);
                on_z.y()[n] = 0.5 * (E.z()[n] + E.z()[n - grid.stride()]);
            });
            fill_ghosts(grid, electric, on_x);
            fill_ghosts(grid, electric, on_z);
            const InterleavedField push_x = pack(grid, on_x, B), push_z = pack(grid, on_z, B);
            Particles& particles = momentum.state.plasma.species[0];
            const double kick = w.dt * particles.q_p / particles.m_p;
            for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                const double s = in_cells(grid.x, particles.x_p[p]),
                             t = in_cells(grid.z, particles.z_p[p]);
                particles.ux_p[p] += kick * felt(grid, push_x, order, s, t).E_y;
                particles.uz_p[p] += kick * felt(grid, push_z, order, s, t).E_y;
            }
            CurrentScratch scratch;
            std::vector<Crossings> crossings;
            move_particles(pack(grid, VectorField(grid), B), grid, w.dt, w.leapfrog,
                           w.field.smoothing, momentum.state.plasma.species, crossings, scratch,
                           momentum.scratch.J);
            advance_field(grid, w.dt, momentum.scratch.J, momentum.state.field);
            sort_after_push(grid, order, crossings[0], particles);
        }
        const double heated = conserving.energy() / start - 1,
                     much_heated = momentum.energy() / start - 1;
        CAPTURE(order);
        CAPTURE(heated);
        CAPTURE(much_heated);
        CHECK(std::fabs(heated) <= 0.05);
        CHECK(much_heated >= 10 * std::fabs(heated));
    }
}

TEST_CASE("one and two and three threads give the same run to the last bit") {
    const Grid grid{{64, 0, 6.4, true}, {64, 0, 6.4, false}};
    for (const long order : {1, 2}) {
        std::vector<Loop> loops;
        loops.reserve(3);
        for (const int threads : {1, 2, 3}) {
            common::set_thread_count(threads);
            Loop& loop = loops.emplace_back(hot_plasma(grid, order, 2));
            for (int step = 0; step < 5; ++step) loop.step();
            CHECK(loop.state.field.E.all == loops[0].state.field.E.all);
            CHECK(loop.state.field.B.all == loops[0].state.field.B.all);
            CHECK(identical(loop.state.plasma.species[1], loops[0].state.plasma.species[1]));
            CHECK(loop.energy() == loops[0].energy());
        }
        common::set_thread_count(1);
    }
}
