// Facts about the material laws of plane strain: elasticity and its energy, turning stress with the
// body, and yielding against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "mpm_explicit/grains/material_laws.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using namespace facts;
using namespace mpm;

constexpr double pi = std::numbers::pi, root_3 = std::numbers::sqrt3;

struct Random {
    std::mt19937_64 engine{1};
    double operator()() { return 0x1p-52 * static_cast<double>(engine() >> 11) - 1; }
    StrainStep strain(double size) {
        const double x = (*this)(), y = (*this)();
        return {size * x, size * y, size * (*this)()};
    }
    Stress stress() {
        const StrainStep in_plane = strain(1);
        return {in_plane.xx, in_plane.yy, in_plane.xy, (*this)()};
    }
    /// From 1e-4 to 1, as often in every decade.
    double decade() { return std::pow(10, 2 * (*this)() - 2); }
};

Material steel(double hardening) {
    Material m;
    m.law = Law::j2;
    m.E = 200e9, m.nu = 0.3, m.yield_stress = 400e6, m.hardening = hardening;
    return m;
}

constexpr double unlimited = 1e30;

Material soil(double cohesion, double friction, double dilatancy, double tension = unlimited) {
    Material m;
    m.law = Law::drucker_prager;
    m.E = 1e4, m.nu = 0.25;
    m.cohesion = cohesion, m.friction_angle = friction, m.dilatancy_angle = dilatancy;
    m.tension = tension;
    return m;
}

// One of each kind: sand, with a blunt cone, with a tip, associated, without friction.
std::vector<Material> soils() {
    return {soil(0, 30, 0, 0), soil(10, 30, 10, 4), soil(10, 35, 5),         soil(10, 30, 30, 8),
            soil(5, 20, 20),   soil(7, 0, 0, 3),    soil(7, 0, 0, unlimited)};
}

template <class LawOf>
struct Sample {
    LawOf law;
    Stress s{};
    double ep = 0;
    PlasticStep dep{};

    explicit Sample(const Material& m) : law(m) {}
    Sample& step(const StrainStep& de) {
        law(de, s, dep, ep);
        return *this;
    }
    Sample& steps(int count, const StrainStep& de) {
        for (int n = 0; n < count; ++n) step(de);
        return *this;
    }
};

double mean(const Stress& s) { return (s.xx + s.yy + s.zz) / 3; }
double radius(const Stress& s) { return std::hypot(0.5 * (s.xx - s.yy), s.xy); }
double size(const Stress& s) {  // J2^1/2, by the deviator itself
    const double m = mean(s), xx = s.xx - m, yy = s.yy - m, zz = s.zz - m;
    return std::sqrt(0.5 * (xx * xx + yy * yy + zz * zz) + s.xy * s.xy);
}
Stress operator-(const Stress& a, const Stress& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.xy - b.xy, a.zz - b.zz};
}
double largest(const Stress& s) {
    return worst({std::fabs(s.xx), std::fabs(s.yy), std::fabs(s.xy), std::fabs(s.zz)});
}
bool same(const Stress& a, const Stress& b) {
    return a.xx == b.xx && a.yy == b.yy && a.xy == b.xy && a.zz == b.zz;
}
double trace(const PlasticStep& dep) { return dep.xx + dep.yy + dep.zz; }

// (2/3 e : e)^1/2 of the part without volume.
double equivalent(const PlasticStep& dep) {
    const double m = trace(dep) / 3, xx = dep.xx - m, yy = dep.yy - m, zz = dep.zz - m;
    return std::sqrt((xx * xx + yy * yy + zz * zz + 2 * dep.xy * dep.xy) * 2 / 3);
}

// sigma + T : (de - dep), in three dimensions.
Stress stressed(const Material& m, const Stress& s, const StrainStep& de, const PlasticStep& dep) {
    const Moduli T = moduli(m);
    const double volume = T.lambda * (de.xx + de.yy - trace(dep));
    return {s.xx + volume + 2 * T.G * (de.xx - dep.xx), s.yy + volume + 2 * T.G * (de.yy - dep.yy),
            s.xy + 2 * T.G * (de.xy - dep.xy), s.zz + volume - 2 * T.G * dep.zz};
}

