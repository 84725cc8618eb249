// Facts about the waves that cic compares itself with beyond unmagnetized Maxwellians: warm species
// in a magnetic field, distributions by formula; and about loading what a case says by formula.
#include <doctest/doctest.h>
#include <gsl/gsl_sf_bessel.h>

#include <chrono>

#include "cic/setup/check_case.hpp"
#include "cic/setup/describe_case.hpp"
#include "tests/support/any_summary.hpp"
#include "tests/support/folder_of_test.hpp"
#include "tests/support/longitudinal_wave.hpp"

namespace {

using namespace cic;
using common::Complex;

// A case from the text of a file, ready to be loaded.
Case read(const std::string& text) {
    Case parameters;
    common::ParameterTable table = describe(parameters);
    for (const common::Setting& s : common::read_case(text, "case.toml")) table.set(s);
    validate(parameters);
    return parameters;
}

std::string refusal(const std::string& text) {
    try {
        const Case parameters = read(text);
        if (parameters.compare == "wave") theory_of_wave(parameters);
    } catch (const common::InputError& error) {
        return error.what();
    }
    return "nothing";
}

// Electrons of a box of length 2 pi before fixed ions, with more lines for the electrons.
std::string electrons(const std::string& lines, const std::string& rest = "") {
    return "[grid]\nlength_x = 6.283185307179586\n[species.ions]\ncharge = 1\nmotion = "
           "\"fixed\"\n" +
           rest + "\n[species.electrons]\n" + lines + "\n";
}
const std::string wave = "[theory]\ncompare = \"wave\"\n";

MagnetizedSpecies species(double k, double k_along, double v_along, double v_across, double Omega) {
    const double k_across = std::sqrt(std::max(0.0, k * k - k_along * k_along));
    return {1, Omega, k, k_along, 0.0, v_along, maxwellian_harmonics(k_across, v_across, Omega)};
}

Distribution maxwellian_speeds() {
    return tabulate(0, 8, 4096, true, [](double v) { return std::exp(-0.5 * v * v); });
}

const std::vector<Complex> some_frequencies{{0.9, 0.2}, {-0.3, 0.5}, {1.7, 0.01}, {0.2, 2.0}};

}  // namespace

TEST_CASE("harmonics of a Maxwellian are scaled Bessel functions with the sums of an orbit") {
    for (const double b : {1e-12, 0.01, 1.0, 30.0, 9000.0}) {
        const Harmonics h = maxwellian_harmonics(std::sqrt(b) / 2, 2, 1);
        double all = h.weight[0], squares = 0, gains = 0;
        for (std::size_t n = 1; n < h.weight.size(); ++n) {
            all += 2 * h.weight[n], squares += 2 * double(n * n) * h.weight[n];
            gains += 2 * double(n) * h.gain[n];
        }
        CHECK(std::fabs(all - 1) <= 1e-13);
        CHECK(std::fabs(squares / b - 1) <= 1e-12);
        CHECK(std::fabs(gains / (b / 4) - 1) <= 1e-12);  // k_across^2, for any temperature
        for (const int n : {0, 1, 2, 7})
            if (b > 1e-3) {
                const double exact = gsl_sf_bessel_In_scaled(n, b);
                CHECK(std::fabs(h.weight[std::size_t(n)] / exact - 1) <= 1e-11);
            }
    }
}

TEST_CASE("Bessel functions downward are those of the library") {
    for (const double x : {0.0, 1e-9, 1e-3, 0.7, 9.0, 80.0}) {
        const std::vector<double> J = bessel_functions(x, 130);
        for (const int n : {0, 1, 2, 11, 60})
            CHECK(std::fabs(J[std::size_t(n)] - std::cyl_bessel_j(double(n), x)) <= 1e-13);
    }
}

TEST_CASE("a table of Maxwellian speeds has the harmonics of the Maxwellian") {
    const Harmonics table = tabulated_harmonics(1.5, maxwellian_speeds(), -0.7),
                    exact = maxwellian_harmonics(1.5, 1, -0.7);
    for (std::size_t n = 0; n < 8; ++n) {
        CHECK(std::fabs(table.weight[n] - exact.weight[n]) <= 2e-6);
        CHECK(std::fabs(table.gain[n] - exact.gain[n]) <= 2e-6);
    }
}

