// Facts about the dielectric tensor of a warm magnetized plasma: what it is along the field,
// without temperatures, without a field, and for slow longitudinal waves, where other formulas are
// known.
#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "cic/theory/magnetized_dispersion.hpp"
#include "common/theory/kinetic_dispersion.hpp"
#include "implicit_moment/setup/check_case.hpp"
#include "implicit_moment/theory/cold_plasma.hpp"
#include "implicit_moment/theory/magnetized_plasma.hpp"
#include "implicit_moment/theory/transverse_dispersion.hpp"
#include "tests/support/any_program.hpp"
#include "tests/support/any_summary.hpp"

namespace {

using namespace facts;
using namespace implicit_moment;
using Complex = std::complex<double>;
using Json = nlohmann::json;

const std::vector<Complex> frequencies{{0.31, 0.02}, {1.7, -0.3}, {-0.6, 0.4}, {0.05, -0.01}};

// Drifting bi-Maxwellians, one of them cold along B.
std::vector<MagnetizedSpecies> plasma() {
    return {
        {1.0, -0.7, 0.05, 0.1, 0.23}, {0.3, 0.21, -0.11, 0.17, 0.06}, {0.2, -0.4, 0.02, 0, 0.1}};
}

std::vector<common::PlasmaSpecies> as_seen_along(const std::vector<MagnetizedSpecies>& plasma) {
    std::vector<common::PlasmaSpecies> all;
    for (const MagnetizedSpecies& s : plasma) {
        common::PlasmaSpecies one;
        one.density = s.omega2 / (4 * pi), one.charge = 1, one.mass = 1;
        one.drift = s.drift, one.gyrofrequency = s.Omega;
        one.temperature_along = s.v_along * s.v_along;
        one.temperature_across = s.v_across * s.v_across;
        all.push_back(one);
    }
    return all;
}

double apart(Complex a, Complex b) { return std::abs(a - b) / (std::abs(a) + std::abs(b)); }

}  // namespace

TEST_CASE("along the field the determinant is the product of three known relations") {
    const double k = 0.8;
    const auto species = as_seen_along(plasma());
    for (const Complex omega : frequencies) {
        CAPTURE(omega);
        const Complex product = omega * omega * common::longitudinal_dispersion(species, k, omega) *
                                transverse_dispersion(species, k, c, +1, omega) *
                                transverse_dispersion(species, k, c, -1, omega);
        CHECK(apart(magnetized_dispersion(plasma(), {k, 0}, c, omega), product) <= 1e-12);
        CHECK(apart(magnetized_dispersion(plasma(), {k, 1e-6}, c, omega), product) <= 1e-9);
    }
}

TEST_CASE("without temperatures the roots of the determinant are the waves of a cold plasma") {
    Case w;
    w.setup = "uniform", w.boundary_z = "periodic";
    w.grid = {{2048, -2, 4, true}, {2048, -2.5, 5, true}};
    w.dt = 1e-5;
    w.field.smoothing.passes = 0;
    w.uniform.B_x = 0.4, w.uniform.B_y = -0.3, w.uniform.B_z = 0.2;
    w.uniform.mode_x = 1, w.uniform.mode_z = -1;
    SpeciesCase ions, electrons;
    electrons.charge = -1, electrons.mass = 0.2;
    w.uniform.species = {ions, electrons};
    const auto waves = cold_waves(w);
    CHECK(waves.size() == 5);
    for (const ColdWave& one : waves) {
        const Complex wave = one.omega;
        CAPTURE(wave);
        const auto D = [&](Complex omega) {
            return magnetized_dispersion(magnetized_species(w), magnetized_wave(w, wave_vector(w)),
                                         c, omega);
        };
        const auto root = common::root_near(D, wave * 1.003);
        REQUIRE(root.found);
        CHECK(std::abs(root.omega - wave) <= 2e-6 * std::abs(wave));
    }
    // A little warmth moves them a little.
    for (SpeciesCase& s : w.uniform.species)
        s.temperature_x = s.temperature_y = s.temperature_z = 1e-8 * s.mass;
    const auto warm = [&](Complex omega) {
        return magnetized_dispersion(magnetized_species(w), magnetized_wave(w, wave_vector(w)), c,
                                     omega);
    };
    const Complex third = waves[2].omega;
    CHECK(std::abs(common::root_near(warm, third).omega - third) <= 1e-5 * std::abs(third));
}

