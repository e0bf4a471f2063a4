#pragma once

#include <cmath>

namespace doppel {

// Functions of double whose bits are the same on every processor and with every C library: from + − × ÷ alone. What a
// table holds, or a step of a method goes by, is computed with them. Sine and cosine: numeric/sin_cos.hpp.

/// Natural logarithm within 1 ulp; −∞ of 0, NaN of what is negative.
double portable_log(double x);

/// e^x within 1 ulp; 0 where it is less than 1e-307.
double portable_exp(double x);

/// x^y for x > 0, within 1 + |y log x| ulp: for what needs no last digit.
double portable_pow(double x, double y);

/// The angle of (x, y) from the x axis, rad, within (−π, π] and 1.5 ulp. Zeros and infinities: as the C library does.
double portable_atan2(double y, double x);

/// The same for any other scalar: its own.
template <class Scalar>
Scalar portable_atan2(const Scalar& y, const Scalar& x) {
    using std::atan2;
    return atan2(y, x);
}

}  // namespace doppel
