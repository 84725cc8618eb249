// Stiffened gases, and what several of them have in common in one cell: the pressure.
//
//     p = (gamma - 1) rho e - gamma p_infinity        c^2 = gamma (p + p_infinity)/rho
//
// With p_infinity = 0 this is the gamma law of a gas. With a large one it is the simplest liquid or
// metal: stiff, and able to have a surface, because its pressure falls to zero at a density that
// is not zero. A particle that carries its volume may hold some tension, a pressure down to -tension,
// which is above -p_infinity. Cells hold none: they cannot tell a liquid that is stretched from one
// that does not fill them; there p = 0.
#pragma once

#include <algorithm>
#include <span>
#include <string>

namespace flip {

/// One material; gamma = 1 is dust, without pressure.
struct Material {
    std::string name;
    double gamma = 1.4;
    double p_infinity = 0;
    double tension = 0;  // the largest; below p_infinity
};

/// Pressure of density rho and specific internal energy e, not below the largest tension.
inline double pressure(const Material& a, double rho, double e) {
    return std::max(-a.tension, (a.gamma - 1) * rho * e - a.gamma * a.p_infinity);
}

/// rho c^2, the modulus of an adiabatic change of volume.
inline double stiffness(const Material& a, double p) { return a.gamma * (p + a.p_infinity); }

/// Below this rho c^2 a compressibility would overflow: that of dust, and of a gas
/// without energy.
inline constexpr double least_stiffness = 1e-200;

/// -dV/dp of a volume V at constant entropy.
///   V / (rho c^2)
/// out:    0 below least_stiffness: such a material takes no part in the pressure of a cell, and its
///         volume stays
inline double compliance(const Material& a, double V, double p) {
    const double K = stiffness(a, p);
    return K > least_stiffness ? V / K : 0;
}

/// The weight of a particle in the pressure of its cell, and in how it shares a change of volume.
///   V/K among several fluids, which yield to one pressure, and in slow flow;  V in one fluid with an
///   explicit pressure, which is strained alike
/// note:   by V/K a cold particle would take all that its hot neighbors leave, and the work of that has
///         no bound; but air beside water has to take all of it
inline double weight_in_cell(const Material& a, double V, double p, bool one_fluid) {
    const double C = compliance(a, V, p);
    return one_fluid && C > 0 ? V : C;
}

/// Specific internal energy at density rho and pressure p.
/// note:   dust has no pressure; there p stands for rho e
inline double internal_energy(const Material& a, double rho, double p) {
    return a.gamma == 1 ? p / rho : (p + a.gamma * a.p_infinity) / ((a.gamma - 1) * rho);
}

/// How the materials of one cell share it.
struct CellState {
    double p = 0;                // their common pressure
    double compressibility = 0;  // -(dV/dp)/V at constant entropy of each; 0 in an empty cell
    bool surface = false;        // the materials do not fill the cell: p = 0
};

/// Materials that one cell can hold.
inline constexpr std::size_t most_materials = 8;

/// The pressure at which all materials together fill a cell.
///   sum_k V_k = V,   V_k = (gamma_k - 1) U_k / (p + gamma_k p_infinity_k)
/// in:     U[k], internal energy of material k in the cell; M[k], its mass
/// out:    share[k] of a change of the volume of the cell that material k takes at common pressure,
///         V_k/(gamma_k (p + p_infinity_k)) relative to their sum
/// exact:  for gases the sum of partial pressures; shares sum to 1 in a cell that is not empty
/// note:   Newton's method starts from the largest pressure that one material alone would have: the
///         sum is convex and falls, so no step goes beyond the root
inline CellState find_equilibrium(std::span<const Material> materials, const double* M,
                                  const double* U, double V, double* share) {
    const std::size_t count = materials.size();
    CellState cell;
    const double per_V = 1 / V;
    double p = 0, mass = 0;
    int sharing = 0;  // materials that have energy
    for (std::size_t k = 0; k < count; ++k) {
        const Material& a = materials[k];
        mass += M[k];
        sharing += U[k] > 0 ? 1 : 0;
        p = std::max(p, (a.gamma - 1) * U[k] * per_V - a.gamma * a.p_infinity);
    }
    const auto volume_of = [&](std::size_t k, double at) {
        const Material& a = materials[k];
        const double stiff = at + a.gamma * a.p_infinity;
        return U[k] != 0 && stiff > 0 ? (a.gamma - 1) * U[k] / stiff : 0.0;
    };
    if (mass <= 0) {
        std::fill(share, share + count, 0.0);
        return cell;
    }
    if (sharing > 1) {
        for (int n = 0; n < 50; ++n) {
            double sum = -V, slope = 0;
            for (std::size_t k = 0; k < count; ++k) {
                const double V_k = volume_of(k, p);
                sum += V_k;
                if (V_k > 0) slope += V_k / (p + materials[k].gamma * materials[k].p_infinity);
            }
            if (!(sum > 1e-15 * V) || slope == 0) break;
            p += sum / slope;
        }
    }
    cell.p = p;

    // A material that nothing can compress, dust, and a gas below least_stiffness take no part in a
    // change of volume; where there is nothing else, shares go by mass.
    double filled = 0, sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double V_k = volume_of(k, p), stiff = stiffness(materials[k], p);
        filled += V_k;
        share[k] = V_k != 0 && stiff > least_stiffness ? V_k / stiff : 0.0;
        sum += share[k];
    }
    cell.surface = p == 0 && filled < V;
    cell.compressibility = sum * per_V;
    for (std::size_t k = 0; k < count; ++k) share[k] = sum > 0 ? share[k] / sum : M[k] / mass;
    return cell;
}

}  // namespace flip