// R a R^T of components in the plane, by the angle t.
template <class Tensor>
Tensor turned(Tensor a, double t) {
    const double c = std::cos(t), s = std::sin(t), xx = a.xx, yy = a.yy, xy = a.xy;
    a.xx = c * c * xx + s * s * yy - 2 * c * s * xy;
    a.yy = s * s * xx + c * c * yy + 2 * c * s * xy;
    a.xy = c * s * (xx - yy) + (c * c - s * s) * xy;
    return a;
}

// Walks of random steps, some far beyond yield; visit(before, de, sample).
template <class LawOf, class Visit>
void walk(const Material& m, double yield_strain, const Visit& visit) {
    Random random;
    for (int start = 0; start < 500; ++start) {
        Sample<LawOf> sample(m);
        for (int n = 0; n < 10; ++n) {
            const Sample<LawOf> before = sample;
            const StrainStep de = random.strain(30 * yield_strain * random.decade());
            visit(before, de, sample.step(de));
        }
    }
}

}  // namespace

// ---- elasticity and its energy ------------------------------------------------------------------

TEST_CASE("moduli and the speed of sound are those of Hooke's law") {
    for (const double nu : {-0.5, 0.0, 0.25, 0.45}) {
        Material m;
        m.E = 7, m.nu = nu, m.density = 3;
        const Moduli T = moduli(m);
        CHECK(std::fabs(3 * T.K * (1 - 2 * nu) - m.E) <= 8 * eps * m.E);
        CHECK(std::fabs(9 * T.K * T.G / (3 * T.K + T.G) - m.E) <= 8 * eps * m.E);
        CHECK(std::fabs(T.K - T.lambda - 2 * T.G / 3) <= 8 * eps * m.E);
        const double confined = m.E * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
        CHECK(std::fabs(3 * std::pow(sound_speed(m), 2) - confined) <= 16 * eps * confined);
        m.law = Law::rigid;
        CHECK(moduli(m).G == 0);
        CHECK(moduli(m).lambda == 0);
        CHECK(moduli(m).K == 0);
        CHECK(sound_speed(m) == 0);
    }
}

TEST_CASE("an elastic step is Hooke's law without strain out of the plane") {
    Random random;
    for (const double nu : {-0.5, 0.0, 0.25, 0.45}) {
        Material m;
        m.E = 7, m.nu = nu;
        for (int n = 0; n < 100; ++n) {
            const StrainStep e = random.strain(1);
            Sample<Elastic> sample(m);
            sample.dep = {1, 1, 1, 1};
            const Stress s = sample.step(e).s;
            // Strain from stress, direction by direction.
            CHECK(std::fabs(s.xx - nu * (s.yy + s.zz) - m.E * e.xx) <= 64 * eps * m.E);
            CHECK(std::fabs(s.yy - nu * (s.zz + s.xx) - m.E * e.yy) <= 64 * eps * m.E);
            CHECK(std::fabs(s.zz - nu * (s.xx + s.yy)) <= 64 * eps * m.E);
            CHECK(std::fabs((1 + nu) * s.xy - m.E * e.xy) <= 64 * eps * m.E);
            CHECK(same({sample.dep.xx, sample.dep.yy, sample.dep.xy, sample.dep.zz}, {}));
            CHECK(sample.ep == 0);
            CHECK(largest(sample.step({-e.xx, -e.yy, -e.xy}).s) <= 8 * eps * largest(s));
        }
    }
}

TEST_CASE("the compliance undoes the stiffness and its energy is that of plane strain") {
    Random random;
    for (const double nu : {-0.5, 0.0, 0.25, 0.45}) {
        Material m;
        m.E = 7, m.nu = nu;
        const Compliance compliance(m);
        for (int n = 0; n < 100; ++n) {
            const StrainStep e = random.strain(1);
            const Stress a = Sample<Elastic>(m).step(e).s, b = random.stress();
            const double b_e = b.xx * e.xx + b.yy * e.yy + 2 * b.xy * e.xy;
            CHECK(std::fabs(compliance(a, b) - b_e) <= 64 * eps);
            CHECK(std::fabs(compliance(b, a) - b_e) <= 64 * eps);
            CHECK(compliance(b, b) > 0);
            const double in_plane =
                (1 + nu) / m.E *
                ((1 - nu) * (a.xx * a.xx + a.yy * a.yy) - 2 * nu * a.xx * a.yy + 2 * a.xy * a.xy);
            CHECK(std::fabs(compliance(a, a) - in_plane) <= 64 * eps * in_plane);
        }
    }
}

