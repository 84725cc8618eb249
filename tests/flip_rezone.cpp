// Splitting and merging particles: what the mesh must not notice, and what it is for.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "flip/flip/deposit_particles.hpp"
#include "flip/flip/rezone.hpp"
#include "flip/output/flip_diagnostics.hpp"
#include "flip/setup/problem_of_case.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using namespace flip;
using facts::eps, facts::worst;

// Two materials, particles anywhere and of any mass, in a plane or in a row of cells.
struct Cloud {
    Case w;
    Particles p;
    Mesh before, after;
    Totals totals_before, totals_after;
    long added = 0;  // particles, by rezone_all()

    Cloud(bool plane, long fewest, long most, bool volumes = false) {
        w.grid.x.cells = 12;
        w.grid.z.cells = plane ? 9 : 1;
        w.grid.z.length = plane ? 0.8 : 0.1;
        w.boundaries[x_low].kind = w.boundaries[x_high].kind = "slip";
        w.materials = {{"light", 1.4, 0}, {"heavy", 1.6, 0}};
        w.per_cell_x = 4;
        w.per_cell_z = plane ? 4 : 1;
        w.min_particles = fewest;
        w.max_particles = most;
        if (volumes) w.density = "particles";
        RegionCase light, heavy;
        light.gas = {"light", 1, 1, 0.3, -0.2};
        heavy.gas = {"heavy", 3, 1, -0.4, 0.1};
        heavy.shape = "disk";
        heavy.center_x = 0.5;
        heavy.center_z = 0.4;
        heavy.radius = 0.3;
        w.regions = {light, heavy};
        w = completed(w);
        p = load_particles(w);
        for (std::size_t k = 0; k < p.x_p.size(); ++k) {
            const auto any = [&](std::uint32_t what) { return common::uniform(1, 9, k, what); };
            p.x_p[k] = w.grid.x.low + w.grid.x.length * any(0);
            p.z_p[k] = w.grid.z.low + w.grid.z.length * any(1);
            p.m_p[k] *= 0.5 + any(2);
            p.e_p[k] *= 0.5 + any(3);
            p.vx_p[k] += any(4);
            p.vz_p[k] -= any(5);
        }
    }

    void rezone_all() {
        const Problem problem = problem_of(w);
        SortScratch scratch;
        sort_particles(w.grid, scratch, p);
        before = mesh_of(problem), after = mesh_of(problem);
        deposit_particles(w.grid, w.materials, p, before);
        totals_before = particle_totals(w.grid, p);
        added = -p.count();
        rezone(problem, p);
        added += p.count();
        sort_particles(w.grid, scratch, p);
        deposit_particles(w.grid, w.materials, p, after);
        totals_after = particle_totals(w.grid, p);
    }

    double node_change() const {
        double most = 0;
        for (std::size_t n = 0; n < before.nodes.sum.size(); ++n)
            for (int k = 0; k < 3; ++k)
                most = worst({most, std::fabs(before.nodes.sum[n][k] - after.nodes.sum[n][k])});
        return most;
    }
    double cell_change(bool energy) const {
        double most = 0;
        for (long j = 0; j < w.grid.z.cells; ++j) {
            for (long i = 0; i < w.grid.x.cells; ++i) {
                for (std::size_t k = 0; k < w.materials.size(); ++k) {
                    const auto n = std::size_t(w.grid.index(i, j)) * w.materials.size() + k;
                    const CellSum &a = before.cells.sum[n], &b = after.cells.sum[n];
                    most = worst({most, std::fabs(energy ? a.U - b.U : a.M - b.M)});
                }
            }
        }
        return most;
    }
    // Particles of one material in one cell: the fewest and the most of all that are not empty.
    std::array<long, 2> range() const {
        std::vector<long> number(std::size_t(w.grid.x.cells * w.grid.z.cells) * w.materials.size(),
                                 0);
        for (std::size_t k = 0; k < p.x_p.size(); ++k)
            ++number[std::size_t(
                (cell_along(w.grid.z, p.z_p[k]) * w.grid.x.cells + cell_along(w.grid.x, p.x_p[k])) *
                    long(w.materials.size()) +
                p.material[k])];
        std::array<long, 2> found{1000000, 0};
        for (const long n : number) {
            if (n == 0) continue;
            found[0] = std::min(found[0], n);
            found[1] = std::max(found[1], n);
        }
        return found;
    }
};

}  // namespace

