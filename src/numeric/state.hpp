#pragma once

#include <Eigen/Core>

namespace doppel {

/// A point of a phase space of fixed size N; what integrators add and scale.
template <class Scalar, int N>
using State = Eigen::Matrix<Scalar, N, 1>;

/// Sine and cosine of the same angle.
template <class Scalar>
struct SinCos {
    Scalar sin, cos;

    explicit SinCos(const Scalar& angle) {
        using std::cos;
        using std::sin;
        this->sin = sin(angle);
        this->cos = cos(angle);
    }
};

inline constexpr double pi = 3.14159265358979323846;
constexpr double radians(double degrees) {
    return degrees * (pi / 180);
}

}  // namespace doppel