TEST_CASE("along the field a wave does not feel it") {
    const common::PlasmaSpecies plain{
        .density = 0.25 / pi, .charge = -1, .mass = 1, .temperature_along = 0.49};
    for (const Complex omega : some_frequencies) {
        const Response r = magnetized_response(species(0.8, 0.8, 0.7, 1.3, -0.4), omega);
        CHECK(std::abs(1.0 + r.chi - common::longitudinal_dispersion({&plain, 1}, 0.8, omega)) <=
              1e-13);
    }
}

TEST_CASE("a weak field is none") {
    const common::PlasmaSpecies plain{
        .density = 0.25 / pi, .charge = -1, .mass = 1, .temperature_along = 1};
    // Growing waves forget before an orbit is over.
    for (const double k_along : {0.0, 0.4, 0.7}) {
        const Complex omega(0.9, 0.4);
        const Response r = magnetized_response(species(0.8, k_along, 1, 1, 0.01), omega);
        CHECK(std::abs(1.0 + r.chi - common::longitudinal_dispersion({&plain, 1}, 0.8, omega)) <=
              1e-4);
    }
}

TEST_CASE("a cold species across and along has the cold magnetized response") {
    for (const double k_along : {0.0, 0.3, 0.8})
        for (const Complex omega : some_frequencies) {
            const double Omega = 0.6, cos2 = std::pow(k_along / 0.8, 2);
            const Complex cold =
                -(cos2 / (omega * omega) + (1 - cos2) / (omega * omega - Omega * Omega));
            for (const double v : {0.0, 1e-6}) {
                const Response r = magnetized_response(species(0.8, k_along, v, v, Omega), omega);
                CHECK(std::abs(r.chi - cold) <= 1e-9 * std::abs(cold));
            }
        }
}

TEST_CASE("Bernstein modes lie between the harmonics and begin at the upper hybrid frequency") {
    for (const double k : {1e-4, 0.3, 1.0, 3.0}) {
        const std::vector<MagnetizedSpecies> plasma{species(k, 0, 1, 1, -0.4)};
        const std::vector<double> roots = bernstein_roots(plasma);
        REQUIRE(!roots.empty());
        for (std::size_t n = 0; n + 1 < roots.size(); ++n) {
            CHECK(roots[n] > 0.4 * double(n + 1));
            CHECK(roots[n] < 0.4 * double(n + 2));
        }
        const Complex D = 1.0 + magnetized_response(plasma[0], roots[0]).chi;
        CHECK(std::abs(D) <= 1e-6);
        if (k < 1e-3) {
            const double upper_hybrid = std::sqrt(1 + 0.4 * 0.4);
            CHECK(std::fabs(roots.back() - upper_hybrid) <= 1e-6);
        }
    }
    // Above many orbits per wavelength all modes are the harmonics.
    const std::vector<double> roots = bernstein_roots({species(30, 0, 1, 1, -0.4)});
    for (std::size_t n = 0; n < 5; ++n) CHECK(roots[n] < 0.4 * (double(n) + 1.01));
}

TEST_CASE("ions and electrons share a lower and an upper hybrid mode") {
    MagnetizedSpecies ions = species(0.01, 0, 0, 0, 0.5 / 100),
                      light = species(0.01, 0, 0, 0, -0.5);
    ions.omega2 = 1.0 / 100;
    const std::vector<double> roots = bernstein_roots({ions, light});
    REQUIRE(roots.size() == 2);
    // omega^2 + product of the squares of both, exactly.
    const double We2 = 0.25, Wi2 = 0.25e-4, sum = 1.01 + We2 + Wi2,
                 product = We2 * Wi2 + 1.0 * Wi2 + 0.01 * We2,
                 root = std::sqrt(0.25 * sum * sum - product);
    CHECK(std::fabs(roots[0] - std::sqrt(product / (0.5 * sum + root))) <= 1e-12);
    CHECK(std::fabs(roots[1] - std::sqrt(0.5 * sum + root)) <= 1e-12);
}

