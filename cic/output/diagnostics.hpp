// What is measured every step: energies in the pairing that is conserved, charge, and the
// amplitudes of waves.
#pragma once

#include <complex>
#include <vector>

#include "cic/setup/initial_state.hpp"

namespace cic {

/// Calls visit(node, volume) for every node; a node of a wall has half a cell, a corner a quarter.
template <class Visit>
void for_each_node(const Grid& grid, const Visit& visit) {
    const auto share = [](const common::Axis& axis, long i) {
        return !axis.periodic && (i == 0 || i == axis.cells) ? 0.5 : 1.0;
    };
    const long nx = grid.x.cells - (grid.x.periodic ? 1 : 0),
               nz = grid.z.cells - (grid.z.periodic ? 1 : 0);
    for (long j = 0; j <= nz; ++j)
        for (long i = 0; i <= nx; ++i)
            visit(grid.index(i, j), share(grid.x, i) * share(grid.z, j) * grid.cell_area());
}

/// Energy of the field, (1/2) sum_g rho_g V_g phi_g + (1/2) sum over walls of Q phi.
/// exact:  this, and not (1/2) sum E_g^2 of the field on nodes, is what the energy scheme trades
///         with the particles; with five points it equals (1/2) sum E^2 of the differences of phi
inline double field_energy(const Grid& grid, const Field& rho_g, const FieldState& field) {
    double sum = 0;
    for_each_node(grid, [&](long n, double volume) { sum += rho_g[n] * volume * field.phi[n]; });
    for (const WallName wall : {x_low, x_high, z_low, z_high}) {
        const bool along_x = wall == x_low || wall == x_high;
        if ((along_x ? grid.x : grid.z).periodic) continue;
        sum += field.walls[wall].charge * field.walls[wall].potential *
               (along_x ? grid.z : grid.x).length;
    }
    return 0.5 * sum;
}

/// Charge on the mesh, sum_g rho_g V_g.
inline double charge_on_mesh(const Grid& grid, const Field& rho_g) {
    double sum = 0;
    for_each_node(grid, [&](long n, double volume) { sum += rho_g[n] * volume; });
    return sum;
}

/// Complex amplitudes of waves exp(i k x) in the field along k,
///   E_k = -i |k| (2/N) sum_g phi_g exp(-i k x_g)
/// for wavelengths that fit into the box; in a direction with walls the mean is taken.
class FourierMode {
   public:
    /// in:     mode_x, mode_z, wavelengths in the box; k = |k|
    FourierMode(const Grid& grid, long mode_x, long mode_z, double k) : k_(k) {
        const auto table = [](const common::Axis& axis, long mode) {
            std::vector<std::complex<double>> phases;
            const long count = axis.periodic ? axis.cells : axis.cells + 1;
            for (long i = 0; i < count; ++i)
                phases.push_back(std::polar(1.0, -2 * pi * double(mode * i) / double(axis.cells)));
            return phases;
        };
        along_x_ = table(grid.x, mode_x);
        along_z_ = table(grid.z, mode_z);
    }

    /// E_k of a potential on the nodes.
    std::complex<double> amplitude(const Grid& grid, const Field& phi) const {
        std::complex<double> sum = 0;
        for (std::size_t j = 0; j < along_z_.size(); ++j) {
            std::complex<double> row = 0;
            const double* values = phi.data() + grid.index(0, long(j));
            for (std::size_t i = 0; i < along_x_.size(); ++i) row += values[i] * along_x_[i];
            sum += row * along_z_[j];
        }
        const double nodes = double(along_x_.size() * along_z_.size());
        return sum * std::complex<double>(0, -2 * k_ / nodes);
    }

   private:
    double k_;
    std::vector<std::complex<double>> along_x_, along_z_;
};

}  // namespace cic
