#pragma once

#include <Eigen/Core>

#include <limits>

namespace doppel {

/// A point of a phase space of N dimensions (Eigen::Dynamic = known only at run time); what integrators add and scale.
/// Every model's state is its coordinates, then their rates: (q, v) with q′ = v.
template <class Scalar, int N>
using State = Eigen::Matrix<Scalar, N, 1>;

/// N · factor, where N may be Eigen::Dynamic.
template <int factor, int N>
inline constexpr int times = N == Eigen::Dynamic ? Eigen::Dynamic : factor* N;

/// N for what the processor computes with; quads are library calls, for which no size is worth compiling.
template <class Scalar, int N>
inline constexpr int compiled_size = std::numeric_limits<Scalar>::digits > 53 ? Eigen::Dynamic : N;

/// π to the digits of the scalar: acos(−1), which every scalar knows.
template <class Scalar>
Scalar pi_of() {
    using std::acos;
    return acos(Scalar(-1));
}

inline constexpr double pi = 3.14159265358979323846;
constexpr double radians(double degrees) {
    return degrees * (pi / 180);
}

}  // namespace doppel