TEST_CASE("a ring of gyrating electrons becomes unstable where it is known to") {
    // Tataronis and Crawford, J. Plasma Phys. 4, 231 (1970): omega_p^2 = 6.62 Omega^2, of all k.
    const auto fastest = [](double ratio) {
        const double Omega = 1 / std::sqrt(ratio);
        const Distribution ring = tabulate(
            0.97, 1.03, 200, true, [](double v) { return std::exp(-2e4 * (v - 1) * (v - 1)); });
        double best = 0;
        int found = 0;
        for (const double orbits : {5.3, 5.5, 5.65, 5.8}) {
            MagnetizedSpecies s = species(orbits * Omega, 0, 0, 0, -Omega);
            s.harmonics = tabulated_harmonics(s.k, ring, -Omega);
            const auto D = [&](Complex omega) { return 1.0 + magnetized_response(s, omega).chi; };
            for (const double x : {2.2, 2.4, 2.6}) {
                const common::DispersionRoot root = common::root_near(D, {x * Omega, 0.1 * Omega});
                if (root.found) ++found, best = std::max(best, root.omega.imag());
            }
        }
        CHECK(found >= 6);  // of twelve searches
        return best;
    };
    CHECK(fastest(6.5) <= 1e-9);
    CHECK(fastest(6.75) >= 0.01);
}

TEST_CASE("the seeded field of all Bernstein modes and of what stays is the seed") {
    // E = A/k at the start; a mode and its mirror image have E_k each.
    const std::string text = electrons("temperature_x = 0.5\ntemperature_z = 0.5\namplitude = 0.01",
                                       "[plasma]\nB_y = 0.6\n") +
                             wave;
    Case parameters = read(text);
    const Theory first = theory_of_wave(parameters);
    CHECK(first.source == "Bernstein mode, the one that is seeded most");
    std::vector<double> modes = first.others;
    modes.push_back(first.omega.real());
    double sum = 0, largest = 0;
    for (const double omega : modes) {
        parameters.near = omega;
        const Theory theory = theory_of_wave(parameters);
        CHECK(std::fabs(theory.omega.real() - omega) <= 1e-9);
        sum += 2 * theory.seed, largest = std::max(largest, theory.seed);
    }
    CHECK(std::fabs(first.seed - largest) <= 1e-12);
    const MagnetizedSpecies s = species(1, 0, std::sqrt(0.5), std::sqrt(0.5), -0.6);
    const double still =
        0.01 * s.harmonics.weight[0] / (1.0 + magnetized_response(s, 1e-9).chi.real());
    CHECK(std::fabs(sum + still - 0.01) <= 1e-6);  // less what the harmonics of least weight have
}

TEST_CASE("between along and across the least damped wave goes over from Landau to Bernstein") {
    const auto angle = [](double degrees) {
        const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
        return theory_of_wave(
            read(electrons("temperature_x = 0.16\ntemperature_y = 0.16\ntemperature_z = 0.16\n"
                           "amplitude = 1e-3",
                           "[plasma]\nB_x = " + facts::text(c) + "\nB_y = " + facts::text(s)) +
                 wave));
    };
    const common::PlasmaSpecies plain{
        .density = 0.25 / pi, .charge = -1, .mass = 1, .temperature_along = 0.16};
    const Complex landau = facts::fastest_growing_longitudinal({&plain, 1}, 1).omega;
    CHECK(std::abs(angle(0).omega - landau) <= 1e-9);
    CHECK(angle(60).omega.imag() < 0);
    CHECK(angle(60).omega.real() > landau.real());
    CHECK(angle(90).omega.imag() == 0);
}

TEST_CASE("a waterbag has its exact dispersion relation") {
    const Case parameters =
        read(electrons("distribution_x = \"abs(v) < 0.8 ? 3 : 0\"\ndistribution_max = 0.8\n"
                       "drift_x = 0.3\namplitude = 1e-3") +
             wave);
    const Distribution& f = parameters.species[1].tables.v[0];
    CHECK(std::fabs(f.mean()) <= 1e-12);
    CHECK(std::fabs(f.mean_square(0) - 0.64 / 3) <= 1e-12);
    for (const Complex omega : some_frequencies) {
        const Complex doppler = omega - 0.3;
        CHECK(std::abs(tabulated_susceptibility(f, 1, 1, 0.3, omega) +
                       1.0 / (doppler * doppler - 0.64)) <= 1e-12);
        // int f dv / (omega - k v), with f = 1 / (2 V)
        CHECK(std::abs(tabulated_free_response(f, 1, 0.3, omega) -
                       std::log((doppler + 0.8) / (doppler - 0.8)) / 1.6) <= 1e-12);
    }
    const Theory theory = theory_of_wave(parameters);
    CHECK(std::abs(theory.omega - (0.3 + std::sqrt(1.64))) <= 1e-12);
}