TEST_CASE("pressure and von Mises stress of simple states are what they are called after") {
    CHECK(pressure({-2, -2, 0, -2}) == 2);
    CHECK(von_mises({-2, -2, 0, -2}) == 0);
    CHECK(std::fabs(von_mises({0, -3, 0, 0}) - 3) <= 4 * eps);
    CHECK(std::fabs(von_mises({5, 5, 0, 8}) - 3) <= 4 * eps);
    CHECK(std::fabs(von_mises({5, 5, -3, 5}) - 3 * root_3) <= 8 * eps);
    Random random;
    for (int n = 0; n < 100; ++n) {
        const Stress s = random.stress();
        CHECK(std::fabs(std::sqrt(second_invariant(s)) - size(s)) <= 8 * eps);
    }
}

// ---- rotation -----------------------------------------------------------------------------------

TEST_CASE("turning stress is a rotation for every angle and keeps invariants and energy") {
    const Stress pulled = rotated({1, 0, 0, 5}, 1);  // by 45 degrees
    CHECK(largest(pulled - Stress{0.5, 0.5, 0.5, 5}) <= eps);
    Random random;
    const Compliance compliance{Material{}};
    for (int n = 0; n < 1000; ++n) {
        const Stress s = random.stress();
        const double w = 10 * random() * random.decade();
        const Stress r = rotated(s, w);
        CHECK(largest(r - turned(s, std::atan(w))) <= 8 * eps);
        CHECK(std::fabs(r.xx + r.yy - s.xx - s.yy) <= 4 * eps);
        CHECK(r.zz == s.zz);
        CHECK(std::fabs(radius(r) - radius(s)) <= 8 * eps);
        CHECK(std::fabs(size(r) - size(s)) <= 8 * eps);
        CHECK(std::fabs(compliance(r, r) - compliance(s, s)) <= 32 * eps * compliance(s, s));
        CHECK(largest(rotated(r, -w) - s) <= 16 * eps);
        CHECK(same(rotated(s, 0), s));
    }
}

TEST_CASE("a full turn in small steps falls short by a third of the cube of the angle of each") {
    for (const int steps : {50, 100, 1000}) {
        const double w = 2 * pi / steps;
        Stress s{1, -1, 0, 0};
        for (int n = 0; n < steps; ++n) s = rotated(s, w);
        const double short_by = -0.5 * std::atan2(s.xy, 0.5 * (s.xx - s.yy));
        CHECK(std::fabs(short_by / (steps * w * w * w / 3) - 1) <= 0.6 * w * w + 1e-9);
        CHECK(std::fabs(short_by / (steps * (w - std::atan(w))) - 1) <= 1e-9);
        CHECK(std::fabs(radius(s) - 1) <= eps * steps);
    }
}

TEST_CASE("a turned body answers turned strain with turned stress") {
    Random random;
    const auto check = [&](auto sample, double yield_strain) {
        for (int n = 0; n < 500; ++n) {
            auto other = sample;
            const double t = pi * random();
            const StrainStep de = random.strain(30 * yield_strain * random.decade());
            other.s = turned(sample.s, t);
            const double scale = largest(sample.s) + sample.law.elastic.T.K * yield_strain * 60;
            sample.step(de), other.step(turned(de, t));
            CHECK(largest(other.s - turned(sample.s, t)) <= 32 * eps * scale);
            CHECK(std::fabs(other.ep - sample.ep) <= 32 * eps * (sample.ep + yield_strain * 60));
        }
    };
    check(Sample<J2>(steel(10e9)), 0.002);
    for (const Material& m : soils()) check(Sample<DruckerPrager>(m), 0.001);
}

// ---- von Mises ----------------------------------------------------------------------------------

