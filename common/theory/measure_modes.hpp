// Frequencies, damping and growth measured from the history of a run, with their errors.
//
// A record of small amplitude is a sum of complex exponentials and noise,
//     z_n = sum_j a_j exp(-i omega_j n dt) + noise
// and one that seems to beat, to stand or to travel is several of them.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

namespace common {

/// One of the exponentials a exp(-i omega (t - begin)); Im omega is a growth rate.
struct Mode {
    std::complex<double> omega = 0;
    std::complex<double> error = 0;      // of Re omega and of Im omega: 95 of 100 are nearer
    std::complex<double> amplitude = 0;  // at the first sample of the record
    double share = 0;                    // of the energy of the record, sum |a|^2 over sum |z|^2
    double evidence = 0;  // by how much the rest would grow without it, over its variance
};

/// The exponentials of a record, the one with the largest share first.
struct ModeList {
    std::vector<Mode> modes;
    double noise = 0;    // rms of what is none of them, over the rms of the record
    std::string reason;  // why there are none; empty when there are
};

/// Finds the exponentials by ESPRIT, then improves them by least squares.
///   1. singular vectors V of the Hankel matrix Z_ij = z_(i+j); the p largest span the exponentials
///   2. exp(-i omega_j dt) = eigenvalues of V_1^+ V_2, V without its last and without its first row
///   3. Gauss and Newton on sum |z - model|^2 in all omega_j and a_j
///   4. of p = 1 ... most, no two omega_j closer than 1 over the length of the record, the one with the
///      least 2 N ln(sum |z - model|^2) + 12 p ln 2N; the noise of particles has a color, and costs
///      modes three times what white noise does
/// in:     z, evenly sampled, dt apart, at most a few hundred; most, how many exponentials at most
/// out:    errors from the covariance of step 3 and of the noise, which is what the model leaves and
///         other modes of less than a twentieth of the energy and 100 times the noise; and from how
///         far a mode is in models of another p that leave at most four times as much
/// exact:  without noise, to round-off, where omega dt is below pi and modes differ
/// source: Roy and Kailath, IEEE Trans. ASSP 37, 984 (1989); Hua and Sarkar, ibid. 38, 814 (1990);
///         step 4: Schwarz, Ann. Statist. 6, 461 (1978)
ModeList find_modes(std::span<const std::complex<double>> z, double dt, int most = 8);

/// What a measurement looks for, and where.
struct ModeSearch {
    std::vector<std::complex<double>> expected;  // roots of theory, of which one is looked for
    double begin = 0;                            // when the transient of the start is over
    double end = 1e300;                          // when the linear phase is
    double below_maximum = 1;  // a growing record ends where it reaches this part of its maximum
    double e_foldings = 3, periods = 3;  // of growth or damping, or of swinging: either is enough
    std::string faded = "it is lost in noise then: raise its amplitude";  // of what decays, a cure
};

/// The mode of a record that is nearest to theory.
struct MeasuredMode {
    std::complex<double> omega = 0, error = 0;  // as in Mode
    double begin = 0, end = 0;                  // the window in time
    double share = 0;  // of the energy: of the mode and of the one that runs against it
    bool found = false;
    bool over = false;  // what grows came to below_maximum so early that it has ended since
    bool high = false;  // what grows begins above below_maximum, so that its window has no such end
    std::string reason;  // "cannot be measured, because ..."; empty when found
    std::string window;  // in words: from when to when, and what else was seen

    /// Growth, and its error, where one is negative the other way round.
    double growth() const { return omega.imag(); }
    double growth_error() const { return error.imag(); }
    double frequency() const { return std::abs(omega.real()); }
    double frequency_error() const { return error.real(); }
};

/// Measures the mode that theory expects.
///   window: from search.begin to search.end; what grows ends before, where it comes to below_maximum
///           of its largest value, and what decays where noise is left; of a long record as many
///           periods, or 8 e-foldings, as tell most; many samples per period averaged to fewer
///   answer: of the modes with evidence the one nearest to a root of theory, and the mean of its two
///           directions; one without a turn and without an e-folding in the window is what stays at
///           rest, and none
///   error:  from the squares of: the covariance, the spread of the same mode over parts of the
///           window, and how far its two directions disagree
/// in:     times, evenly spaced; z, the complex amplitude of a mode, in which both directions of
///         travel are modes of their own, or a real signal
/// out:    not found, with the reason: no signal, only noise, too few samples, periods or
///         e-foldings, a value that is not finite
MeasuredMode measure_mode(std::span<const double> times, std::span<const std::complex<double>> z,
                          const ModeSearch& search);

/// The same of a real signal.
MeasuredMode measure_mode(std::span<const double> times, std::span<const double> y,
                          const ModeSearch& search);

}  // namespace common