TEST_CASE("on a coarse mesh the roots of the determinant are the waves of the cold step") {
    for (const bool leapfrog : {false, true})
        for (const long passes : {0, 3}) {
            // 6.3 and 10 cells in a wave, which smoothing and splines change by a tenth.
            Case w;
            w.setup = "uniform", w.boundary_z = "periodic";
            w.grid = {{20, -2, 4, true}, {19, -2.5, 5, true}};
            w.dt = 1e-5;
            w.field.response = "mass_matrix", w.field.smoothing.passes = passes;
            w.leapfrog.chosen = leapfrog, w.leapfrog.order = 1;
            w.uniform.B_x = 0.4, w.uniform.B_y = -0.3, w.uniform.B_z = 0.2;
            w.uniform.mode_x = 2, w.uniform.mode_z = -3;
            SpeciesCase ions, electrons;
            electrons.charge = -1, electrons.mass = 0.2;
            w.uniform.species = {ions, electrons};
            const auto waves = cold_waves(w);
            CHECK(waves.size() >= 5);
            double without = 0;
            for (const ColdWave& one : waves) {
                const Complex wave = one.omega;
                CAPTURE(wave);
                CAPTURE(leapfrog);
                const auto root = common::root_near(
                    [&](Complex omega) { return magnetized_dispersion_on_mesh(w, omega); },
                    wave * 1.003);
                const auto D = [&](Complex omega) {
                    return magnetized_dispersion(magnetized_species(w),
                                                 magnetized_wave(w, wave_vector(w)), c, omega);
                };
                REQUIRE(root.found);
                // What the sum over images leaves out of linear splines, and of quadratic ones.
                CHECK(std::abs(root.omega - wave) <= (leapfrog ? 2e-3 : 2e-5) * std::abs(wave));
                without = std::max(without, apart(common::root_near(D, wave).omega, wave));
            }
            CHECK(without >= 0.01);
        }
}

TEST_CASE("along the field the determinant on the mesh is the product of its three relations") {
    // Smoothed E and B as it is, drifts, two temperatures; the field runs along the wave or against
    // it.
    for (const double B : {0.3, -0.3})
        for (const bool leapfrog : {false, true}) {
            Case w;
            w.setup = "uniform", w.boundary_z = "periodic", w.leapfrog.chosen = leapfrog;
            w.leapfrog.relativistic = false;
            w.grid = {{11, -2, 4, true}, {4, -2.5, 5, true}};
            w.uniform.B_x = B, w.uniform.mode_x = 1;
            SpeciesCase ions, electrons;
            electrons.charge = -1, electrons.mass = 0.2, electrons.drift_x = 0.07;
            electrons.temperature_x = 2e-3,
            electrons.temperature_y = electrons.temperature_z = 5e-3;
            ions.drift_x = -0.02, ions.temperature_y = ions.temperature_z = 1e-3;
            w.uniform.species = {ions, electrons};
            for (const Complex omega : frequencies) {
                CAPTURE(omega);
                const Complex product = omega * omega * longitudinal_dispersion_on_mesh(w, omega) *
                                        transverse_dispersion_on_mesh(w, +1, omega) *
                                        transverse_dispersion_on_mesh(w, -1, omega);
                CHECK(apart(magnetized_dispersion_on_mesh(w, omega), product) <= 1e-11);
            }
        }
}

TEST_CASE("of a smoothed E particles answer the part that is left where its B does not matter") {
    const double S = 0.83;
    const std::vector<MagnetizedSpecies> at_rest{{1.0, -0.7, 0, 0.2, 0.2},
                                                 {0.3, 0.21, 0, 0.1, 0.1}};
    for (const MagnetizedWave k : {MagnetizedWave{1.3, 0.9}, {-0.4, 1.1}, {0.8, 0}, {0, 2}})
        for (const Complex omega : frequencies) {
            CAPTURE(omega);
            const auto off = [&](const auto& plasma, const auto& E) {
                const Eigen::MatrixXcd whole = magnetized_response(plasma, k, omega) * E,
                                       part = magnetized_response(plasma, k, omega, S) * E;
                return (part - S * whole).norm() / whole.norm();
            };
            // No force of B on what is isotropic and at rest; no B of an E along k.
            CHECK(off(at_rest, Eigen::Matrix3cd::Identity().eval()) <= 1e-12);
            CHECK(off(plasma(), Eigen::Vector3cd(k.across, 0, k.along)) <= 1e-12);
            CHECK(off(plasma(), Eigen::Vector3cd(k.along, 0.3, -k.across)) >= 1e-4);
        }
}