TEST_CASE("a bar in uniaxial strain yields and goes on yielding as the closed form says") {
    const Material perfect = steel(0);
    const double at_yield = 700e6, yields_at = 0.0026;  // Y (1 - nu) / (1 - 2 nu)
    CHECK(Sample<J2>(perfect).step({yields_at * (1 - 1e-9), 0, 0}).ep == 0);
    CHECK(Sample<J2>(perfect).step({yields_at * (1 + 1e-9), 0, 0}).ep > 0);
    const double sigma = Sample<J2>(perfect).step({yields_at, 0, 0}).s.xx;
    CHECK(std::fabs(sigma / at_yield - 1) <= 1e-14);
    const double beyond = Sample<J2>(perfect).step({0.01, 0, 0}).s.xx;
    CHECK(std::fabs(beyond / (5800e6 / 3) - 1) <= 1e-14);  // K e + 2/3 Y
    for (const double H : {0.0, 10e9}) {
        const Material m = steel(H);
        const Moduli T = moduli(m);
        for (const double e : {0.003, 0.01, -0.01}) {
            const Sample<J2> sample = Sample<J2>(m).step({0, e, 0});
            const double ep = (2 * T.G * std::fabs(e) - m.yield_stress) / (3 * T.G + H);
            const double q = std::copysign(m.yield_stress + H * ep, e);
            CHECK(std::fabs(sample.ep / ep - 1) <= 1e-13);
            CHECK(std::fabs(sample.s.yy / (T.K * e + q * 2 / 3) - 1) <= 1e-14);
            CHECK(std::fabs(sample.s.xx / (T.K * e - q / 3) - 1) <= 1e-13);
            CHECK(std::fabs(sample.s.zz / (T.K * e - q / 3) - 1) <= 1e-13);
        }
    }
}

TEST_CASE("simple shear yields at Y over root three and then follows the plastic tangent") {
    const Material m = steel(10e9);
    const double G = moduli(m).G, H = m.hardening;
    const double tau_yield = 230.9401076758503e6, gamma_yield = tau_yield / G;
    CHECK(std::fabs(gamma_yield - 0.0030022) <= 1e-7);
    CHECK(Sample<J2>(m).step({0, 0, 0.5 * gamma_yield * (1 - 1e-9)}).ep == 0);
    CHECK(Sample<J2>(m).step({0, 0, 0.5 * gamma_yield * (1 + 1e-9)}).ep > 0);
    const double tangent = G * H / (3 * G + H);
    CHECK(std::fabs(tangent - 3.1949e9) <= 1e5);
    for (const double gamma : {0.004, 0.02, -0.02}) {
        const Stress s = Sample<J2>(m).step({0, 0, 0.5 * gamma}).s;
        const double tau = tau_yield + tangent * (std::fabs(gamma) - gamma_yield);
        CHECK(std::fabs(s.xy / std::copysign(tau, gamma) - 1) <= 1e-13);
        CHECK(worst({std::fabs(s.xx), std::fabs(s.yy), std::fabs(s.zz)}) == 0);
    }
}

TEST_CASE("von Mises stress ends on the surface whatever the step and plastic work is no gain") {
    for (const double H : {0.0, 10e9}) {
        const Material m = steel(H);
        long yielded = 0, negative_before = 0;
        walk<J2>(m, 0.002,
                 [&](const Sample<J2>& before, const StrainStep& de, const Sample<J2>& at) {
                     const double scale = largest(before.s) + largest(stressed(m, {}, de, {}));
                     const double excess = root_3 * size(at.s) - (m.yield_stress + H * at.ep);
                     CHECK(excess <= 16 * eps * scale);
                     CHECK(largest(at.s - stressed(m, before.s, de, at.dep)) <= 16 * eps * scale);
                     if (at.ep == before.ep) {
                         CHECK(same({at.dep.xx, at.dep.yy, at.dep.xy, at.dep.zz}, {}));
                         return;
                     }
                     ++yielded;
                     negative_before += work(before.s, at.dep) < 0;
                     CHECK(excess >= -16 * eps * scale);
                     const double dep = equivalent(at.dep);
                     CHECK(std::fabs(at.ep - before.ep - dep) <= 8 * eps * at.ep);
                     CHECK(std::fabs(trace(at.dep)) <= 8 * eps * dep + 8 * eps * scale / m.E);
                     const double expected = (m.yield_stress + H * at.ep) * dep;
                     CHECK(std::fabs(work(at.s, at.dep) / expected - 1) <= 1e-9);
                     CHECK(work(before.s, at.dep) + work(at.s, at.dep) >= -1e-9 * expected);
                 });
        CHECK(yielded > 1000);
        CHECK(negative_before > 100);  // so the mean, or the end, has to be taken
    }
}