TEST_CASE("splitting changes no sum on the mesh and feeds the poorest cell") {
    for (const bool plane : {true, false}) {
        CAPTURE(plane);
        Cloud cloud(plane, plane ? 12 : 4, 1000);
        const long poorest = cloud.range()[0], children = plane ? 3 : 1;
        cloud.rezone_all();
        CHECK(cloud.added >= 4 * children);
        CHECK(cloud.added % children == 0);
        CHECK(cloud.node_change() <= 100 * eps * cloud.totals_before.mass);
        CHECK(cloud.cell_change(false) <= 100 * eps * cloud.totals_before.mass);
        CHECK(cloud.cell_change(true) <= 100 * eps * cloud.totals_before.internal);
        CHECK(std::fabs(cloud.totals_after.kinetic - cloud.totals_before.kinetic) <=
              100 * eps * cloud.totals_before.kinetic);
        CHECK(cloud.range()[0] > poorest);
    }
}

TEST_CASE("merging keeps mass and momentum of every node and the energy of all") {
    for (const bool plane : {true, false}) {
        for (const bool volumes : {false, true}) {
            CAPTURE(plane);
            CAPTURE(volumes);
            Cloud cloud(plane, 1, plane ? 12 : 3, volumes);
            const std::array<long, 2> start = cloud.range();
            double volume = 0;
            for (const double V : cloud.p.V_p) volume += V;
            cloud.rezone_all();
            CHECK(cloud.added <= -5);
            CHECK(cloud.range()[1] < start[1]);
            CHECK(cloud.node_change() <= 1000 * eps * cloud.totals_before.mass);
            CHECK(cloud.cell_change(false) <= 1000 * eps * cloud.totals_before.mass);
            const double energy = cloud.totals_before.kinetic + cloud.totals_before.internal;
            CHECK(std::fabs(cloud.totals_after.kinetic + cloud.totals_after.internal - energy) <=
                  1000 * eps * energy);
            CHECK(cloud.totals_after.kinetic < cloud.totals_before.kinetic);
            for (const double m : cloud.p.m_p) CHECK(m > 0);
            for (const double e : cloud.p.e_p) CHECK(e >= 0);
            for (const double V : cloud.p.V_p) volume -= V;
            CHECK(std::fabs(volume) <= 1000 * eps);
        }
    }
}

TEST_CASE("merging particles that move alike makes no heat") {
    Cloud cloud(true, 1, 12);
    for (std::size_t k = 0; k < cloud.p.x_p.size(); ++k) {
        cloud.p.vz_p[k] = -0.2;
        cloud.p.e_p[k] = 1;
    }
    for (double& v : cloud.p.vx_p) v = 0.7;
    cloud.rezone_all();
    CHECK(cloud.added < -5);
    CHECK(cloud.cell_change(true) <= 1000 * eps * cloud.totals_before.internal);
    for (const double e : cloud.p.e_p) CHECK(std::fabs(e - 1) <= 1000 * eps);
    for (const double v : cloud.p.vx_p) CHECK(std::fabs(v - 0.7) <= 1000 * eps);
}

TEST_CASE("particles at the edge of a fluid are not split") {
    // A single disk in a void: its outermost cells are poor because they are half empty.
    Cloud cloud(true, 12, 1000);
    cloud.w.regions.erase(cloud.w.regions.begin());
    cloud.p = load_particles(cloud.w);
    const auto count_far = [&] {
        long far = 0;
        for (std::size_t k = 0; k < cloud.p.x_p.size(); ++k)
            far += std::hypot(cloud.p.x_p[k] - 0.5, cloud.p.z_p[k] - 0.4) > 0.29;
        return far;
    };
    const long before = count_far(), count = cloud.p.count();
    cloud.rezone_all();
    CHECK(before > 10);
    CHECK(count_far() == before);
    CHECK(cloud.p.count() == count);
}
