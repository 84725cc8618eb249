// The energy of the field that a warm plasma of particles always has.
#pragma once

#include <cmath>

#include "cic/units.hpp"

namespace cic {

/// Energy of the field in a plasma in thermal equilibrium, per kinetic energy.
///   (1/N_c N) sum_(k /= 0) A / (A + K^2 lambda_D^2),   A = sum_p S(k_p)^2
/// in:     lambda_D/dx; N_c particles per cell; N cells; order of the weights
/// exact:  for the energy-conserving scheme, in the limit of many particles in a Debye length: each
///         of N modes has T/2, screened; [CIC-1] leaves A of the noise of points
/// note:   The momentum scheme comes close where the Debye length is resolved. A has a closed form:
///         1 for ngp, (2 + C)/3 for cic, (33 + 26 C + cos 2 k dx)/60 for tsc, C = cos k dx. For
///         points and a continuous field the sum is arctan(pi l) / (pi l N_c), l = lambda_D/dx.
inline double thermal_noise(double debye_over_dx, double per_cell, long cells, int order) {
    double sum = 0;
    for (long m = 1; m < cells; ++m) {
        const double theta = 2 * pi * static_cast<double>(m) / static_cast<double>(cells);
        const double K2 = 2 - 2 * std::cos(theta);
        const double A = order == 0   ? 1
                         : order == 1 ? (2 + std::cos(theta)) / 3
                                      : (33 + 26 * std::cos(theta) + std::cos(2 * theta)) / 60;
        sum += A / (A + K2 * debye_over_dx * debye_over_dx);
    }
    return sum / (per_cell * static_cast<double>(cells));
}

}  // namespace cic