TEST_CASE("a yielded body unloads along the elastic line and yields again where it stopped") {
    const Material m = steel(10e9);
    Sample<J2> sample(m);
    sample.step({0.004, -0.001, 0.003});
    const Stress top = sample.s;
    const double ep = sample.ep;
    REQUIRE(ep > 0);
    const StrainStep back{-0.0005, 0.0002, -0.0004}, forth{0.0005, -0.0002, 0.0004};
    Sample<Elastic> elastic(m);
    elastic.s = top;
    CHECK(largest(sample.step(back).s - elastic.step(back).s) <= 4 * eps * largest(top));
    CHECK(sample.ep == ep);
    sample.step(forth);
    CHECK(largest(sample.s - top) <= 8 * eps * largest(top));
    CHECK(std::fabs(sample.ep - ep) <= 8 * eps);
    // The other way it yields at the strength it has gained, not earlier.
    Sample<J2> shear(m);
    shear.step({0, 0, 0.01});
    const double tau = shear.s.xy, G = moduli(m).G, gained = shear.ep;
    CHECK(shear.step({0, 0, -tau / G * (1 - 1e-9)}).ep == gained);
    CHECK(shear.step({0, 0, -tau / G * 1e-8}).ep > gained);
    CHECK(std::fabs(shear.s.xy / tau + 1) <= 1e-8);
}

TEST_CASE("growing in proportion one von Mises step does what a thousand do") {
    Random random;
    for (const double H : {0.0, 10e9}) {
        for (int n = 0; n < 20; ++n) {
            const StrainStep e = random.strain(0.02);
            const Sample<J2> one = Sample<J2>(steel(H)).step(e);
            Sample<J2> many(steel(H));
            many.steps(1000, {e.xx / 1000, e.yy / 1000, e.xy / 1000});
            CHECK(largest(one.s - many.s) <= 1e-12 * largest(one.s));
            CHECK(std::fabs(one.ep - many.ep) <= 1e-13);
        }
    }
}

// ---- Drucker-Prager -----------------------------------------------------------------------------

TEST_CASE("the cone matched in plane strain has its published constants") {
    const auto cone = [](double friction, double dilatancy) {
        return plane_strain_cone(soil(1, friction, dilatancy));
    };
    CHECK(std::fabs(cone(30, 30).alpha - 1 / std::sqrt(39)) <= eps);  // 0.16013
    CHECK(std::fabs(cone(30, 30).alpha_psi - 1 / std::sqrt(39)) <= eps);
    CHECK(std::fabs(cone(30, 30).k - 3 / std::sqrt(13)) <= 4 * eps);  // 0.83205
    CHECK(std::fabs(cone(30, 0).alpha - 1.0 / 6) <= eps);
    CHECK(std::fabs(cone(30, 0).k - root_3 / 2) <= 4 * eps);
    CHECK(cone(30, 0).alpha_psi == 0);
    CHECK(cone(0, 0).alpha == 0);
    CHECK(cone(0, 0).k == 1);
    for (const double phi : {1.0, 20.0, 45.0, 60.0}) {
        const double tangent = std::tan(phi * pi / 180),
                     root = std::sqrt(9 + 12 * tangent * tangent);
        CHECK(std::fabs(cone(phi, phi).alpha - tangent / root) <= 4 * eps);
        CHECK(std::fabs(cone(phi, phi).k - 3 / root) <= 4 * eps);
        for (const double psi : {0.0, 0.3 * phi, 0.9 * phi, phi}) {
            const Cone c = cone(phi, psi);
            CHECK(c.alpha_psi <= c.alpha + eps);
            CHECK(std::fabs(c.k / (3 * c.alpha) * tangent - 1) <= 8 * eps);  // the tip, c / tan
        }
    }
}

TEST_CASE("steady flow in plane strain has the strength and dilatancy of Mohr-Coulomb") {
    for (const auto& [phi, psi] : {std::pair{30.0, 0.0},
                                   {30.0, 30.0},
                                   {35.0, 10.0},
                                   {45.0, 20.0},
                                   {20.0, 5.0},
                                   {0.0, 0.0}}) {
        for (const double cohesion : {0.0, 5.0}) {
            if (cohesion == 0 && phi == 0) continue;
            const double sin_phi = std::sin(phi * pi / 180), cos_phi = std::cos(phi * pi / 180),
                         sin_psi = std::sin(psi * pi / 180);
            Sample<DruckerPrager> sample(soil(cohesion, phi, psi));
            sample.s = {-90, -110, 3, -70};
            // Strain at the rate of dilatancy, so that in the end all of it is plastic.
            const StrainStep de =
                turned(StrainStep{0.5e-3 * (sin_psi + 1), 0.5e-3 * (sin_psi - 1), 0}, 0.7);
            sample.steps(4000, de);
            const double P = 0.5 * (sample.s.xx + sample.s.yy);
            CHECK(P < -10);
            CHECK(std::fabs(radius(sample.s) / (cohesion * cos_phi - P * sin_phi) - 1) <= 1e-12);
            CHECK(std::fabs(sample.dep.zz) <= 1e-12 * 1e-3);
            CHECK(std::fabs(trace(sample.dep) - sin_psi * 1e-3) <= 1e-12 * 1e-3);
            CHECK(std::fabs(sample.dep.xy - de.xy) <= 1e-12 * 1e-3);
            // Not only in the end: by volume per equivalent strain on the way.
            sample.s = {-90, -90, 0, -90}, sample.ep = 0;
            double volume = 0;
            for (int n = 0; n < 20; ++n) volume += trace(sample.step({4e-3, -4e-3, 3e-3}).dep);
            REQUIRE(sample.ep > 0.01);
            const double alpha_psi = sin_psi / std::sqrt(9 + 3 * sin_psi * sin_psi);
            CHECK(std::fabs(volume - 3 * root_3 * alpha_psi * sample.ep) <= 1e-14);
        }
    }
}

