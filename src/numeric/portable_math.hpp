#pragma once

#include <cmath>

namespace doppel {

// Functions of double that give the same bits on every processor and with every C library, because they only use + − ×
// ÷. They are used for numbers in tables, and for decisions of methods. Sine and cosine: numeric/sin_cos.hpp.

/// Natural logarithm within 1 ulp; −∞ for 0, NaN for negative numbers.
double portable_log(double x);

/// e^x within 1 ulp; 0 where it is less than 1e-307.
double portable_exp(double x);

/// x^y for x > 0, within 1 + |y log x| ulp, where the last digit does not matter.
double portable_pow(double x, double y);

/// The angle of (x, y) from the x axis, rad, in (−π, π], within 1.5 ulp. Zeros and infinities are treated as in the C
/// library.
double portable_atan2(double y, double x);

/// For any other scalar, its own atan2.
template <class Scalar>
Scalar portable_atan2(const Scalar& y, const Scalar& x) {
    using std::atan2;
    return atan2(y, x);
}

}  // namespace doppel
