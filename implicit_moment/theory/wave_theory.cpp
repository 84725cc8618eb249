// What wave_theory.hpp declares: what each wave needs of a case, and the root of its dispersion relation.
#include "implicit_moment/theory/wave_theory.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"
#include "implicit_moment/theory/cold_plasma.hpp"
#include "implicit_moment/theory/magnetized_plasma.hpp"
#include "implicit_moment/theory/theta_light_wave.hpp"
#include "implicit_moment/theory/transverse_dispersion.hpp"

namespace implicit_moment {

namespace {

// Whether it is E_y, with B in the plane, that is followed.
bool has_E_along_y(const Case& w) {
    return w.component == "E_y" || w.component == "B_x" || w.component == "B_z";
}

// The species of a uniform case as the dispersion relation wants them, with k along a mode.
//     T_k = T_x k_x^2/k^2 + T_z k_z^2/k^2
std::vector<common::PlasmaSpecies> theory_species(const Case& w, WaveVector k) {
    const UniformCase& u = w.uniform;
    const double along_x = k.x / k.size(), along_z = k.z / k.size();
    const bool across_is_y = has_E_along_y(w);
    std::vector<common::PlasmaSpecies> plasma;
    for (const SpeciesCase& s : u.species) {
        common::PlasmaSpecies p;
        p.density = n0 * s.density, p.charge = s.charge, p.mass = s.mass;
        p.drift = s.drift_x * along_x + s.drift_z * along_z;
        p.temperature_along =
            s.temperature_x * along_x * along_x + s.temperature_z * along_z * along_z;
        const double T_plane =
            s.temperature_x * along_z * along_z + s.temperature_z * along_x * along_x;
        const double u_plane = s.drift_z * along_x - s.drift_x * along_z;
        p.temperature_across = across_is_y ? s.temperature_y + s.mass * s.drift_y * s.drift_y
                                           : T_plane + s.mass * u_plane * u_plane;
        p.gyrofrequency = s.charge * (u.B_x * along_x + u.B_z * along_z) / (s.mass * c);
        plasma.push_back(p);
    }
    return plasma;
}

// A part of a Maxwellian of one component of u: its value there, and its share.
struct ShareOfMaxwellian {
    double u = 0, share = 1;
};

// Gauss and Hermite's points of a Maxwellian with mean u and variance T/m.
// exact: for polynomials of u to the power 2 count - 1
std::vector<ShareOfMaxwellian> shares_of_maxwellian(double u, double variance,
                                                    std::size_t count = 12) {
    if (variance == 0) return {{u, 1}};
    const std::unique_ptr<gsl_integration_fixed_workspace, decltype(&gsl_integration_fixed_free)>
        points(gsl_integration_fixed_alloc(gsl_integration_fixed_hermite, count, u, 0.5 / variance,
                                           0, 0),
               gsl_integration_fixed_free);
    std::vector<ShareOfMaxwellian> shares;
    for (std::size_t n = 0; n < count; ++n)
        shares.push_back(
            {gsl_integration_fixed_nodes(points.get())[n],
             gsl_integration_fixed_weights(points.get())[n] / std::sqrt(2 * pi * variance)});
    return shares;
}

// What a species where u = gamma v adds to 1 in the dispersion relation of a wave with E along k:
//     - omega_s^2 integral f(u) (d v_k / d u_k) / (omega - k v_k)^2 d^3u,   d v_k / d u_k = (1 + u_across^2/c^2)/gamma^3,
// by Gauss and Hermite's points across k and a trapezoidal rule along u_k - i d, below the pole of what is damped
// and above where gamma = 0: the rule is exact to 1e-6 there.
// out:   no value for waves that are damped so much that their pole is not above that line
common::Complex relativistic_response(const SpeciesCase& s, const common::PlasmaSpecies& along,
                                      WaveVector k, common::Complex omega) {
    const double size = k.size(), x = k.x / size, z = k.z / size, T_y = s.temperature_y / s.mass,
                 T_plane = (s.temperature_x * z * z + s.temperature_z * x * x) / s.mass,
                 spread = along.speed_along();
    const std::size_t count = std::max(T_plane, T_y) > 0.003 * c * c ? 4 : 2;
    const common::Complex V = omega / (size * c);
    common::Complex sum = 0;
    for (const auto& plane : shares_of_maxwellian(s.drift_z * x - s.drift_x * z, T_plane, count))
        for (const auto& y : shares_of_maxwellian(s.drift_y, T_y, count)) {
            const double across = 1 + (plane.u * plane.u + y.u * y.u) / (c * c),
                         share = plane.share * y.share;
            const auto answer = [&](common::Complex u) {
                const common::Complex gamma = std::sqrt(across + u * u / (c * c)),
                                      shifted = omega - size * u / gamma;
                return across / (gamma * gamma * gamma * shifted * shifted);
            };
            if (spread == 0) {
                sum += share * answer(along.drift);
                continue;
            }
            const double below = std::min(4 * spread, 0.7 * c * std::sqrt(across));
            const common::Complex pole = c * V * std::sqrt(across) / std::sqrt(1.0 - V * V);
            if (std::fabs(V.real()) < 1 && pole.imag() < -0.8 * below) return common::no_value;
            constexpr int points = 40;
            const double step = 16.0 / points;
            for (int n = 0; n < points; ++n) {
                const common::Complex t(step * (n + 0.5) - 8, -below / spread);
                sum += share * step / std::sqrt(2 * pi) * std::exp(-0.5 * t * t) *
                       answer(along.drift + spread * t);
            }
        }
    return -along.frequency_squared() * sum;
}

// Species that answer about as these do, with the Lorentz factor of their drifts, for guesses.
std::vector<common::PlasmaSpecies> slow_species(const Case& w, WaveVector k) {
    std::vector<common::PlasmaSpecies> plasma = theory_species(w, k);
    if (!w.is_relativistic()) return plasma;
    for (std::size_t n = 0; n < plasma.size(); ++n) {
        const SpeciesCase& s = w.uniform.species[n];
        const double gamma = std::sqrt(
            1 + (s.drift_x * s.drift_x + s.drift_y * s.drift_y + s.drift_z * s.drift_z) / (c * c));
        plasma[n].drift /= gamma;
        const double part = (1 - plasma[n].drift * plasma[n].drift / (c * c)) / gamma;
        plasma[n].mass /= part;
        plasma[n].temperature_along *= part;
    }
    return plasma;
}

// D of a wave with E along k.
common::Complex longitudinal_answer(const Case& w, WaveVector k, common::Complex omega) {
    const std::vector<common::PlasmaSpecies> plasma = theory_species(w, k);
    if (!w.is_relativistic()) return common::longitudinal_dispersion(plasma, k.size(), omega);
    common::Complex D = 1;
    for (std::size_t n = 0; n < plasma.size(); ++n)
        D += relativistic_response(w.uniform.species[n], plasma[n], k, omega);
    return D;
}

// The species of a uniform case where u = gamma v, as streams for a wave across k.
// note:  gamma counts the mean square of u along k.
std::vector<Stream> streams_of(const Case& w, WaveVector k) {
    const double along_x = k.x / k.size(), along_z = k.z / k.size();
    std::vector<Stream> streams;
    for (const SpeciesCase& s : w.uniform.species) {
        double T_E = s.temperature_y, u_E = s.drift_y,
               T_other = s.temperature_x * along_z * along_z + s.temperature_z * along_x * along_x,
               u_other = s.drift_z * along_x - s.drift_x * along_z;
        if (!has_E_along_y(w)) std::swap(T_E, T_other), std::swap(u_E, u_other);
        const double u_k = s.drift_x * along_x + s.drift_z * along_z,
                     variance = (s.temperature_x * along_x * along_x +
                                 s.temperature_z * along_z * along_z) /
                                s.mass;
        for (const auto& one : shares_of_maxwellian(u_E, T_E / s.mass))
            for (const auto& other : shares_of_maxwellian(u_other, T_other / s.mass)) {
                const double gamma = std::sqrt(
                                 1 + (u_k * u_k + variance + one.u * one.u + other.u * other.u) /
                                         (c * c)),
                             v_k = u_k / gamma;
                streams.push_back({4 * pi * n0 * s.density * one.share * other.share * s.charge *
                                       s.charge / (s.mass * gamma),
                                   v_k, one.u / gamma,
                                   std::sqrt(variance) * (1 - v_k * v_k / (c * c)) / gamma});
            }
    }
    return streams;
}

// All that answers a transverse wave: species, or streams where particles weigh gamma m and nothing turns them.
struct TransverseAnswer {
    std::vector<common::PlasmaSpecies> plasma;
    std::vector<Stream> streams;
    common::Complex operator()(double k, int sense, common::Complex omega,
                               double part_of_E = 1) const {
        common::Complex sum = 0;
        for (const Stream& s : streams) sum += stream_response(s, k, c, omega, part_of_E);
        if (!streams.empty()) return sum;
        for (const auto& s : plasma) sum += transverse_response(s, k, sense, omega, part_of_E);
        return sum;
    }
};
TransverseAnswer transverse_answer(const Case& w) {
    const UniformCase& u = w.uniform;
    const WaveVector k = wave_vector(w);
    TransverseAnswer answer{theory_species(w, k), {}};
    if (w.is_relativistic() && u.B_x == 0 && u.B_y == 0 && u.B_z == 0)
        answer.streams = streams_of(w, k);
    return answer;
}

// Of the theta scheme: omega from the complex factor of one step.
Theory of_factor(const Case& w, std::complex<double> g) {
    return {std::complex<double>(std::fabs(std::arg(g)), std::log(std::abs(g))) / w.dt,
            "exact factor per step of the theta scheme", true};
}

void refuse_light(const Case& w, const std::string& name) {
    refuse(!w.uniform.species.empty(), "theory.wave = \"", name,
           "\" is a wave in vacuum: take out the species or choose \"transverse\"");
}
Theory expect_light(const Case& w) {
    const WaveVector k = wave_vector(w);
    if (w.leapfrog.chosen)
        return {yee_frequency(w.grid, w.dt, k.x, k.z), "exact dispersion on Yee's mesh", true};
    return of_factor(w, theta_light_wave(w.field.theta, c * w.dt * mesh_wave_vector(w).size()));
}

void refuse_kinetic(const Case& w, const std::string& name) {
    const UniformCase& u = w.uniform;
    const WaveVector k = wave_vector(w);
    refuse(u.species.empty(), "theory.wave = \"", name, "\" needs a [species.<name>]");
    refuse(u.B_y != 0 ||
               std::fabs(u.B_x * k.z - u.B_z * k.x) > 1e-9 * std::hypot(u.B_x, u.B_z) * k.size(),
           "the dispersion relation is solved for B along k or zero: take out the part of "
           "uniform.B across the mode, or choose \"magnetized\" or \"cold\" for theory.wave");
}

// The mean velocity of a species.
Eigen::Vector3d mean_velocity(const Case& w, const SpeciesCase& s) {
    const Eigen::Vector3d u(s.drift_x, s.drift_y, s.drift_z);
    return w.is_relativistic() ? Eigen::Vector3d(u / std::sqrt(1 + u.squaredNorm() / (c * c))) : u;
}

// A current along k begins to oscillate with the plasma frequency, and what moved on the average rests on the
// average: no wave keeps its frequency.
void refuse_current(const Case& w, const std::string& wave) {
    const WaveVector k = wave_vector(w);
    double current = 0, charges = 0, frequency_2 = 0;
    for (const SpeciesCase& s : w.uniform.species) {
        const Eigen::Vector3d v = mean_velocity(w, s);
        current += s.density * s.charge * (v[0] * k.x + v[2] * k.z) / k.size();
        charges = std::max(charges, s.density * std::fabs(s.charge));
        frequency_2 += 4 * pi * n0 * s.density * s.charge * s.charge / s.mass;
    }
    refuse(std::fabs(current) * k.size() > 0.003 * charges * std::sqrt(frequency_2), wave,
           " is stated for a plasma without current, and along the mode it has ", current,
           " e n0 c: choose drifts so that the sum of density, charge and drift is 0");
}

// Where E along k and across it are not apart, neither dispersion relation holds: temperatures that differ along
// x and z, and drifts u across k of species that answer alike along it, but where sum omega_s^2 u is 0 for
// these, as of beams that go opposite ways. What is transverse needs the products of the two parts of u to
// cancel, too. A drift across B is no equilibrium.
void refuse_coupled(const Case& w, const std::string& wave, bool transverse) {
    const UniformCase& u = w.uniform;
    const WaveVector k = wave_vector(w);
    const Eigen::Vector3d along(k.x / k.size(), 0, k.z / k.size()), B(u.B_x, u.B_y, u.B_z);
    const auto drift = [&](const SpeciesCase& s) {
        return Eigen::Vector3d(s.drift_x, s.drift_y, s.drift_z);
    };
    // Along y and in the plane.
    const auto across = [&](const SpeciesCase& s) {
        return Eigen::Vector2d(s.drift_y, s.drift_z * along[0] - s.drift_x * along[2]);
    };
    const auto answer_alike = [&](const SpeciesCase& a, const SpeciesCase& b) {
        const auto alike = [](double one, double other) {
            return std::fabs(one - other) <= 1e-9 * (std::fabs(one) + std::fabs(other));
        };
        return alike(a.temperature_x * b.mass, b.temperature_x * a.mass) &&
               alike(a.temperature_z * b.mass, b.temperature_z * a.mass) &&
               std::fabs(along.dot(drift(a) - drift(b))) <= 1e-9 &&
               // What weighs gamma m answers as gamma says.
               (!w.is_relativistic() ||
                std::fabs(drift(a).squaredNorm() - drift(b).squaredNorm()) <= 0.01 * c * c);
    };
    for (const SpeciesCase& s : u.species) {
        if (s.charge == 0) continue;
        refuse(B.norm() > 0 && across(s).norm() > 1e-9, "species '", s.name,
               "' drifts across uniform.B: ", wave, " wants drifts along it");
        refuse(k.x * k.z != 0 && s.temperature_x != s.temperature_z, "species '", s.name,
               "' has another temperature along x than along z, and a wave at an angle to both is "
               "neither longitudinal nor transverse: make them equal, or the mode along x or z");
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        double product = 0, all = 0;
        for (const SpeciesCase& other : u.species) {
            if (!answer_alike(s, other)) continue;
            const double weight = other.density * other.charge * other.charge / other.mass;
            sum += weight * across(other), product += weight * across(other).prod(), all += weight;
        }
        const bool mixed = transverse && std::fabs(product) > 4e-4 * c * c * all;
        refuse(mixed || sum.norm() > 0.02 * c * all, "species '", s.name,
               "' drifts across the mode with u = ", across(s).norm(),
               " c, and no other one like it the other way: its waves are neither longitudinal nor "
               "transverse; take that below 0.02 c, or give it a partner",
               (mixed ? ", and drifts along y or in the plane, not both" : ""));
    }
}

void refuse_uncharged(const Case& w, const std::string& wave) {
    const auto& species = w.uniform.species;
    refuse(std::ranges::all_of(species, [](const SpeciesCase& s) { return s.charge == 0; }), wave,
           " needs charges: ",
           (species.empty() ? "it needs a [species.<name>]" : "give a species a charge"));
}

void refuse_langmuir(const Case& w, const std::string& name) {
    const std::string wave = "theory.wave = \"" + name + "\"";
    refuse_uncharged(w, wave);
    refuse_warm(w, wave);
    refuse_kinetic(w, name);
    refuse(std::ranges::none_of(cold_waves(w), [](const ColdWave& one) { return one.along > 0.5; }),
           wave,
           ": no wave has its E along k, since the field of this mode is smoothed away: lower ",
           "uniform.mode_x or mode_z, or set field.smoothing_passes = 0");
}
// The wave of the cold plasma with E along k; of two that are overdamped, the one that stays.
Theory expect_langmuir(const Case& w) {
    const auto waves = cold_waves(w);
    const auto value = [](const ColdWave& one) {
        return one.along > 0.5 ? one.omega.imag() : -HUGE_VAL;
    };
    return {std::ranges::max_element(waves, {}, value)->omega,
            "cold plasma, exact for the step of the program", true};
}

// The waves of the cold plasma that the component which is followed has a part in.
std::vector<ColdWave> followed_waves(const Case& w) {
    std::vector<ColdWave> waves = cold_waves(w);
    std::erase_if(waves, [](const ColdWave& one) { return !(one.followed > 1e-9); });
    return waves;
}

void refuse_without_near(const Case& w, const std::string& wave) {
    if (w.near > 0) return;
    std::string found;
    double last = 0;
    for (const ColdWave& one : followed_waves(w)) {
        if (one.omega.real() > (1 + 1e-7) * last)
            found += (found.empty() ? "" : ", ") + format(one.omega.real());
        last = one.omega.real();
    }
    refuse(true, wave,
           " needs theory.near: without temperatures and drifts this plasma has waves at omega = ",
           (found.empty() ? "none in theory.component" : found),
           "; for what grows without a frequency give a hundredth to a tenth of its growth");
}

// The Lorentz factor is not in what turns about B.
void refuse_fast(const Case& w, const SpeciesCase& s, const std::string& wave) {
    const double drift = std::hypot(s.drift_x, s.drift_y, s.drift_z);
    refuse(w.is_relativistic() && drift > 0.1 * c, "species '", s.name, "' drifts with u = ", drift,
           " c: with uniform.B ", wave,
           " takes drifts below 0.1 c where particles are relativistic; for E along B and k choose "
           "\"longitudinal\"");
}

// The wave of the cold plasma that is nearest to theory.near.
Theory expect_cold(const Case& w) {
    const auto waves = followed_waves(w);
    const auto distance = [&](const ColdWave& one) { return std::fabs(one.omega.real() - w.near); };
    return {std::ranges::min_element(waves, {}, distance)->omega,
            "cold plasma, exact for the step of the program", true};
}
void refuse_cold(const Case& w, const std::string& name) {
    const std::string wave = "theory.wave = \"" + name + "\"";
    refuse_uncharged(w, wave);
    refuse_warm(w, wave);
    refuse(followed_waves(w).empty(),
           "no wave of the seeded mode has a part in theory.component = \"", w.component,
           "\": choose another one");
    refuse_without_near(w, wave);
}

// How far a root is from theory.near. That a wave grows does not make it another one: it covers all others.
double apart(common::Complex omega, double near) {
    return std::hypot(omega.real() - near, std::min(omega.imag(), 0.0));
}

// Of the roots that Newton's method reaches from places around a frequency the one that is nearest to it. Some
// of these are where Re D changes its sign: a root beside a harmonic of the gyration is reached from nowhere else.
// What grows and what decays comes in pairs where nothing is warm. omega = 0, which some D have, is no wave.
template <class Dispersion>
common::DispersionRoot nearest_root(const Dispersion& D, double frequency) {
    std::vector<common::Complex> guesses;
    for (const double part : {1.0, 0.97, 1.03, 0.9, 1.1, 0.8, 1.25, 0.6, 1.6, 0.4, 0.2})
        for (const double damped : {0.0, 0.05, 0.3})
            guesses.push_back(frequency * common::Complex(part, -damped * part));
    // What only grows may do so much faster than the frequency that is given.
    for (double growth = 0.25; growth < 100; growth *= 2)
        guesses.emplace_back(0, frequency * growth);
    constexpr int places = 240;
    double last = 0;
    for (int n = 0; n <= places; ++n) {
        const double at = frequency * (0.7 + 0.7 * n / places), here = D(at).real();
        if (n > 0 && here * last < 0) guesses.push_back(at - 0.35 * frequency / places);
        last = here;
    }
    common::DispersionRoot best;
    const auto look = [&](common::Complex guess) {
        auto root = common::root_near(D, guess);
        // Of what does not travel round-off makes waves either way.
        if (std::fabs(root.omega.real()) <= 1e-9 * std::abs(root.omega)) root.omega.real(0);
        const double lead =
            best.found ? apart(best.omega, frequency) - apart(root.omega, frequency) : HUGE_VAL;
        const bool faster = root.omega.imag() > best.omega.imag(),
                   better = lead > 1e-9 * frequency || (lead >= -1e-9 * frequency && faster);
        const double least = root.omega.real() == 0 ? 0.01 : 1e-6;
        if (root.found && root.omega.real() >= 0 && std::abs(root.omega) > least * frequency &&
            better)
            best = root;
    };
    for (const common::Complex& guess : guesses) look(guess);
    if (best.found && best.omega.imag() < 0) look(std::conj(best.omega));
    return best;
}

// The root of D on the mesh that is next to the one of D without a mesh, or without that to theory.near.
// errors: InputError when no root was found.
template <class Dispersion>
Theory kinetic(const Case& w, const common::DispersionRoot& without, const Dispersion& on_mesh) {
    common::DispersionRoot root;
    if (without.found) root = common::root_near(on_mesh, without.omega);
    // Newton's method may leap from one to another.
    const double size = std::abs(without.omega);
    if (w.near != 0 && !(root.found && std::abs(root.omega - without.omega) < 0.2 * size))
        root = nearest_root(on_mesh, without.found ? size : w.near);
    refuse(!root.found, "no root of the ", w.wave, " dispersion relation was found",
           (w.near != 0 ? " near " + format(w.near) : std::string()),
           ": change theory.near, or set theory.wave = \"none\"");
    return {root.omega, "root of the kinetic dispersion relation on this mesh", false, without};
}

Theory expect_longitudinal(const Case& w) {
    const WaveVector k = wave_vector(w);
    const auto D = [&](common::Complex omega) { return longitudinal_answer(w, k, omega); };
    std::vector<common::Complex> guesses = common::fan_of_guesses(slow_species(w, k), k.size());
    // Integrals over gamma v take their time: every seventh guess, which has all angles and radii.
    if (w.is_relativistic())
        for (std::size_t n = 0; n < guesses.size(); ++n)
            if (n % 7 != 0) guesses[n] = 0;
    std::erase(guesses, common::Complex(0));
    return kinetic(w,
                   w.near != 0 ? nearest_root(D, w.near) : common::fastest_growing_root(D, guesses),
                   [&](auto omega) { return longitudinal_dispersion_on_mesh(w, omega); });
}

Theory expect_transverse(const Case& w) {
    const double k = wave_vector(w).size();
    const TransverseAnswer answer = transverse_answer(w);
    common::DispersionRoot root;
    int sense_of_root = 1;
    for (const int sense : {+1, -1}) {
        const auto D = [&](common::Complex omega) {
            return omega * omega - c * c * k * k + answer(k, sense, omega);
        };
        const auto found = w.near != 0 ? nearest_root(D, w.near)
                                       : common::fastest_growing_root(
                                             D, common::fan_of_guesses(answer.plasma, k, c));
        const bool better = w.near != 0 ? apart(found.omega, w.near) < apart(root.omega, w.near)
                                        : found.omega.imag() > root.omega.imag() + 1e-12;
        if (found.found && (!root.found || better)) root = found, sense_of_root = sense;
    }
    return kinetic(w, root, [&](auto omega) {
        return transverse_dispersion_on_mesh(w, sense_of_root, omega);
    });
}

Theory expect_magnetized(const Case& w) {
    const auto plasma = magnetized_species(w);
    const MagnetizedWave k = magnetized_wave(w, wave_vector(w));
    const auto D = [&](common::Complex omega) {
        return magnetized_dispersion(plasma, k, c, omega);
    };
    return kinetic(w, nearest_root(D, w.near),
                   [&](auto omega) { return magnetized_dispersion_on_mesh(w, omega); });
}

// These need a root, too.
void refuse_magnetized(const Case& w, const std::string& name) {
    const std::string wave = "theory.wave = \"" + name + "\"";
    const UniformCase& u = w.uniform;
    const Eigen::Vector3d B(u.B_x, u.B_y, u.B_z), b = B.normalized();
    refuse_uncharged(w, wave);
    refuse(B.norm() == 0, wave,
           " needs a field: give uniform.B_x, B_y or B_z, or choose \"longitudinal\" or "
           "\"transverse\"");
    for (const SpeciesCase& s : u.species) {
        const Eigen::Vector3d T(s.temperature_x, s.temperature_y, s.temperature_z),
            drift(s.drift_x, s.drift_y, s.drift_z);
        const double along = T.dot(b.cwiseAbs2()), across = 0.5 * (T.sum() - along);
        const Eigen::Matrix3d turned =
            across * Eigen::Matrix3d::Identity() + (along - across) * b * b.transpose();
        refuse((turned - Eigen::Matrix3d(T.asDiagonal())).norm() > 1e-9 * T.norm(), "species '",
               s.name, "' has two temperatures across uniform.B: ", wave,
               " wants one across it and one along it");
        refuse(drift.cross(b).norm() > 1e-9 * drift.norm(), "species '", s.name,
               "' drifts across uniform.B: ", wave, " wants drifts along it");
        refuse_fast(w, s, wave);
    }
    for (const MagnetizedSpecies& s : magnetized_species(w)) {
        const double gyrations = std::sqrt(gyration_squared(s, magnetized_wave(w, wave_vector(w))));
        refuse(!(gyrations <= 1000), wave,
               " sums over the harmonics of the gyration, and k times its radius is ", gyrations,
               ", above 1000: take a stronger uniform.B, or none and \"longitudinal\" or ",
               "\"transverse\"");
    }
    refuse_current(w, wave);
    refuse_without_near(w, wave);
    const common::DispersionRoot root = expect_magnetized(w).without_mesh;
    if (!root.found) return;
    const WaveVector k = wave_vector(w);
    const Eigen::Matrix3d axes = frame_of_field(w, k);
    const Eigen::Vector3cd E = axes * magnetized_E(magnetized_species(w), magnetized_wave(w, k), c,
                                                   root.omega),
                           curl(-k.z * E[1], k.z * E[0] - k.x * E[2], k.x * E[1]),
                           field =
                               w.component.front() == 'E' ? E : Eigen::Vector3cd(curl / k.size());
    long largest = 0;
    E.cwiseAbs().maxCoeff(&largest);
    refuse(std::abs(field[w.component.back() - 'x']) < 1e-6 * E.norm(), wave,
           " finds a wave of frequency ", std::abs(root.omega.real()), ", which has no ",
           w.component, ": choose E_", std::string(1, "xyz"[largest]),
           " for theory.component, or change theory.near");
}
void refuse_longitudinal(const Case& w, const std::string& name) {
    refuse_kinetic(w, name);
    refuse_current(w, "theory.wave = \"" + name + "\"");
    refuse_coupled(w, "theory.wave = \"" + name + "\"", false);
    expect_longitudinal(w);
}
void refuse_transverse(const Case& w, const std::string& name) {
    refuse_kinetic(w, name);
    const UniformCase& u = w.uniform;
    const WaveVector k = wave_vector(w);
    for (const SpeciesCase& s : u.species) {
        const double T_plane = k.z == 0 ? s.temperature_z : s.temperature_x;
        refuse((u.B_x != 0 || u.B_z != 0) && s.temperature_y != T_plane, "species '", s.name,
               "' has two temperatures across uniform.B, and turns into another one: make them "
               "equal");
        if (u.B_x != 0 || u.B_z != 0) refuse_fast(w, s, "theory.wave = \"transverse\"");
    }
    refuse_current(w, "theory.wave = \"" + name + "\"");
    refuse_coupled(w, "theory.wave = \"" + name + "\"", true);
    expect_transverse(w);
}

}  // namespace

common::Complex longitudinal_dispersion_on_mesh(const Case& w, common::Complex omega) {
    const WaveVector K = mesh_wave_vector(w);
    const double S = smoothing_of_mode(w);
    common::Complex D = 1;
    for (const ImageOfMode& image : images_of_mode(w)) {
        const double weight =
            S * image.weight.cwiseProduct(Eigen::Vector3d(K.x, 0, K.z)).norm() / K.size();
        D += weight * weight * (longitudinal_answer(w, image.k, omega) - 1.0);
    }
    return D;
}

common::Complex transverse_dispersion_on_mesh(const Case& w, int sense, common::Complex omega) {
    const WaveVector k = wave_vector(w), K = mesh_wave_vector(w);
    const TransverseAnswer answer = transverse_answer(w);
    const double S = smoothing_of_mode(w);
    const Eigen::Vector3d e =
        has_E_along_y(w) ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(K.z, 0, -K.x) / K.size();
    common::Complex D = omega * omega - c * c * K.size() * K.size();
    for (const ImageOfMode& image : images_of_mode(w)) {
        const double k_m = std::copysign(image.k.size(), k.x * image.k.x + k.z * image.k.z),
                     weight = S * image.weight.cwiseProduct(e).squaredNorm();
        D += weight * answer(k_m, sense, omega, S);
    }
    return D;
}

const std::array<Wave, 6>& waves() {
    static const std::array<Wave, 6> all{
        {{"light", refuse_light, expect_light},
         {"langmuir", refuse_langmuir, expect_langmuir},
         {"cold", refuse_cold, expect_cold},
         {"magnetized", refuse_magnetized, expect_magnetized},
         {"longitudinal", refuse_longitudinal, expect_longitudinal},
         {"transverse", refuse_transverse, expect_transverse}}};
    return all;
}

const Wave* wave_of(const Case& w) {
    const auto& all = waves();
    const auto* wave = std::ranges::find(all, w.wave, &Wave::name);
    return wave == all.end() ? nullptr : wave;
}

namespace {

// Beside walls a wave has no E along them: it runs along them with E across, or stands with its nodes on them.
void refuse_beside_walls(const Case& w, const std::string& wave) {
    const UniformCase& u = w.uniform;
    const auto look = [&](const char* name, const common::Axis& axis, long mode, long other,
                          double B_along) {
        if (axis.periodic) return;
        const bool alone = mode != 0 && other == 0, in_plane = !has_E_along_y(w),
                   across = mode == 0 &&
                            (w.component == std::string("E_") + name || w.component == "B_y") &&
                            in_plane && wave != "longitudinal" && wave != "langmuir" &&
                            B_along == 0;
        refuse(!alone && !across, "theory.wave = \"", wave, "\" has E along the walls across ",
               name, ", where conductors let none be: take grid.boundary_", name,
               " = \"periodic\", or a mode along ", name, " alone");
        for (const SpeciesCase& s : u.species) {
            const bool seeds[]{s.wave_x != 0, s.wave_y != 0, s.wave_z != 0};
            const double phases[]{s.phase_x, s.phase_y, s.phase_z};
            for (std::size_t a = 0; a < 3 && alone && s.charge != 0; ++a)
                refuse(seeds[a] && std::fabs(std::cos(phases[a] * pi / 180)) > 0.01,
                       "the seed of species '", s.name, "' is no wave between the walls across ",
                       name, ", where it has no nodes: set its phase_", std::string(1, "xyz"[a]),
                       " = 90");
        }
    };
    look("x", w.grid.x, u.mode_x, u.mode_z, std::hypot(u.B_y, u.B_z));
    look("z", w.grid.z, u.mode_z, u.mode_x, std::hypot(u.B_x, u.B_y));
}

}  // namespace

void refuse_wave(const Case& w) {
    const Wave* wave = wave_of(w);
    if (wave == nullptr) return;
    refuse_beside_walls(w, wave->name);
    refuse(w.end < 10 * w.dt,
           "theory.wave needs at least 10 steps to measure: raise time.end above ", 10 * w.dt);
    refuse(w.uniform.mode_x == 0 && w.uniform.mode_z == 0,
           "theory.wave needs a mode: set uniform.mode_x or uniform.mode_z");
    wave->refuse(w, wave->name);
    const WaveVector k = wave_vector(w);
    const char axis = w.component.back();
    const bool is_longitudinal = wave->name == "longitudinal" || wave->name == "langmuir",
               has_k = (axis == 'x' && k.x != 0) || (axis == 'z' && k.z != 0),
               only_k = (axis == 'x' && k.z == 0) || (axis == 'z' && k.x == 0);
    refuse(is_longitudinal && (w.component.front() != 'E' || !has_k), "theory.wave = \"",
           wave->name, "\" has E along the mode, and theory.component = \"", w.component,
           "\" has no part along it: choose E_", (k.x != 0 ? "x" : "z"));
    refuse((wave->name == "light" || wave->name == "transverse") && only_k, "theory.wave = \"",
           wave->name, "\" has its fields across the mode, and theory.component = \"", w.component,
           "\" is along it: choose another one");
}

Eigen::Vector3d kept_components(const Case& w) {
    const UniformCase& u = w.uniform;
    const bool free_x = w.grid.x.periodic, free_z = w.grid.z.periodic;
    if ((!free_x && u.B_x != 0) || (!free_z && u.B_z != 0)) return {0, 0, 0};
    return {double(free_x), 1, double(free_z)};
}

bool charges_cancel(const Case& w) {
    double charge = 0, charges = 0;
    for (const SpeciesCase& s : w.uniform.species)
        charge += s.density * s.charge, charges += s.density * std::fabs(s.charge);
    return std::fabs(charge) <= 1e-9 * charges;
}

CommonDrift common_drift(const Case& w) {
    // In units of n0: of the drifts together, of each, and of heat.
    CommonDrift all;
    double drifts = 0, heat = 0, noise = 0;
    for (const SpeciesCase& s : w.uniform.species) {
        const Eigen::Vector3d each(s.drift_x, s.drift_y, s.drift_z);
        const double mass = s.density * s.mass,
                     T = std::max({s.temperature_x, s.temperature_y, s.temperature_z});
        all.momentum += mass * each, drifts += mass * each.norm();
        heat += mass * std::sqrt(T / s.mass), noise += mass * s.density * T;
    }
    const double cells = double(w.grid.x.cells) * double(w.grid.z.cells),
                 particles = cells * double(w.uniform.particles_per_cell);
    all.momentum = all.momentum.cwiseProduct(kept_components(w));
    all.noise = std::sqrt(noise / particles);
    const double size = all.momentum.norm();
    all.is_fast = size > 0.3 * (drifts + heat);
    all.counts = charges_cancel(w) && size > 0 &&
                 (all.is_fast || (size > 0.3 * drifts && size > 10 * all.noise));
    return all;
}

double debye_cells(const Case& w) {
    double squared = HUGE_VAL;
    for (const SpeciesCase& s : w.uniform.species) {
        const double T = std::max({s.temperature_x, s.temperature_y, s.temperature_z});
        if (s.charge != 0)
            squared = std::min(squared, T / (4 * pi * n0 * s.density * s.charge * s.charge));
    }
    return std::sqrt(squared) / std::max(w.grid.x.spacing(), w.grid.z.spacing());
}

std::string mesh_brakes(const Case& w) {
    const std::string brakes =
        "the mesh brakes the drift, for the Debye length is " + format(debye_cells(w)) + " cells: ";
    if (w.leapfrog.chosen)
        return brakes + (w.leapfrog.order == 1 || w.field.smoothing.passes < 4
                             ? "set particles.order = 2 and field.smoothing_passes = 4"
                             : "refine the mesh until it is 1");
    const UniformCase& u = w.uniform;
    const bool matrix = w.field.uses_mass_matrix(),
               in_field = u.B_x != 0 || u.B_y != 0 || u.B_z != 0,
               walls = !w.grid.x.periodic || !w.grid.z.periodic,
               behind = w.field.smoothing.passes > 0 &&
                        (w.boundary_x == "reflecting" || w.boundary_z == "reflecting");
    if (in_field && walls && (behind || !matrix))
        return (matrix ? std::string()
                       : "what moments predict beside walls takes momentum across B: set "
                         "field.response = \"mass_matrix\"" +
                             std::string(behind ? "; and " : "")) +
               (behind ? "smoothing mixes in what is behind walls that reflect: set "
                         "field.smoothing_passes = 0"
                       : "");
    return brakes +
           (!w.field.rotates_in_the_middle() && (matrix || !in_field)
                ? "take B in the middle of the step, field.B_level = \"middle\""
            : !in_field ? "lower time.dt"
            : matrix    ? "set field.response = \"moments\", and refine the mesh"
                        : "refine the mesh") +
           (drifts_near_c(w) ? "; and light that the mesh slows down takes from particles near c "
                               "(numerical Cherenkov): raise field.smoothing_passes"
                             : "");
}

bool drifts_near_c(const Case& w) {
    return std::ranges::any_of(w.uniform.species, [&](const SpeciesCase& s) {
        return mean_velocity(w, s).norm() > 0.7 * c;
    });
}

std::string cause_in_scheme(const Case& w, bool of_heat) {
    if (w.leapfrog.chosen) return "";
    double cells = 0, drift = 0;
    for (const SpeciesCase& s : w.uniform.species) {
        const Eigen::Vector3d v = mean_velocity(w, s);
        drift = std::max(drift, v.norm());
        for (const auto& [fast, T, spacing] :
             {std::tuple(v[0], s.temperature_x, w.grid.x.spacing()),
              {v[2], s.temperature_z, w.grid.z.spacing()}})
            cells = std::max(cells, (std::fabs(fast) + std::sqrt(T / s.mass)) * w.dt / spacing);
    }
    std::string cause;
    if (w.field.uses_mass_matrix() && w.field.solver != "newton_krylov" && cells > 0.5)
        cause += "particles fly " + format(cells) +
                 " cells in a step, and mass matrices are those of where they begin: set "
                 "field.solver = \"newton_krylov\", or lower time.dt; or ";
    if (!of_heat) return cause;
    if (drift > 0 && !w.field.rotates_in_the_middle())
        cause +=
            "a drift turns into heat: take B in the middle of the step, field.B_level = "
            "\"middle\"; or ";
    if (w.field.rotates_on_mesh() && !w.field.uses_mass_matrix())
        cause += "field.rotation = \"mesh\" heats: set it to \"particles\"; or ";
    return cause;
}

double exact_to(const Case& w) {
    if (w.wave == "light")
        return w.leapfrog.chosen ? 1e-9 : std::min(0.005, 100 * w.field.solved_to());
    if (w.loading != "quiet" || has_linear_splines(w)) return 0.005;
    return std::min(0.005, 0.001 + 0.03 / double(w.uniform.particles_per_cell));
}

SeededEnergy seeded_energy(const Case& w) {
    const UniformCase& u = w.uniform;
    const auto amplitude = [](double size, double degrees) {
        return std::polar(size, degrees * pi / 180);
    };
    // B in the plane is made of A_y, on the mesh.
    const WaveVector k = wave_vector(w), K = mesh_wave_vector(w);
    const double on_mesh_x = k.z != 0 ? K.z / k.z : 1, on_mesh_z = k.x != 0 ? K.x / k.x : 1;
    Eigen::VectorXcd state = Eigen::VectorXcd::Zero(place_of(u.species.size(), 0));
    state.head(6) << amplitude(u.wave_E_x, u.phase_E_x), amplitude(u.wave_E_y, u.phase_E_y),
        amplitude(u.wave_E_z, u.phase_E_z), on_mesh_x * amplitude(u.wave_B_x, u.phase_B_x),
        amplitude(u.wave_B_y, u.phase_B_y), on_mesh_z * amplitude(u.wave_B_z, u.phase_B_z);
    for (std::size_t s = 0; s < u.species.size(); ++s) {
        const SpeciesCase& one = u.species[s];
        state.segment(place_of(s, 0), 3) << amplitude(one.wave_x, one.phase_x),
            amplitude(one.wave_y, one.phase_y), amplitude(one.wave_z, one.phase_z);
    }
    const auto energy = [&] {
        double sum = state.head(6).squaredNorm() / (8 * pi);
        for (std::size_t s = 0; s < u.species.size(); ++s)
            sum += 0.5 * n0 * u.species[s].density * u.species[s].mass *
                   state.segment(place_of(s, 0), 3 * MeshOfMode::images).squaredNorm();
        return sum;
    };
    const double before = energy();
    if (!(before > 0)) return {0, 0};
    const Eigen::MatrixXcd step = cold_step(w);
    for (long n = std::lround(w.end / w.dt); n > 0; --n) state = step * state;
    // Over the plane, the square of a cosine is a half.
    return {0.5 * before / n0 * w.grid.x.length * w.grid.z.length, energy() / before - 1};
}

std::vector<Eigen::Vector3d> mean_field(const Case& w, long steps) {
    Case still = w;
    still.uniform.mode_x = still.uniform.mode_z = 0;
    const Eigen::MatrixXcd step = cold_step(still);
    Eigen::VectorXcd state = Eigen::VectorXcd::Zero(step.rows());
    state.head(3) << w.uniform.E_x, w.uniform.E_y, w.uniform.E_z;
    for (std::size_t s = 0; s < w.uniform.species.size(); ++s) {
        const SpeciesCase& one = w.uniform.species[s];
        state.segment(place_of(s, 0), 3) << one.drift_x, one.drift_y, one.drift_z;
    }
    if (w.leapfrog.chosen) take_half_step_back(still, state);
    std::vector<Eigen::Vector3d> means{state.head(3).real()};
    for (long n = 0; n < steps; ++n) {
        state = step * state;
        means.push_back(state.head(3).real());
    }
    return means;
}

}  // namespace implicit_moment