TEST_CASE("the theory of a Maxwellian by formula is that of a temperature") {
    const auto beams = [](const std::string& spread) {
        const std::string beam = "density = 0.5\namplitude = 1e-4\n" + spread;
        return theory_of_wave(
            read("[grid]\nlength_x = 20\n[species.ions]\ncharge = 1\n"
                 "motion = \"fixed\"\n[species.a]\ndrift_x = 3\n" +
                 beam + "[species.b]\ndrift_x = -3\n" + beam + wave));
    };
    const Theory exact = beams("temperature_x = 1\n"),
                 table = beams("distribution_x = \"exp(-v^2/2)\"\ndistribution_max = 8\n");
    CHECK(exact.omega.imag() > 0.2);
    CHECK(std::abs(table.omega - exact.omega) <= 2e-6);
    CHECK(std::fabs(table.seed / exact.seed - 1) <= 1e-5);
}

TEST_CASE("waves of smooth distributions by formula are damped as Landau says") {
    const auto root = [](const std::string& spread, const std::string& mode = "mode_x = 1\n") {
        return theory_of_wave(read(electrons("amplitude = 0.01\n" + mode + spread) + wave + mode));
    };
    // k lambda_D = 0.3 to 0.8, forward and backward
    for (const std::string v : {"0.3", "0.5", "0.8"})
        for (const std::string mode : {"mode_x = 1\n", "mode_x = -1\n"}) {
            CAPTURE(v + mode);
            const std::string rest = "drift_x = 0.7\n";
            const Theory exact = root("temperature_x = " + facts::text(std::pow(std::stod(v), 2)) +
                                          "\n" + rest,
                                      mode),
                         table = root("distribution_x = \"exp(-(v/" + v +
                                          ")^2/2)\"\ndistribution_max = 6\n" + rest,
                                      mode);
            CHECK(exact.omega.imag() < -0.01);
            CHECK(std::abs(table.omega - exact.omega) <= 1e-9);
            CHECK(std::fabs(table.seed / exact.seed - 1) <= 1e-6);
        }
    // f = (2 V^3 / pi) / (v^2 + V^2)^2:  H = -(c + 2 i V) / (c + i V)^2,  D = 1 - H'(omega)
    const double V = 0.4;
    const Theory theory = root("distribution_x = \"(v^2 + 0.16)^-2\"\ndistribution_max = 60\n");
    const auto D = [&](Complex c) {
        const Complex pole = c + Complex(0, V);
        return 1.0 - 1.0 / (pole * pole) - 2.0 * Complex(0, V) / (pole * pole * pole);
    };
    const common::DispersionRoot exact = common::root_near(D, Complex(1.2, -0.1));
    REQUIRE(exact.found);
    CHECK(exact.omega.imag() < -0.05);
    CHECK(std::abs(theory.omega - exact.omega) <= 1e-6);
}

