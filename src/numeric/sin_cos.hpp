#pragma once

#include "numeric/lanes.hpp"

#include <cmath>
#include <type_traits>

namespace doppel {

/// Sine and cosine of the same angle. For double and lanes they have the same bits on every processor, at every width
/// and with every C library (up to an angle of 10⁵ rad). Other scalars use their own functions.
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

/// Larger angles, rad, are left to the C library; up to here the products with n below are exact.
inline constexpr double largest_reduced_angle = 1e5;

/// For |angle| ≤ largest_reduced_angle: within 0.8 ulp, from + − × alone; sine is exactly odd (except for the sign of
/// zero), cosine exactly even.
///
///     angle = n π/2 + r + tail,   |r| ≤ π/4,   π/2 in three parts whose products with n are exact
///
/// Source  the polynomials of fdlibm's k_sin.c and k_cos.c (Sun Microsystems 1993)
template <class Doubles, class Masks>
[[gnu::always_inline]] inline void sin_cos_of(const Doubles& angle, Doubles& sine, Doubles& cosine) {
    // the last bits of `shifted` are those of n
    constexpr double shift = 0x1.8p52, quarters = 0x1.45f306dc9c883p-1;
    constexpr double half_pi1 = 0x1.921fb544p0, half_pi2 = 0x1.0b4611a6p-34, half_pi3 = 0x1.3198a2e037073p-69;
    const Doubles shifted = angle * quarters + shift, n = shifted - shift;
    const Doubles coarse = angle - n * half_pi1, fine = n * half_pi2;
    const Doubles r = coarse - fine, tail = ((coarse - r) - fine) - n * half_pi3;

    const Doubles z = r * r, half = 0.5 * z, rest = 1.0 - half;
    const Doubles odd =
        z *
        (8.33333333332248946124e-03 +
         z * (-1.98412698298579493134e-04 +
              z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10))));
    const Doubles even = z * (4.16666666666666019037e-02 +
                              z * (-1.38888888888741095749e-03 +
                                   z * (2.48015872894767294178e-05 +
                                        z * (-2.75573143513906633035e-07 +
                                             z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    const Doubles s = r + (tail * rest + (r * z) * (odd - 1.66666666666666324348e-01));
    const Doubles c = rest + (((1.0 - rest) - half) + (z * even - r * tail));

    // by quadrant
    const Masks bits = Masks(shifted);
    const Masks swaps = -(bits & 1);
    sine = Doubles(Masks(swaps ? c : s) ^ ((bits & 2) << 62));
    cosine = Doubles(Masks(swaps ? s : c) ^ (((bits + 1) & 2) << 62));
}

template <int width, class Build>
struct SinCos<Lanes<width, Build>> {
    using Pack = Lanes<width, Build>;
    Pack sin, cos;

    [[gnu::always_inline]] explicit SinCos(const Pack& angle) {
        for (int k = 0; k < Pack::parts; ++k)
            sin_cos_of<typename Pack::Doubles, typename Pack::Masks>(angle.v[k], sin.v[k], cos.v[k]);
        if (!all_of(abs(angle) <= Pack(largest_reduced_angle))) [[unlikely]]
            evaluate_huge(angle);
    }

private:
    [[gnu::noinline]] void evaluate_huge(const Pack& angle) {
        for (int lane = 0; lane < width; ++lane)
            if (!(std::abs(angle[lane]) <= largest_reduced_angle)) {
                sin.set(lane, std::sin(angle[lane]));
                cos.set(lane, std::cos(angle[lane]));
            }
    }
};

template <>
struct SinCos<double> {
    double sin, cos;

    [[gnu::always_inline]] explicit SinCos(double angle) {
        const SinCos<Lanes<2>> both{Lanes<2>(angle)};
        sin = both.sin[0];
        cos = both.cos[0];
    }
};

/// Sine and cosine of each of some angles, rad, into columns with the same number of rows.
struct TakeSinCos {
    template <class Angles, class Column>
    [[gnu::always_inline]] void operator()(const Angles& angles, Column& sin, Column& cos) const {
        using Scalar = typename Column::Scalar;
        Eigen::Index i = 0;
        if constexpr (std::is_same_v<Scalar, double>)
            for (; i + 1 < sin.size(); i += 2) {  // side by side
                Lanes<2> pair;
                pair.set(0, angles[i]);
                pair.set(1, angles[i + 1]);
                const SinCos<Lanes<2>> turn(pair);
                turn.sin.store(&sin[i]);
                turn.cos.store(&cos[i]);
            }
        for (; i < sin.size(); ++i) {
            const SinCos<Scalar> turn(angles[i]);
            sin[i] = turn.sin;
            cos[i] = turn.cos;
        }
    }
};

/// The largest rotation of TurningAngle in one step, rad.
inline constexpr double largest_turn = 1.0 / 1024;

/// Sine and cosine, times a common factor, of an angle θ that is rotated by small angles d, as three shears,
///     u = cosθ − t sinθ,   sin(θ+d) = sinθ + sin d u,   cos(θ+d) = u − t sin(θ+d),   t = tan(d/2),
/// with series of sin d and t whose error is below 2⁻⁵⁶ for |d| ≤ largest_turn.
template <class Scalar>
struct TurningAngle {
    Scalar sin, cos;

    /// Rotates by d, where square = d².
    [[gnu::always_inline]] void turn(const Scalar& d, const Scalar& square) {
        const Scalar t = d * (Scalar(0.5) + square * Scalar(1.0 / 24));
        const Scalar u = cos - t * sin;
        sin += (d * (Scalar(1) - square * Scalar(1.0 / 6))) * u;
        cos = u - t * sin;
    }
};

/// Sines and cosines of N angles at the start of a step, and from these those of its stages, if they are near. For
/// double and lanes; every lane gives the same as a single double. Both are used in place of TakeSinCos.
template <class Scalar, int N>
class StageAngles {
public:
    using Column = Eigen::Matrix<Scalar, N, 1>;

    /// At the start of a step.
    auto start() {
        return [this](const auto& angles, Column& sin, Column& cos) __attribute__((always_inline)) {
            for (Eigen::Index i = 0; i < N; ++i) angle_[i] = angles[i];
            TakeSinCos()(angle_, sin_, cos_);
            sin = sin_;
            cos = cos_;
        };
    }

    /// At a stage.
    auto stage() const {
        return [this](const auto& angles, Column& sin, Column& cos) __attribute__((always_inline)) {
            for (Eigen::Index i = 0; i < N; ++i) {
                using std::abs;
                const Scalar d = angles[i] - angle_[i];
                TurningAngle<Scalar> turned{sin_[i], cos_[i]};
                turned.turn(d, d * d);
                const auto is_near = abs(d) <= Scalar(largest_turn);
                if (!all_of(is_near)) [[unlikely]]
                    turned = evaluated(is_near, angles[i], turned);
                sin[i] = turned.sin;
                cos[i] = turned.cos;
            }
        };
    }

private:
    template <class Mask>
    [[gnu::noinline]] static TurningAngle<Scalar> evaluated(const Mask& is_near, const Scalar& angle,
                                                            const TurningAngle<Scalar>& near) {
        const SinCos<Scalar> far(angle);
        return {select(is_near, near.sin, far.sin), select(is_near, near.cos, far.cos)};
    }

    Column angle_, sin_, cos_;
};

}  // namespace doppel