TEST_CASE("under pressure the shear strength is cohesion and friction") {
    const auto strength = [](const Material& m, double pressure_0) {
        Sample<DruckerPrager> sample(m);
        sample.s = {-pressure_0, -pressure_0, 0, -pressure_0};
        sample.step({0, 0, 1});
        CHECK(std::fabs(pressure(sample.s) - pressure_0) <= 1e-10);  // psi = 0 keeps it
        CHECK(std::fabs(trace(sample.dep)) <= 1e-14);
        return sample.s.xy;
    };
    CHECK(std::fabs(strength(soil(0, 30, 0, 0), 100) - 50) <= 1e-10);
    CHECK(std::fabs(strength(soil(20, 30, 0), 100) - (50 + 10 * root_3)) <= 1e-10);
    CHECK(std::fabs(strength(soil(20, 0, 0), 100) - 20) <= 1e-10);
    // Half of it in a smaller step is elastic.
    Sample<DruckerPrager> half(soil(0, 30, 0, 0));
    half.s = {-100, -100, 0, -100};
    half.step({0, 0, 25 / (2 * half.law.elastic.T.G)});
    CHECK(half.ep == 0);
    CHECK(std::fabs(half.s.xy - 25) <= 1e-12);
}

TEST_CASE("in triaxial compression a cone is as strong as its constants say") {
    // Equal strains in the plane, and none along z, leave z the direction of the largest pressure.
    const auto check = [](double cohesion, double phi, double sine, double c) {
        Sample<DruckerPrager> sample(soil(cohesion, phi, 0));
        sample.s = {-100, -100, 0, -100};
        sample.steps(12, {5e-4, 5e-4, 0});
        REQUIRE(sample.ep > 0);
        const double side = -sample.s.xx, difference = -sample.s.zz - side;
        REQUIRE(side > 0);
        const double mohr_coulomb =
            (2 * c * std::sqrt(1 - sine * sine) + 2 * side * sine) / (1 - sine);
        CHECK(std::fabs(difference / mohr_coulomb - 1) <= 1e-12);
    };
    // alpha = 2 sin(30) / (3^1/2 (3 - sin(30))) = 0.23094 and k = 1.2 c are Mohr-Coulomb's there.
    const double sine = 3 * 0.4 / root_3, phi = std::asin(sine);
    const Cone cone = plane_strain_cone(soil(1.2 / std::cos(phi), phi * 180 / pi, 0));
    CHECK(std::fabs(cone.alpha - 0.23094) <= 1e-6);
    CHECK(std::fabs(cone.k - 1.2) <= 8 * eps);
    check(1.2 / std::cos(phi), phi * 180 / pi, 0.5, 1);
    check(0, phi * 180 / pi, 0.5, 0);
    // The one matched in plane strain is weaker: 22 degrees for 30.
    const double weaker = 3 * root_3 / (12 + root_3);
    CHECK(std::fabs(std::asin(weaker) * 180 / pi - 22.2) <= 0.05);
    check(0, 30, weaker, 0);
}

