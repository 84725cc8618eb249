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
    explicit RealTransform(long length)
        : length_(static_cast<std::size_t>(length)),
          forward_(gsl_fft_real_wavetable_alloc(length_), gsl_fft_real_wavetable_free),
          backward_(gsl_fft_halfcomplex_wavetable_alloc(length_),
                    gsl_fft_halfcomplex_wavetable_free) {}

    /// in/out: rows of values(:, j) for all j, or the same backwards with the factor 1/length.
    void forward(Eigen::MatrixXd& values) const {
        common::for_each_block(values.cols(), [&](int, long begin, long end) {
            const Workspace work(length_);
            for (long j = begin; j < end; ++j)
                gsl_fft_real_transform(values.col(j).data(), 1, length_, forward_.get(),
                                       work.get());
        });
    }
    void backward(Eigen::MatrixXd& values) const {
        common::for_each_block(values.cols(), [&](int, long begin, long end) {
            const Workspace work(length_);
            for (long j = begin; j < end; ++j)
                gsl_fft_halfcomplex_inverse(values.col(j).data(), 1, length_, backward_.get(),
                                            work.get());
        });
    }

    /// K^2 = (2/dx sin(k dx/2))^2 of coefficient m: what -delta_xx multiplies it by.
    static double minus_delta(const common::Axis& axis, long m) {
        const double angle =
            2 * pi * static_cast<double>((m + 1) / 2) / static_cast<double>(axis.cells);
        const double K = 2 / axis.spacing() * std::sin(0.5 * angle);
        return K * K;
    }

   private:
    struct Workspace {
        explicit Workspace(std::size_t n) : room(gsl_fft_real_workspace_alloc(n), &free_it) {}
        gsl_fft_real_workspace* get() const { return room.get(); }
        static void free_it(gsl_fft_real_workspace* w) { gsl_fft_real_workspace_free(w); }
        std::unique_ptr<gsl_fft_real_workspace, void (*)(gsl_fft_real_workspace*)> room;
    };
    std::size_t length_;
    std::unique_ptr<gsl_fft_real_wavetable, void (*)(gsl_fft_real_wavetable*)> forward_;
    std::unique_ptr<gsl_fft_halfcomplex_wavetable, void (*)(gsl_fft_halfcomplex_wavetable*)>
        backward_;
};

}  // namespace cic
