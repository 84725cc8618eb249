// The Fourier mode along x that a comparison tracks.
#pragma once

#include <complex>

#include "common/theory/measure_modes.hpp"
#include "flip/theory/comparison.hpp"

namespace flip {

/// The tracked wave number.
///   k = 2 pi mode/length_x
inline double tracked_wave_number(const Case& parameters) {
    return 2 * pi * double(parameters.mode) / parameters.grid.x.length;
}

/// Refuses a mesh that has no such mode, and a region whose flow has another.
inline void validate_mode(const Case& parameters, const Refusal& refuse, const std::string& flow) {
    refuse(!parameters.grid.x.periodic, " needs periodic ends in x");
    refuse(2 * parameters.mode >= parameters.grid.x.cells,
           " follows theory.mode = ", parameters.mode, ", and ", parameters.grid.x.cells,
           " cells have no waves above ", (parameters.grid.x.cells - 1) / 2,
           ": refine the mesh or lower it");
    for (const RegionCase& r : parameters.regions)
        refuse(r.flow == flow && r.mode != parameters.mode,
               " follows theory.mode = ", parameters.mode, ", and region.", r.name,
               ".mode = ", r.mode, ": make them the same");
}

/// Fourier amplitude along x of rows j_low <= j < j_high of a field, its phase that at x = from.
///   (2/N) sum f exp(-i k (x - from))
inline std::complex<double> mode_of(const Case& parameters, const Field& f, long j_low, long j_high,
                                    double from) {
    const double k = tracked_wave_number(parameters);
    std::complex<double> sum = 0;
    for (long j = j_low; j < j_high; ++j)
        for (long i = 0; i < parameters.grid.x.cells; ++i)
            sum += f[parameters.grid.index(i, j)] *
                   std::polar(1.0, -k * (middle(parameters.grid.x, i) - from));
    return 2.0 / double(parameters.grid.x.cells * (j_high - j_low)) * sum;
}

/// Measures a mode from a record at the times of the steps, which follow the flow: it is read at even
/// times, between neighbors.
/// in:     at least two rows
template <class Value>
common::MeasuredMode measure_between_steps(const std::vector<double>& times,
                                           const std::vector<Value>& mode,
                                           const common::ModeSearch& search) {
    std::vector<double> even_times;
    std::vector<Value> even;
    const std::size_t samples = std::min<std::size_t>(times.size(), 2000);
    for (std::size_t n = 0, at = 0; n < samples; ++n) {
        const double t = times.back() * double(n) / double(samples - 1);
        while (at + 2 < times.size() && times[at + 1] < t) ++at;
        const double part = (t - times[at]) / (times[at + 1] - times[at]);
        even_times.push_back(t);
        even.push_back(mode[at] + part * (mode[at + 1] - mode[at]));
    }
    return common::measure_mode(even_times, even, search);
}

}  // namespace flip
