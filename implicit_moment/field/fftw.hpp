// The functions of FFTW, which has them for every precision under other names.
#pragma once

#include <fftw3.h>

namespace implicit_moment {

/// Plans and runs of one-dimensional transforms: complex, from real numbers, and back to them.
template <class Real>
struct Fftw;
template <>
struct Fftw<double> {
    static constexpr auto plan = fftw_plan_many_dft;
    static constexpr auto plan_real = fftw_plan_many_dft_r2c;
    static constexpr auto plan_back = fftw_plan_many_dft_c2r;
    static constexpr auto run = fftw_execute_dft;
    static constexpr auto run_real = fftw_execute_dft_r2c;
    static constexpr auto run_back = fftw_execute_dft_c2r;
    static constexpr auto destroy = fftw_destroy_plan;
};
template <>
struct Fftw<float> {
    static constexpr auto plan = fftwf_plan_many_dft;
    static constexpr auto plan_real = fftwf_plan_many_dft_r2c;
    static constexpr auto plan_back = fftwf_plan_many_dft_c2r;
    static constexpr auto run = fftwf_execute_dft;
    static constexpr auto run_real = fftwf_execute_dft_r2c;
    static constexpr auto run_back = fftwf_execute_dft_c2r;
    static constexpr auto destroy = fftwf_destroy_plan;
};

}  // namespace implicit_moment