TEST_CASE("a distribution that its series does not have keeps the theory of its table") {
    const auto theory = [](const std::string& length, const std::string& lines) {
        return theory_of_wave(
            read("[grid]\nlength_x = " + length +
                 "\n[species.ions]\ncharge = 1\nmotion = \"fixed\"\n[species.electrons]\n" + lines +
                 wave));
    };
    // Cut below its phase velocity a tail damps nothing: D = 1 - int f dv / (k v - omega)^2, f cut.
    const Theory cut =
        theory("31.41592653589793", "distribution_x = \"(1 + v^2/3)^-3\"\ndistribution_max = 3\n");
    const double k = 0.2;
    double mass = 0, sum = 0;
    for (int j = 0; j < 100000; ++j) {
        const double v = -3 + 6 * (j + 0.5) / 100000, f = std::pow(1 + v * v / 3, -3);
        mass += f, sum += f / std::pow(k * v - cut.omega.real(), 2);
    }
    CHECK(cut.omega.imag() == 0);
    CHECK(std::fabs(sum / mass - 1) <= 1e-5);
    // Ripples on a Maxwellian make waves grow: Newton's root of D with int f dv / (v - c)^2 summed.
    const Theory ripples =
        theory("12.566370614359172",
               "distribution_x = \"exp(-v^2/2)*(1 + 0.3*cos(20*v))\"\ndistribution_max = 8\n");
    Complex all = 0;
    mass = 0;
    for (int j = 0; j < 100000; ++j) {
        const double v = -8 + 16 * (j + 0.5) / 100000,
                     f = std::exp(-v * v / 2) * (1 + 0.3 * std::cos(20 * v));
        mass += f, all += f / std::pow(v - ripples.omega / 0.5, 2);
    }
    CHECK(ripples.omega.imag() > 0.04);
    // A step of the table is 0.08 of a radian of the ripple.
    CHECK(std::abs(all / mass / 0.25 - 1.0) <= 3e-3);
    // The fastest growing mode is found where others are too damped to be known.
    const Case beams = read(
        "[grid]\nlength_x = 31.416\n[species.ions]\ncharge = 1\nmotion = \"fixed\"\n"
        "[species.electrons]\ndistribution_x = \"exp(-(v-2)^2) + exp(-(v+2)^2)\"\n"
        "distribution_max = 8\n" +
        wave + "mode_x = 0\n");
    // One that grows, and more slowly than the table tells, is not passed over.
    CHECK(refusal("[grid]\nlength_x = 60\n[species.ions]\ncharge = 1\nmotion = \"fixed\"\n"
                  "[species.electrons]\ndistribution_max = 4\n"
                  "distribution_x = \"abs(v) < 3 ? exp(-v^2) : 1e-4*abs(v)\"\n" +
                  wave + "mode_x = 0\n")
              .find("is for waves that grow faster") != std::string::npos);
    CHECK(theory_of_wave(beams).mode_x == 2);
    CHECK(theory_of_wave(beams).omega.imag() > 0.2);
}

TEST_CASE("theory.near takes the nearest of all roots") {
    // Two cold beams of density 1/2 and velocity +-u: omega^2 = u^2 + 1/2 +- (2 u^2 + 1/4)^(1/2) at
    // k = 1.
    for (const double u : {0.6, 1.1}) {
        const std::string half = "density = 0.5\ndrift_x = ";
        Case parameters = read(electrons(half + facts::text(u) + "\namplitude = 1e-3",
                                         "[species.back]\n" + half + facts::text(-u)) +
                               wave);
        std::vector<Complex> roots;
        for (const double sign : {-1, 1}) {
            const double square = u * u + 0.5 + sign * std::sqrt(2 * u * u + 0.25);
            roots.push_back(std::sqrt(Complex(square))), roots.push_back(-roots.back());
        }
        for (double near = -3; near < 3; near += 0.07) {
            double least = 10;
            // How fast a wave grows does not count.
            const auto apart = [&](Complex root) {
                return std::hypot(root.real() - near, std::min(root.imag(), 0.0));
            };
            for (const Complex root : roots) least = std::min(least, apart(root));
            parameters.near = near;
            CAPTURE(near);
            CHECK(std::fabs(apart(theory_of_wave(parameters).omega) - least) <= 1e-9);
        }
    }
}

