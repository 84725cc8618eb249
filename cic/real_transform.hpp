// Fourier transforms of real numbers along one periodic direction of the mesh.
#pragma once

#include <gsl/gsl_fft_halfcomplex.h>
#include <gsl/gsl_fft_real.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "cic/particles.hpp"

namespace cic {

/// Fourier transforms of real rows of one length, in place. A row f becomes the coefficients
/// f_0, Re f_1, Im f_1, Re f_2, ...: a real basis in which every even difference operator is
/// diagonal.
class RealTransform {
   public:
    /// in:     length of the rows
    explicit RealTransform(long length)
        : length_(length),
          forward_(gsl_fft_real_wavetable_alloc(length_), gsl_fft_real_wavetable_free),
          backward_(gsl_fft_halfcomplex_wavetable_alloc(length_),
                    gsl_fft_halfcomplex_wavetable_free) {}

    /// Every row to its coefficients, and back.
    /// in/out: rows of values(:, j) for all j, or the same backwards with the factor 1/length; one
    ///         number stays as it is
    void forward(Eigen::MatrixXd& values) const {
        for_each_row(values, [&](double* row, gsl_fft_real_workspace* work) {
            gsl_fft_real_transform(row, 1, length_, forward_.get(), work);
        });
    }
    void backward(Eigen::MatrixXd& values) const {
        for_each_row(values, [&](double* row, gsl_fft_real_workspace* work) {
            gsl_fft_halfcomplex_inverse(row, 1, length_, backward_.get(), work);
        });
    }

    /// K^2 = (2/dx sin(k dx/2))^2 of coefficient m: what -delta_xx multiplies it by.
    static double minus_delta(const common::Axis& axis, long m) {
        const double angle = 2 * pi * double((m + 1) / 2) / double(axis.cells);
        const double K = 2 / axis.spacing() * std::sin(0.5 * angle);
        return K * K;
    }

   private:
    template <class Transform>
    void for_each_row(Eigen::MatrixXd& values, const Transform& transform) const {
        if (length_ == 1) return;
        common::for_each_block(values.cols(), [&](int, long begin, long end) {
            const std::unique_ptr<gsl_fft_real_workspace, void (*)(gsl_fft_real_workspace*)> work(
                gsl_fft_real_workspace_alloc(length_), gsl_fft_real_workspace_free);
            for (long j = begin; j < end; ++j) transform(values.col(j).data(), work.get());
        });
    }

    std::size_t length_;
    std::unique_ptr<gsl_fft_real_wavetable, void (*)(gsl_fft_real_wavetable*)> forward_;
    std::unique_ptr<gsl_fft_halfcomplex_wavetable, void (*)(gsl_fft_halfcomplex_wavetable*)>
        backward_;
};

}  // namespace cic
