// The waves of a uniform plasma. Each that theory.wave can name is one object: its name, what it needs,
// and what theory expects of the seeded mode.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <string>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "implicit_moment/setup/case.hpp"

namespace implicit_moment {

/// What theory says about the seeded mode: complex frequency omega + i gamma, and where it comes
/// from.
struct Theory {
    std::complex<double> omega;
    std::string source;
    bool of_scheme = false;  // exact for the scheme at this dt, not for dt -> 0
    common::DispersionRoot without_mesh = {};
};

/// A wave of theory.wave.
struct Wave {
    std::string name;
    void (*refuse)(const Case&, const std::string& name);  // what it needs; throws InputError
    Theory (*expect)(const Case&);
};

/// All that theory.wave can name, beside "none".
const std::array<Wave, 6>& waves();

/// The wave that a case is compared with, or none. in: parameters of a case
const Wave* wave_of(const Case& w);

/// Refuses a case that the wave it names cannot be compared with.
/// errors: InputError with the cure, also where its dispersion relation has no root.
void refuse_wave(const Case& w);

/// Which components of the momentum of a uniform plasma are kept, 1 or 0: none of those through a wall, and along walls
/// all, for E_t = 0 and B_n = 0 on a conductor leave no stress E_n E_t + B_n B_t there; none where B crosses a wall.
Eigen::Vector3d kept_components(const Case& w);

/// Whether the charges of species cancel, so that none is fixed.
bool charges_cancel(const Case& w);

/// What species that drift have together, per area [m_i c n0].
struct CommonDrift {
    Eigen::Vector3d momentum = {0, 0, 0};  // by kept_components()
    double noise = 0;                      // that heat gives so many particles, by chance
    bool counts = false;   // charges cancel, and it is above drifts that do, and noise
    bool is_fast = false;  // above a third of all that moves
};
CommonDrift common_drift(const Case& w);

/// The shortest Debye length of what has a charge, in cells.
double debye_cells(const Case& w);

/// Why the mesh brakes a uniform plasma that drifts as a whole, with the cure.
std::string mesh_brakes(const Case& w);

/// Whether a species drifts with more than 0.7 c.
bool drifts_near_c(const Case& w);

/// What in the scheme of implicit_moment brakes a uniform plasma that nothing drives or, if asked for heat, heats it,
/// with its cure and "; or "; empty where there is nothing.
std::string cause_in_scheme(const Case& w, bool of_heat);

/// How exact a wave is for which theory is the scheme: without particles to what the solver leaves, and with them
/// to what their unevenness within a cell does, which falls as 1/particles_per_cell in a quiet start.
/// note:   the field of linear splines jumps between cells, so that a wave is linear only while its particles move
///         by less than a hundredth of a cell.
double exact_to(const Case& w);

/// The kinetic dispersion relation of longitudinal waves on the mesh of a case.
///     D = 1 + S^2 sum_m |weight(m) K|^2/K^2 chi(k_m)
common::Complex longitudinal_dispersion_on_mesh(const Case& w, common::Complex omega);

/// That of transverse waves, of one sense of rotation about B.
///     D = omega^2 - c^2 K^2 + S sum_m |weight(m) e|^2 omega^2 chi(k_m), e across K
/// note:   an image at an angle to k answers as one along it.
common::Complex transverse_dispersion_on_mesh(const Case& w, int sense, common::Complex omega);

/// The energy of the seeded mode in a cold plasma at rest [that of history.dat], and by which part the steps of a run
/// change it: by the linear step of implicit_moment, with all waves that the seed excites.
struct SeededEnergy {
    double at_start, change;
};
SeededEnergy seeded_energy(const Case& w);

/// Mean E of the scheme after each of so many steps.
///     dE/dt = -4 pi sum n q u,   du/dt = q/m (E + u x B/c)
/// exact:  whatever the temperatures: the mean of all forces of a uniform field is that on the mean
std::vector<Eigen::Vector3d> mean_field(const Case& w, long steps);

}  // namespace implicit_moment
