// A wave on the mesh: what its differences see of k, and what splines and smoothing make of a mode on its way
// from field to particles and, with their current, back.
#pragma once

#include <cmath>
#include <vector>

#include "implicit_moment/field/smooth.hpp"
#include "implicit_moment/setup/case.hpp"

namespace implicit_moment {

/// The wave vector of the seeded mode.
struct WaveVector {
    double x, z;
    double size() const { return std::hypot(x, z); }
};
inline WaveVector wave_vector(const Case& w) {
    return {2 * pi * double(w.uniform.mode_x) / w.grid.x.length,
            2 * pi * double(w.uniform.mode_z) / w.grid.z.length};
}

/// What the differences of the mesh see of it: K = (2/dx) sin(k dx/2).
inline WaveVector mesh_wave_vector(const Case& w) {
    const WaveVector k = wave_vector(w);
    const double dx = w.grid.x.spacing(), dz = w.grid.z.spacing();
    return {2 / dx * std::sin(0.5 * k.x * dx), 2 / dz * std::sin(0.5 * k.z * dz)};
}

/// Whether the charge has the spline of order l = 1; else it is 2.
inline bool has_linear_splines(const Case& w) { return w.leapfrog.chosen && w.leapfrog.order == 1; }

/// What smoothing leaves of E on its way to particles, and of J on its way back.
inline double smoothing_of_mode(const Case& w) {
    const WaveVector k = wave_vector(w);
    return smoothing_factor(w.field.smoothing, k.x * w.grid.x.spacing()) *
           smoothing_factor(w.field.smoothing, k.z * w.grid.z.spacing());
}

/// One of the waves that particles feel of a mode of the mesh.
struct ImageOfMode {
    WaveVector k;            // of the mode, and 2 pi m/dx more
    Eigen::Vector3d weight;  // by component
};

/// The mode and its images: where E_a is 1 on its places, particles feel sum_m weight_a(m) exp(i k_m x), and with
/// these weights they carry current.
///     weight_y = [sin(k_m dx/2) / (k_m dx/2)]^(l+1),   weight_x = (k_m,x / K_x) weight_y, with one power less
/// exact:  curl and gather commute; the sum of weight weight^T is the overlap of splines to 2e-4 with six cells in a
///         wave: the last images, |m| = 4, stand also for those beyond where these fall as 1/m^2.
inline std::vector<ImageOfMode> images_of_mode(const Case& w) {
    const WaveVector k = wave_vector(w), K = mesh_wave_vector(w);
    const int last = 4;
    // The same along each direction; a mode without k there has no images.
    struct Part {
        double k_m, across, along;
    };
    const auto parts = [&](double k_n, double K_n, double spacing) {
        if (k_n == 0) return std::vector<Part>{{0, 1, 1}};
        std::vector<Part> all;
        for (int m = -last; m <= last; ++m) {
            const double k_m = k_n + 2 * pi * m / spacing, angle = 0.5 * k_m * spacing,
                         r = std::fabs(angle) / pi,
                         beyond = has_linear_splines(w) && std::abs(m) == last
                                      ? r / std::sqrt(r - 0.5)
                                      : 1,
                         across = std::pow(std::sin(angle) / angle, has_linear_splines(w) ? 2 : 3);
            all.push_back({k_m, across, across * beyond * k_m / K_n});
        }
        return all;
    };
    std::vector<ImageOfMode> images;
    for (const Part& x : parts(k.x, K.x, w.grid.x.spacing()))
        for (const Part& z : parts(k.z, K.z, w.grid.z.spacing())) {
            const Eigen::Vector3d weight(x.along * z.across, x.across * z.across,
                                         x.across * z.along);
            if (weight.norm() > 1e-3) images.push_back({{x.k_m, z.k_m}, weight});
        }
    return images;
}

}  // namespace implicit_moment