TEST_CASE("pulled apart a soil keeps its largest mean stress and what shear the cone bears there") {
    const double tip = 10 * root_3;  // c / tan(phi)
    Random random;
    for (const double psi : {0.0, 15.0, 30.0}) {
        for (const double tension : {0.0, 4.0, 17.0, unlimited}) {
            const Material m = soil(10, 30, psi, tension);
            const double apex = std::min(tension, tip);
            Sample<DruckerPrager> sample(m);
            CHECK(std::fabs(sample.law.apex - apex) <= 1e-13);
            sample.step({0.1, 0.1, 0});  // and zz lags behind
            CHECK(std::fabs(mean(sample.s) - apex) <= 1e-11);
            const double bears = sample.law.cone.k - 3 * sample.law.cone.alpha * apex;
            CHECK(std::fabs(size(sample.s) - bears) <= 1e-11);
            // A little shear below the cut stays as it is; only volume flows.
            if (tension != 4.0) continue;
            Sample<DruckerPrager> small(m);
            small.s = {3, 3, 0.5 * bears, 3};
            small.step({4e-4, 4e-4, 0});
            const double lag = size(small.s);
            CHECK(std::fabs(mean(small.s) - 4) <= 1e-12);
            CHECK(lag < bears);
            CHECK(std::fabs(small.s.xy - 0.5 * bears) <= 1e-12);
            CHECK(small.ep == 0);
            CHECK(std::fabs(small.dep.xx - small.dep.zz) <= 1e-16);
            CHECK(small.dep.xx > 0);
        }
        // Sand comes apart without stress, and bears again at once.
        Sample<DruckerPrager> sand(soil(0, 30, psi, 0));
        CHECK(largest(sand.step({0.1, 0.02, 0.05}).s) <= 1e-11);
        CHECK(sand.step({-0.001, -0.001, 0}).s.xx < -1);
    }
}

TEST_CASE("a soil ends on cone or cut whatever the step and plastic work is no gain") {
    for (const Material& m : soils()) {
        long on_cone = 0, at_cut = 0, negative_before = 0;
        walk<DruckerPrager>(
            m, 0.001, [&](const auto& before, const StrainStep& de, const auto& at) {
                const double scale = largest(before.s) + largest(stressed(m, {}, de, {}));
                const Cone& cone = at.law.cone;
                const double excess = size(at.s) + 3 * cone.alpha * mean(at.s) - cone.k;
                CHECK(excess <= 16 * eps * scale);
                CHECK(mean(at.s) - at.law.apex <= 16 * eps * scale);
                CHECK(largest(at.s - stressed(m, before.s, de, at.dep)) <= 16 * eps * scale);
                CHECK(work(at.s, at.dep) >= -64 * eps * scale * (equivalent(at.dep) + scale / m.E));
                CHECK(std::fabs(at.ep - before.ep - equivalent(at.dep)) <=
                      8 * eps * (at.ep + scale / m.E));
                negative_before += work(before.s, at.dep) < -1e-9;
                const bool opens = mean(at.s) - at.law.apex >= -16 * eps * scale;
                at_cut += opens;
                if (at.ep > before.ep && !opens) {
                    ++on_cone;
                    CHECK(excess >= -16 * eps * scale);
                    // On the cone it flows along its own deviator, with the volume of alpha_psi.
                    const double along = work(at.s, at.dep) - mean(at.s) * trace(at.dep),
                                 dl = root_3 * equivalent(at.dep);
                    CHECK(std::fabs(along - size(at.s) * dl) <=
                          64 * eps * scale * (dl + scale / m.E));
                    CHECK(std::fabs(trace(at.dep) - 3 * cone.alpha_psi * dl) <=
                          16 * eps * (dl + scale / m.E));
                }
            });
        CHECK(on_cone > 100);
        CHECK((at_cut > 100 || m.friction_angle == 0));
        CHECK((negative_before > 10 || m.cohesion == 0));  // so the end of the step has to be taken
    }
}

TEST_CASE("associated flow dissipates more than any other stress that the body bears would") {
    // Equivalent: a step ends at the nearest such stress, measured by elastic energy.
    const auto check = [](const auto& law, double yield_strain) {
        Random random;
        for (int n = 0; n < 1000; ++n) {
            Stress one{}, other{};
            PlasticStep dep{}, unused{};
            double ep = 0;
            const StrainStep de = random.strain(30 * yield_strain * random.decade());
            const StrainStep to = random.strain(30 * yield_strain * random.decade());
            law(to, other, unused, ep);
            law(de, one, dep, ep);
            const double scale = 60 * yield_strain * (law.elastic.T.K + law.elastic.T.G);
            CHECK(work(one - other, dep) >= -64 * eps * scale * 60 * yield_strain);
        }
    };
    check(J2(steel(0)), 0.002);
    for (const double tension : {0.0, 4.0, 8.0, unlimited}) {
        check(DruckerPrager(soil(10, 30, 30, tension)), 0.001);
        check(DruckerPrager(soil(10, 0, 0, tension)), 0.001);
    }
    check(DruckerPrager(soil(0, 30, 30, 0)), 0.001);
}