TEST_CASE("theory.mode_x = 0 finds the fastest of all modes in the time of a few") {
    const std::string long_box = "[grid]\nlength_x = 400\ncells_x = 1024\n",
                      ions = "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n",
                      ends = wave + "mode_x = 0\n";
    const std::vector<std::string> plasmas{
        "[species.a]\ndensity = 0.5\ndrift_x = 1\n[species.b]\ndensity = 0.5\ndrift_x = -1\n",
        "[species.a]\ndensity = 0.95\ntemperature_x = 1\n[species.b]\ndensity = 0.05\n"
        "drift_x = 4.5\ntemperature_x = 0.25\n",
        "[species.a]\ndistribution_x = \"exp(-(v-2)^2) + exp(-(v+2)^2)\"\ndistribution_max = 8\n"};
    for (const std::string& plasma : plasmas) {
        CAPTURE(plasma);
        const auto seconds = [](const auto& work) {
            const auto start = std::chrono::steady_clock::now();
            work();
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        Case parameters;
        const double all = seconds([&] { parameters = read(long_box + ions + plasma + ends); });
        const Theory found = theory_of_wave(parameters);
        CHECK(found.omega.imag() > 0.1);
        // None is faster; of a mode that is damped the search takes longest.
        double slowest = 0, fastest = 0;
        for (long m = 1; m < 512; m += m < 64 ? 1 : 64) try {
                slowest = std::max(slowest, seconds([&] {
                                       fastest = std::max(
                                           fastest, theory_of_wave(parameters, m, 0).omega.imag());
                                   }));
            } catch (const common::InputError&) {
            }
        CHECK(fastest == found.omega.imag());
        CHECK(all <= 100 * slowest);
    }
}

TEST_CASE("particles have the density and the distributions of the formulas") {
    for (const std::string loading : {"quiet", "random"}) {
        CAPTURE(loading);
        const Case parameters = read(
            electrons("particles_per_cell = 2000\nloading = \"" + loading +
                      "\"\ndensity = \"1 + .2*cos(x) + .1*sin(3*x)\"\ndrift_x = 0.5\n"
                      "distribution_x = \"(1 + v^2/3)^-3\"\ndistribution_max = 60\namplitude = 0"));
        CHECK(std::fabs(parameters.species[1].mean_density() - 1) <= 1e-14);
        const Particles s = load_species(parameters, parameters.species[1], 1);
        const double N = double(s.count());
        const double noise = loading == "random" ? 4 / std::sqrt(N) : 1e-3;
        Complex first = 0, third = 0;
        double mean = 0, square = 0, beyond = 0;
        for (std::size_t p = 0; p < s.x_p.size(); ++p) {
            first += std::polar(2 / N, -s.x_p[p]), third += std::polar(2 / N, -3 * s.x_p[p]);
            const double v = s.vx_p[p] - 0.5;
            mean += v / N, square += v * v / N, beyond += (std::fabs(v) > 3 ? 1 : 0) / N;
        }
        CHECK(std::abs(first - 0.2) <= 2 * noise);
        CHECK(std::abs(third - Complex(0, -0.1)) <= 2 * noise);
        CHECK(std::fabs(mean) <= noise);
        // <v^2> = 3 / (2 kappa - 3) = 1; of all particles the part beyond three thermal speeds,
        // 1 - (2 / pi) [atan(u) + u/(1 + u^2) + 2 u/(3 (1 + u^2)^2)], u = 3 / 3^1/2
        const double u = std::sqrt(3.0), one = 1 + u * u;
        const double tail = 1 - 2 / pi * (std::atan(u) + u / one + 2 * u / (3 * one * one));
        CHECK(std::fabs(square - 1) <= (loading == "random" ? 0.08 : 0.01));
        CHECK(std::fabs(beyond - tail) <= noise);
    }
}

TEST_CASE("in the plane a formula of density gives both coordinates") {
    const Case parameters = read(
        "[grid]\ndimensions = 2\ncells_x = 16\ncells_z = 16\nlength_x = 4\nlength_z = 4\n"
        "[constant.R]\nvalue = 1.5\n"
        "[species.electrons]\ncenter_x = 2\ncenter_z = 2\nparticles_per_cell = 400\n"
        "density = \"r < R ? r : 0\"\n[species.ions]\ncharge = 1\nmass = 1e9\n"
        "density = \"sqrt((x - 2)^2 + (z - 2)^2) < 1.5 ? sqrt((x - 2)^2 + (z - 2)^2) : 0\"");
    const Particles s = load_species(parameters, parameters.species[0], 1);
    double r1 = 0, right = 0, above = 0, N = double(s.count());
    for (std::size_t p = 0; p < s.x_p.size(); ++p) {
        const double r = std::hypot(s.x_p[p] - 2, s.z_p[p] - 2);
        CHECK(r <= 1.51);
        r1 += r / N, right += (s.x_p[p] > 2) / N, above += (s.z_p[p] > 2) / N;
    }
    CHECK(std::fabs(r1 - 0.75 * 1.5) <= 0.003);  // <r> of r^2 dr
    CHECK(std::fabs(right - 0.5) <= 0.003);
    CHECK(std::fabs(above - 0.5) <= 0.003);
    // Charge as the integral of r 2 pi r dr.
    CHECK(std::fabs(-s.q_p * N / (2 * pi * std::pow(1.5, 3) / 3) - 1) <= 0.003);
}

TEST_CASE("a ring has one speed across the field and every angle") {
    for (const std::string axis : {"x", "y", "z"}) {
        const Case parameters =
            read(electrons("distribution_across = \"abs(v - 1) < .01 ? 1 : 0\"\n"
                           "distribution_max = 1.2\ntemperature_" +
                               axis +
                               " = 0.04\n"
                               "particles_per_cell = 512",
                           "[plasma]\nB_" + axis + " = 0.5\n"));
        const Particles s = load_species(parameters, parameters.species[1], 1);
        double along = 0, mean = 0;
        for (std::size_t p = 0; p < s.x_p.size(); ++p) {
            const double v[3] = {s.vx_p[p], s.vy_p[p], s.vz_p[p]};
            const std::size_t a = parameters.axis();
            const double across = std::hypot(v[(a + 1) % 3], v[(a + 2) % 3]);
            CHECK(std::fabs(across - 1) <= 0.011);
            along += v[a] * v[a] / double(s.count()), mean += v[(a + 1) % 3] / double(s.count());
        }
        CHECK(std::fabs(along / 0.04 - 1) <= 0.02);
        CHECK(std::fabs(mean) <= 0.01);
    }
}

TEST_CASE("a species has all modes that it is seeded with") {
    const Case parameters =
        read(electrons("loading = \"lattice\"\nparticles_per_cell = 500\namplitude = 0.001\n"
                       "mode_x = 2",
                       "[perturbation.a]\nspecies = \"electrons\"\nmode_x = 3\n"
                       "amplitude = -0.002\n[perturbation.b]\nspecies = \"electrons\"\nmode_x = 5\n"
                       "amplitude = 0.003\nwave = \"traveling\"\n"));
    const Particles s = load_species(parameters, parameters.species[1], 1);
    const auto mode = [&](double k, const std::vector<Real>* of) {
        Complex sum = 0;
        for (std::size_t p = 0; p < s.x_p.size(); ++p)
            sum +=
                std::polar((of == nullptr ? 1 : (*of)[p]) * 2 / double(s.count()), -k * s.x_p[p]);
        return sum;
    };
    const double square = 1e-5;  // of amplitudes
    CHECK(std::abs(mode(1, nullptr)) <= square);
    CHECK(std::abs(mode(2, nullptr) - 0.001) <= square);
    CHECK(std::abs(mode(3, nullptr) + 0.002) <= square);
    CHECK(std::abs(mode(5, nullptr) - 0.003) <= square);
    // Only the traveling one moves: v = (omega / k) A cos(k x), omega = 1.
    CHECK(std::abs(mode(3, &s.vx_p)) <= square);
    CHECK(std::abs(mode(5, &s.vx_p) - 0.003 / 5) <= square);
}

TEST_CASE("formulas that cannot be loaded or compared are refused with the place and the cure") {
    const std::string f = "distribution_x = \"exp(-v^2)\"\n", ends = "distribution_max = 4\n",
                      cusp = "distribution_x = \"exp(-2*abs(v))\"\n" + ends;
    const std::vector<std::array<std::string, 2>> wrong{
        {electrons("density = \"1 + foo\""),
         "case.toml:8:11: 'species.electrons.density' = \"1 + foo\": Unexpected token \"foo\""},
        {electrons("density = \"1 - x\""), "\"1 - x\" is -"},
        {electrons("density = \"0*x\""), "species.electrons.density is 0 everywhere"},
        {electrons("density = \"1 + x - x\"\nloading = \"lattice\""),
         "species.electrons.density is a formula: it needs profile = \"uniform\""},
        {electrons("density = \"2 + 0*x\""), "add a fixed species with density 1 and charge 1"},
        {electrons(f), "species.electrons.distribution_x needs species.electrons.distribution_max"},
        {electrons(ends), "species.electrons.distribution_max ends a distribution by formula"},
        {electrons("distribution_x = \"x\"\n" + ends), "known are v, pi, constants"},
        {electrons("distribution_x = \"v\"\n" + ends), "\"v\" is -3.999 at v = -3.999; allowed"},
        {electrons(f + ends + "temperature_x = 1"),
         "species.electrons.distribution_x has a temperature of its own: take out temperature_x"},
        {electrons(f + ends + "loading = \"lattice\""), "\"lattice\" is for cold species"},
        {electrons("distribution_x = \"exp(-v^2/2) + 14*exp(-((v - 3.2117)/1e-3)^2/2)\"\n"
                   "distribution_max = 8\n"),
         "species.electrons.distribution_x has parts narrower than the pieces of its table"},
        {electrons("distribution_x = \"exp(-v^2/2) + 100*exp(-((v - 3.2123)/1e-3)^2)\"\n"
                   "distribution_max = 8\n"),
         "species.electrons.distribution_x has parts narrower than the pieces of its table"},
        {electrons("distribution_y = 1\n" + ends), "a velocity out of the plane"},
        {electrons("distribution_across = 1\n" + ends),
         "a velocity along z, which nothing can see"},
        {electrons("distribution_across = 1\ntemperature_z = 1\n" + ends, "[plasma]\nB_y = 1\n"),
         "species.electrons.distribution_across is also of the velocity along z"},
        {electrons("distribution_across = 1\n" + ends, "[plasma]\nB_y = 1\nB_x = 1\n"),
         "distribution_across needs a magnetic field along x, y or z"},
        {electrons("", "[constant.a]\nvalue = 1\n"), "[constant.*] needs a formula in a species"},
        {electrons("density = \"1 + .1*cos(x)\"") + wave,
         "the density of 'electrons' is a formula"},
        {electrons(f + ends) + wave + "model = \"mesh\"\n",
         "theory.model = \"mesh\" is for Maxwellians"},
        {electrons(f + ends, "[plasma]\nB_y = 1\n") + wave, "needs the same temperature in all"},
        {electrons("distribution_y = \"exp(-v^2)\"\n" + ends, "[plasma]\nB_y = 1\n") + wave,
         "is for Maxwellians and distribution_across"},
        {electrons(f + ends) + "[theory]\ncompare = \"heating\"\n",
         "theory.compare = \"heating\" is for species without formulas"},
        {electrons(cusp + "amplitude = 0.01") + wave,
         "and where a distribution by formula has steps or steep slopes, or is cut before it is "
         "1e-8 of its largest, none that is damped is known: raise distribution_max"},
        {"[grid]\nlength_x = 20\n[species.ions]\ncharge = 1\nmotion = \"fixed\"\n"
         "[species.electrons]\n" +
             std::string("distribution_x = \"abs(v) < 3 ? exp(-v^2) : 1e-4*abs(v)\"\n") + ends +
             wave,
         "whose distribution by formula has steps or steep slopes, or is cut before it is 1e-8 of "
         "its "
         "largest, is for waves that grow"},
    };
    for (const auto& [text, message] : wrong) {
        CAPTURE(text);
        const std::string said = refusal(text);
        CAPTURE(said);
        CHECK(said.find(message) != std::string::npos);
    }
    CHECK(refusal(electrons(f + ends + "amplitude = 0.1")) == "nothing");
    for (const std::string width : {"0.05", "0.2", "0.8"})
        CHECK(refusal(electrons("distribution_x = \"abs(v) < " + width +
                                " ? 1 : 0\"\ndistribution_max = 9\n")) == "nothing");
}

TEST_CASE("Bernstein modes between all harmonics are seen in one run" *
          doctest::description("physics")) {
    for (const std::string near : {"0", "0.6888", "1.583"}) {
        CAPTURE(near);
        facts::check_results(
            facts::run_into("cic_bernstein", "cic", "cic/cases/bernstein.toml theory.near=" + near),
            1);
    }
}

TEST_CASE("waterbag kappa and ring have the waves of their distributions" *
          doctest::description("physics")) {
    facts::check_results(facts::run_into("cic_waterbag", "cic", "cic/cases/waterbag.toml"), 1);
    facts::check_results(facts::run_into("cic_kappa", "cic", "cic/cases/kappa.toml"), 2);
    facts::check_results(facts::run_into("cic_ring", "cic", "cic/cases/ring.toml"), 3);
}

TEST_CASE("an ion acoustic wave has its frequency and its damping" *
          doctest::description("physics")) {
    facts::check_results(facts::run_into("cic_ion_acoustic", "cic", "cic/cases/ion_acoustic.toml"),
                         4);
}

TEST_CASE("a damped wave that nothing but noise starts is not judged" *
          doctest::description("physics")) {
    const facts::Run noise =
        facts::run_into("cic_unseeded", "cic",
                        "cic/cases/landau.toml species.electrons.amplitude=0 "
                        "species.electrons.particles_per_cell=256 theory.mode_x=1 time.end=20");
    CHECK(noise.summary["results"]["damping_over_theory"].dump().find("no species is perturbed") !=
          std::string::npos);
    const facts::Run backward =
        facts::run_into("cic_backward", "cic",
                        "cic/cases/landau.toml species.electrons.wave=traveling "
                        "species.electrons.mode_x=-1 theory.mode_x=1");
    CHECK(backward.summary["results"]["damping_over_theory"]["verdict"] == "PASS");
}
