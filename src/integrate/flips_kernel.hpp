#pragma once

#include "integrate/flips.hpp"
#include "integrate/series.hpp"
#include "numeric/lanes.hpp"

#include <cstddef>

namespace doppel {

// Declarations shared by integrate/flips.cpp and the code for each register width (integrate/flips_width.cpp), with the
// rules of integrate/batch_width.cpp.

/// The parameters of double pendulums.
template <class Pack>
struct FlipChain {
    Pack gravity;          // g / l1, 1/s²
    Pack ratio;            // m1 / m2
    Pack masses;           // 1 + m1 / m2
    Pack longer;           // L = l2 / l1
    Pack minus_by_longer;  // −1 / L
    Pack longest;          // longest step, s
};

inline constexpr int flip_order = 16;  // at 1e-8 rad/s, order 12 costs 1.2 times as much, and 20 costs 1.1 times

/// Taylor series of double pendulums side by side. With the tensions a, b of the rods divided by m1 l1, and D = θ2 − θ1
/// (DoublePendulum has the same equations with the tensions eliminated):
///
///     a = ω1² + (g/l1) cosθ1 + b cosD,     θ1″ = b sinD − (g/l1) sinθ1
///     (1 + m1/m2) b = L ω2² + a cosD,      L θ2″ = −a sinD,               L = l2/l1
///
/// Each order follows from products of the earlier ones, except for the tensions, which solve the two equations
/// together; their determinant is that at the start.
template <class Pack>
struct FlipSeries {
    static constexpr int order = flip_order;

    /// The coefficients of one power of the time; sine and cosine of θ1 times g/l1.
    struct Term {
        Pack theta[2], omega[2];
        Pack turn, sin_d, cos_d;  // D′, sinD and cosD
        Pack sin1, cos1;
        Pack a, b;
    };
    Term term[order + 1];
    Pack determinant;  // 1 / (m1/m2 + sin²D)

    /// Starts from the angles and rates in term[0].
    [[gnu::always_inline]] void start(const FlipChain<Pack>& by) {
        const SinCos<Pack> one(term[0].theta[0]), d(term[0].theta[1] - term[0].theta[0]);
        term[0].sin1 = one.sin * by.gravity;
        term[0].cos1 = one.cos * by.gravity;
        term[0].sin_d = d.sin;
        term[0].cos_d = d.cos;
        determinant = Pack(1) / (by.ratio + d.sin * d.sin);
    }

    /// Computes the tensions of power k, and from them everything else of power k + 1.
    [[gnu::always_inline]] void extend(const FlipChain<Pack>& by, int k) {
        Term& now = term[k];
        now.turn = now.omega[1] - now.omega[0];
        Pack square1(0), square2(0);
        for (int j = 0; 2 * j < k; ++j) {
            square1 += term[j].omega[0] * term[k - j].omega[0];
            square2 += term[j].omega[1] * term[k - j].omega[1];
        }
        square1 += square1;
        square2 += square2;
        if (k % 2 == 0) {
            square1 += term[k / 2].omega[0] * term[k / 2].omega[0];
            square2 += term[k / 2].omega[1] * term[k / 2].omega[1];
        }

        Pack a_cos(0), b_cos(0), a_sin(0), b_sin(0), turn_cos(0), turn_sin(0), omega_cos(0), omega_sin(0);
        for (int j = 0; j < k; ++j) {
            const Term &one = term[j], &other = term[k - j];
            a_cos += one.a * other.cos_d;
            b_cos += one.b * other.cos_d;
            turn_cos += one.turn * other.cos_d;
            a_sin += one.a * other.sin_d;
            b_sin += one.b * other.sin_d;
            turn_sin += one.turn * other.sin_d;
            omega_cos += one.omega[0] * other.cos1;
            omega_sin += one.omega[0] * other.sin1;
        }

        const Pack &sin_d = term[0].sin_d, &cos_d = term[0].cos_d;
        const Pack u = (square1 + now.cos1) + b_cos, v = square2 * by.longer + a_cos;
        now.a = (u * by.masses + cos_d * v) * determinant;
        now.b = (v + cos_d * u) * determinant;

        Term& next = term[k + 1];
        const Pack inverse(1.0 / (k + 1));
        next.theta[0] = now.omega[0] * inverse;
        next.theta[1] = now.omega[1] * inverse;
        next.omega[0] = ((b_sin + now.b * sin_d) - now.sin1) * inverse;
        next.omega[1] = (a_sin + now.a * sin_d) * (inverse * by.minus_by_longer);
        next.sin_d = (turn_cos + now.turn * cos_d) * inverse;
        next.cos_d = (turn_sin + now.turn * sin_d) * -inverse;
        next.sin1 = (omega_cos + now.omega[0] * term[0].cos1) * inverse;
        next.cos1 = (omega_sin + now.omega[0] * term[0].sin1) * -inverse;
    }

    /// The step, s, at most `longest`, for which each of the last four terms of the rates stays below 2^allowed rad/s.
    [[gnu::always_inline]] Pack step(double allowed, const Pack& longest) const {
        Pack exponent(1000);
        for (int k = order - watched_coefficients + 1; k <= order; ++k) {
            const Pack size = greater(abs(term[k].omega[0]), abs(term[k].omega[1]));
            exponent = lesser(exponent, (Pack(allowed) - rough_log2(size)) * Pack(1.0 / k));
        }
        return lesser(rough_exp2(exponent), longest);
    }

    struct Ends {
        Pack theta[2], omega[2];
    };
    /// The motion a time t after the start.
    [[gnu::always_inline]] Ends at(const Pack& t) const {
        Ends y;
        for (int i = 0; i < 2; ++i) {
            y.theta[i] = term[order].theta[i];
            y.omega[i] = term[order].omega[i];
        }
        for (int k = order - 1; k >= 0; --k)
            for (int i = 0; i < 2; ++i) {
                y.theta[i] = y.theta[i] * t + term[k].theta[i];
                y.omega[i] = y.omega[i] * t + term[k].omega[i];
            }
        return y;
    }
};

struct FlipRequest {
    double duration;  // s
    double allowed;   // log2 of the tolerance, rad/s
    std::size_t count;
    const Pendulum<double>* pendulums;
    const Pendulum<double>* hanging;  // at rest, for lanes without a pendulum
    double* times;                    // s; negative ones are to be found
    const std::atomic<bool>* stop;
};

/// For registers of `width` doubles (cmake/widths.cmake). Returns false if it was stopped.
template <int width>
bool find_flips(const FlipRequest& request);
template <>
bool find_flips<2>(const FlipRequest& request);
template <>
bool find_flips<4>(const FlipRequest& request);
template <>
bool find_flips<8>(const FlipRequest& request);

/// The motion of one rod in a step of length h, s: the coefficients of its angle and rate, and its state at the end.
struct RodOnStep {
    double h, theta[flip_order + 1], omega[flip_order + 1], theta_end;
};
/// The time at which |θ| first exceeds π, s after the start of the step; infinity if it does not.
double first_flip(const RodOnStep& rod);

}  // namespace doppel