TEST_CASE(
    "without friction and a cut a soil is a von Mises metal of root three times its cohesion") {
    Material metal = soil(7, 0, 0);
    metal.yield_stress = 7 * root_3, metal.hardening = 0;
    Random random;
    Sample<J2> j2(metal);
    Sample<DruckerPrager> cylinder(metal);
    for (int n = 0; n < 1000; ++n) {
        const StrainStep de = random.strain(0.03 * random.decade());
        j2.step(de), cylinder.step(de);
        CHECK(largest(j2.s - cylinder.s) <= 1e-13 * (1000 + largest(j2.s)));
        CHECK(std::fabs(j2.ep - cylinder.ep) <= 1e-13 * (1 + j2.ep));
    }
    CHECK(j2.ep > 1);
}

TEST_CASE("growing in proportion one step along the cone does what a thousand do") {
    Random random;
    long yielded = 0;
    for (const Material& m : {soil(10, 30, 0), soil(10, 30, 12), soil(10, 30, 30)}) {
        for (int n = 0; n < 50; ++n) {
            const StrainStep e = random.strain(0.01);
            const Sample<DruckerPrager> one = Sample<DruckerPrager>(m).step(e);
            Sample<DruckerPrager> many(m);
            many.steps(1000, {e.xx / 1000, e.yy / 1000, e.xy / 1000});
            CHECK(largest(one.s - many.s) <= 1e-12 * (largest(one.s) + 100));
            CHECK(std::fabs(one.ep - many.ep) <= 1e-13);
            yielded += one.ep > 0;
        }
    }
    CHECK(yielded > 100);
}

TEST_CASE("what a law bears leaves no plastic strain and no other stress than elasticity") {
    Random random;
    const auto check = [&](auto sample, const Material& m, double small) {
        const Stress start = sample.s;
        const double scale = largest(start) + 4 * m.E * small;
        for (int n = 0; n < 100; ++n) {
            const StrainStep de = random.strain(small);
            sample.s = start;
            Sample<Elastic> elastic(m);
            elastic.s = start;
            CHECK(largest(sample.step(de).s - elastic.step(de).s) <= 2 * eps * scale);
            CHECK(sample.ep == 0);
            CHECK(same({sample.dep.xx, sample.dep.yy, sample.dep.xy, sample.dep.zz}, {}));
        }
    };
    check(Sample<J2>(steel(10e9)), steel(10e9), 5e-4);
    for (const Material& m : soils()) {
        Sample<DruckerPrager> pressed(m);
        pressed.s = {-20, -20, 0, -20};
        check(pressed, m, 1e-4);
    }
}

TEST_CASE("nothing happens at rest and a soil without strength bears pressure only") {
    const Material fluid = soil(0, 0, 0, 0);
    std::vector<Material> all = soils();
    all.push_back(fluid);
    for (const Material& m : all) {
        for (const double p : {0.0, 20.0}) {
            Sample<DruckerPrager> sample(m);
            sample.s = {-p, -p, 0, -p};
            CHECK(same(sample.step({0, 0, 0}).s, {-p, -p, 0, -p}));
            CHECK(sample.ep == 0);
        }
    }
    CHECK(same(Sample<J2>(steel(0)).step({0, 0, 0}).s, {}));
    Sample<DruckerPrager> sample(fluid);
    const double K = moduli(fluid).K;
    CHECK(largest(sample.step({-0.02, 0.01, 0.03}).s - Stress{-K / 100, -K / 100, 0, -K / 100}) <=
          1e-12);
    CHECK(largest(sample.step({0.02, 0.03, -0.01}).s) <= 1e-12);
}

TEST_CASE("a strain that is not a number gives a stress that is not one") {
    const facts::Untrapped calm;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto shows = [&](auto sample) {
        sample.step({nan, 0, 0});
        return std::isnan(sample.s.xx) && std::isnan(sample.s.yy) && std::isnan(sample.s.zz);
    };
    CHECK(shows(Sample<Elastic>(steel(0))));
    CHECK(shows(Sample<J2>(steel(0))));
    for (const Material& m : soils()) CHECK(shows(Sample<DruckerPrager>(m)));
}
