#pragma once

#include <Eigen/Core>

#include <limits>

namespace doppel {

/// A point of an N-dimensional phase space (Eigen::Dynamic = known only at run time). Every model's state consists of
/// its coordinates and their rates: (q, v) with q′ = v.
template <class Scalar, int N>
using State = Eigen::Matrix<Scalar, N, 1>;

/// N · factor; N may be Eigen::Dynamic.
template <int factor, int N>
inline constexpr int times = N == Eigen::Dynamic ? Eigen::Dynamic : factor* N;

/// N for native arithmetic, otherwise Eigen::Dynamic: quads are library calls, for which fixed sizes are not worth
/// compiling.
template <class Scalar, int N>
inline constexpr int compiled_size = std::numeric_limits<Scalar>::digits > 53 ? Eigen::Dynamic : N;

/// π to the precision of the scalar.
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