TEST_CASE("in a field that vanishes the tensor is that of a plasma without one") {
    // All particles gyrate so slowly that many harmonics add up to the straight orbits.
    std::vector<MagnetizedSpecies> isotropic{{1.0, -0.004, 0, 0.1, 0.1},
                                             {0.3, 0.002, 0, 0.04, 0.04}};
    auto free = as_seen_along(isotropic);
    for (auto& one : free) one.gyrofrequency = 0;
    const double k = 0.7;
    for (const double angle : {0.4, 1.2}) {
        for (const Complex omega : {Complex(0.9, 0.3), Complex(0.2, 0.5)}) {
            CAPTURE(angle);
            CAPTURE(omega);
            const Complex transverse = transverse_dispersion(free, k, c, 1, omega),
                          product = omega * omega * transverse * transverse *
                                    common::longitudinal_dispersion(free, k, omega);
            const MagnetizedWave wave{k * std::cos(angle), k * std::sin(angle)};
            CHECK(apart(magnetized_dispersion(isotropic, wave, c, omega), product) <= 1e-3);
        }
    }
    // The relative drift of two beams without temperature across it, seen from the side.
    std::vector<MagnetizedSpecies> beams{{0.5, 1e-4, 0.3, 0, 0}, {0.5, 1e-4, -0.3, 0, 0}};
    // Of two cold streams at k across them, D_xx D_zz = 0 with chi_zz = -(omega_p/omega)^2
    // (1 + k^2 u^2/omega^2): filaments grow.
    const Complex omega(0.1, 0.3);
    const double across = 0.8;
    const Complex w2 = omega * omega;
    const Complex expected = (w2 - 1.0) * (w2 - 1.0 - across * across * c * c) *
                             (w2 - 1.0 - across * across * (c * c + 0.09 / w2));
    CHECK(apart(magnetized_dispersion(beams, {0, across}, c, omega), expected) <= 1e-5);
}

TEST_CASE("waves much slower than light are those of Harris and Bernstein") {
    // D / (c^4 k^4) is omega^2 k (1 + chi) k / k^2 for c without end.
    const auto magnetized = plasma();
    const double light = 3e3;  // larger ones lose digits in the determinant
    for (const MagnetizedWave k : {MagnetizedWave{0, 3.1}, {0.9, 2.2}, {2.5, 0.4}}) {
        for (const Complex omega : frequencies) {
            CAPTURE(k.along);
            CAPTURE(omega);
            const double size = std::hypot(k.along, k.across);
            Complex D = 1;
            for (const MagnetizedSpecies& s : magnetized)
                D += cic::magnetized_response(
                         {s.omega2, s.Omega, size, k.along, s.drift, s.v_along,
                          cic::maxwellian_harmonics(k.across, s.v_across, s.Omega)},
                         omega)
                         .chi;
            const Complex seen = magnetized_dispersion(magnetized, k, light, omega) /
                                 std::pow(light * size, 4) / (omega * omega);
            CHECK(apart(seen, D) <= 1e-5);
        }
    }
}

TEST_CASE("energy flows into the plasma where all its species are Maxwellians at rest") {
    // The part of omega^2 chi that is not Hermitian is -i times a positive one at real omega > 0.
    const std::vector<MagnetizedSpecies> at_rest{{1.0, -0.7, 0, 0.2, 0.2},
                                                 {0.3, 0.21, 0, 0.1, 0.1}};
    for (const double omega : {0.2, 0.65, 1.1}) {
        CAPTURE(omega);
        const Eigen::Matrix3cd tensor = magnetized_response(at_rest, {1.3, 0.9}, omega),
                               lossy = (tensor - tensor.adjoint()) / Complex(0, 2);
        CHECK(eigensystem(lossy).values.real().minCoeff() >= -1e-12);
        CHECK(lossy.trace().real() >= 1e-3);
    }
}

TEST_CASE("a warm whistler has the frequency of the tensor and not that of cold plasma" *
          doctest::description("physics")) {
    // At 60 degrees to B, k v_e / Omega_e = 0.2; the cold wave has 1.674 omega_pi.
    std::string keys =
        "implicit_moment/cases/oblique_whistler.toml theory.wave=magnetized theory.near=1.8 "
        "theory.component=B_y grid.cells_x=32 grid.length_x=0.62831853 grid.length_z=0.0785 "
        "time.dt=0.05 time.end=40 uniform.particles_per_cell=256 uniform.B_x=0.1 "
        "uniform.B_z=0.1732051 uniform.wave_B_y=2e-3 uniform.wave_B_z=2e-3 uniform.phase_B_y=0 "
        "uniform.phase_B_z=90 uniform.wave_E_y=0 uniform.wave_E_z=0";
    for (const char* species : {" species.ions.", " species.electrons."})
        for (const char* axis : {"x", "y", "z"})
            keys += species + std::string("temperature_") + axis + "=4e-4" + species +
                    std::string("wave_") + axis + "=0";
    const Run run = run_into("warm_whistler", "implicit_moment", keys);
    CHECK(std::fabs(run.value("theory_omega_without_mesh") - 1.8357) <= 1e-3);
    CHECK(run.summary["results"]["omega_over_theory"]["verdict"] == "PASS");
    const Json& damping = run.summary["results"]["damping_over_theory"];
    REQUIRE(damping.contains("error"));
    CHECK(std::fabs(damping["value"].get<double>() - 1) <= damping["error"].get<double>());
}
