// What the programs call of FFTW, which has no package for the browser, by the transforms that come with
// Eigen: slower, and the same numbers to round-off.
#pragma once

#include <complex>
#include <unsupported/Eigen/FFT>

enum { FFTW_FORWARD = -1, FFTW_BACKWARD = 1, FFTW_ESTIMATE = 64 };

namespace instead {

template <class Real>
struct Plan {
    int count, sign;
};

template <class Real>
Eigen::FFT<Real>& transform() {
    static Eigen::FFT<Real> one(typename Eigen::FFT<Real>::impl_type(),
                                typename Eigen::FFT<Real>::Flag(Eigen::FFT<Real>::Unscaled |
                                                                Eigen::FFT<Real>::HalfSpectrum));
    return one;
}

template <class Real>
std::complex<Real>* numbers(Real (*pairs)[2]) {
    return reinterpret_cast<std::complex<Real>*>(pairs);
}

// One transform of rank 1, as the programs plan them; what the arrays are is said again when it runs.
template <class Real, class From, class To>
Plan<Real>* plan(int, const int* n, int, From*, const int*, int, int, To*, const int*, int, int,
                 int sign, unsigned) {
    return new Plan<Real>{*n, sign};
}
template <class Real, class From, class To>
Plan<Real>* plan_real(int, const int* n, int, From*, const int*, int, int, To*, const int*, int,
                      int, unsigned) {
    return new Plan<Real>{*n, 0};
}
template <class Real>
void run(Plan<Real>* p, Real (*from)[2], Real (*to)[2]) {
    if (p->sign < 0)
        transform<Real>().fwd(numbers(to), numbers(from), p->count);
    else
        transform<Real>().inv(numbers(to), numbers(from), p->count);
}
template <class Real>
void run_real(Plan<Real>* p, Real* from, Real (*to)[2]) {
    transform<Real>().fwd(numbers(to), from, p->count);
}
template <class Real>
void run_back(Plan<Real>* p, Real (*from)[2], Real* to) {
    transform<Real>().inv(to, numbers(from), p->count);
}
template <class Real>
void destroy(Plan<Real>* p) {
    delete p;
}

}  // namespace instead

inline constexpr auto fftw_plan_many_dft = instead::plan<double, double[2], double[2]>;
inline constexpr auto fftw_plan_many_dft_r2c = instead::plan_real<double, double, double[2]>;
inline constexpr auto fftw_plan_many_dft_c2r = instead::plan_real<double, double[2], double>;
inline constexpr auto fftw_execute_dft = instead::run<double>;
inline constexpr auto fftw_execute_dft_r2c = instead::run_real<double>;
inline constexpr auto fftw_execute_dft_c2r = instead::run_back<double>;
inline constexpr auto fftw_destroy_plan = instead::destroy<double>;
inline constexpr auto fftwf_plan_many_dft = instead::plan<float, float[2], float[2]>;
inline constexpr auto fftwf_plan_many_dft_r2c = instead::plan_real<float, float, float[2]>;
inline constexpr auto fftwf_plan_many_dft_c2r = instead::plan_real<float, float[2], float>;
inline constexpr auto fftwf_execute_dft = instead::run<float>;
inline constexpr auto fftwf_execute_dft_r2c = instead::run_real<float>;
inline constexpr auto fftwf_execute_dft_c2r = instead::run_back<float>;
inline constexpr auto fftwf_destroy_plan = instead::destroy<float>;
