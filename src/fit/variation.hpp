#pragma once

#include "track/model.hpp"

namespace doppel {

/// The accelerations of both arms and how they change with the state θ1, θ2, ω1, ω2 and with the parameters of motion:
/// row by row those of the first and the second arm.
struct Accelerations {
    std::array<double, 2> value;
    std::array<std::array<double, 4>, 2> by_state;
    std::array<std::array<double, dynamic_count>, 2> by_parameter;
};

/// Arms::rate and its derivatives, written out: of both sides of
///     A α1 + c α2 = r1,   c α1 + α2 = r2,   c = C cosδ
/// by each variable x:  A ∂α1 + c ∂α2 = ∂r1 − ∂A α1 − ∂c α2,  c ∂α1 + ∂α2 = ∂r2 − ∂c α1.
template <bool by_parameters>
Accelerations accelerations_of(const Arms<double>& arms, const ArmState<double>& y) {
    using enum FitParameter;
    const auto of = [&](FitParameter parameter) { return arms.p[index_of(parameter)]; };
    const double w1 = y[2], w2 = y[3];
    std::array<double, 2> sines, cosines;
    Lanes<2> angles;
    angles.set(0, y[0]), angles.set(1, y[1]);
    const SinCos<Lanes<2>> turned(angles);
    turned.sin.store(sines.data()), turned.cos.store(cosines.data());
    const double sine_between = sines[0] * cosines[1] - cosines[0] * sines[1];
    const double cosine_between = cosines[0] * cosines[1] + sines[0] * sines[1];
    const double c = of(coupling) * cosine_between, s = of(coupling) * sine_between;
    // the right sides r, and ∂r by c, ω1 and ω2
    struct Pair {
        double first, second;
    };
    Pair r{-s * w2 * w2 - of(gravity_1) * sines[0], s * w1 * w1 - of(gravity_2) * sines[1]};
    Pair by_c{0, 0}, by_w1{0, 2 * s * w1}, by_w2{-2 * s * w2, 0};
    double dry1 = 0, dry2 = 0, square1 = 0, square2 = 0;
    const bool is_carried = arms.drag == Drag::carried;
    if (arms.has_friction) {
        const double between = w2 - w1, x1 = w1 / coulomb_width, x2 = between / coulomb_width;
        const bool is_sharp = arms.is_sharp();
        const double root1 = is_sharp ? 0 : 1 / std::sqrt(1 + x1 * x1),
                     root2 = is_sharp ? 0 : 1 / std::sqrt(1 + x2 * x2);
        dry1 = is_sharp ? arms.modes[0] : x1 * root1, dry2 = is_sharp ? arms.modes[1] : x2 * root2;
        const double u = is_carried ? w2 + c * w1 : w2, drag_slope = 2 * of(quadratic_2) * std::abs(u);
        square1 = std::abs(w1) * w1, square2 = std::abs(u) * u;
        const double torque = of(quadratic_2) * square2;
        const double pivot = of(viscous_1) * w1 + of(coulomb_1) * dry1;
        const double middle = of(viscous_2) * between + of(coulomb_2) * dry2;
        const double pivot_slope = of(viscous_1) + of(coulomb_1) * (root1 * root1 * root1 / coulomb_width);
        const double middle_slope = of(viscous_2) + of(coulomb_2) * (root2 * root2 * root2 / coulomb_width);
        r.first += middle - pivot - of(quadratic_1) * square1;
        r.second -= middle + torque;
        by_w1.first -= middle_slope + pivot_slope + 2 * of(quadratic_1) * std::abs(w1);
        by_w1.second += middle_slope;
        by_w2.first += middle_slope;
        by_w2.second -= middle_slope + drag_slope;
        if (is_carried) {
            r.first -= c * torque;
            by_c = {-torque - c * drag_slope * w1, -drag_slope * w1};
            by_w1.first -= c * drag_slope * c;
            by_w1.second -= drag_slope * c;
            by_w2.first -= c * drag_slope;
        }
    }
    // α or its derivatives, of both right sides: with held joints in other equations of the same kind
    const double a = of(inertia), inverse = 1 / (a - c * c), together = 1 / (a + 2 * c + 1);
    const bool holds_1 = arms.is_held(0), holds_2 = arms.is_held(1);
    const auto solved = [&](double first, double second) -> Pair {
        if (holds_1) return {0, holds_2 ? 0 : second};
        if (holds_2) return {(first + second) * together, (first + second) * together};
        return {(first - c * second) * inverse, (a * second - c * first) * inverse};
    };
    const Pair alpha = solved(r.first, r.second);
    Accelerations result;
    result.value = {alpha.first, alpha.second};
    const auto solve = [&](auto& rows, auto column, double first, double second) {
        const Pair slopes = solved(first, second);
        rows[0][column] = slopes.first;
        rows[1][column] = slopes.second;
    };
    // by an angle between the arms
    const Pair turn{-c * w2 * w2 - s * by_c.first + s * alpha.second, c * w1 * w1 - s * by_c.second + s * alpha.first};
    solve(result.by_state, 0u, turn.first - of(gravity_1) * cosines[0], turn.second);
    solve(result.by_state, 1u, -turn.first, -turn.second - of(gravity_2) * cosines[1]);
    solve(result.by_state, 2u, by_w1.first, by_w1.second);
    solve(result.by_state, 3u, by_w2.first, by_w2.second);
    if constexpr (by_parameters) {
        const auto by = [&](FitParameter parameter, double first, double second) {
            solve(result.by_parameter, index_of(parameter), first, second);
        };
        by(inertia, -alpha.first, 0);
        by(coupling, -sine_between * w2 * w2 + cosine_between * (by_c.first - alpha.second),
           sine_between * w1 * w1 + cosine_between * (by_c.second - alpha.first));
        by(gravity_1, -sines[0], 0);
        by(gravity_2, 0, -sines[1]);
        by(viscous_1, -w1, 0);
        by(viscous_2, w2 - w1, w1 - w2);
        by(coulomb_1, -dry1, 0);
        by(coulomb_2, dry2, -dry2);
        by(quadratic_1, -square1, 0);
        by(quadratic_2, is_carried ? -c * square2 : 0, -square2);
    }
    return result;
}

/// Arms whose state is known with its derivatives by the start (directions 0 to 3) and some parameters (from 4 on):
/// exact, as duals throughout would give them, for less.
template <int N>
struct VaryingArms {
    using Number = Dual<double, N>;

    Arms<double> arms;
    std::array<Eigen::Index, dynamic_count> direction;  // of each parameter; −1: a constant
    bool point_masses = false;                          // then D1 = A D2/C changes with these three

    ArmState<Number> rate(const ArmState<Number>& y) const {
        const auto slopes = accelerations_of<(N > 4)>(arms, {y[0].value, y[1].value, y[2].value, y[3].value});
        ArmState<Number> result{y[2], y[3], {}, {}};
        for (std::size_t arm = 0; arm < 2; ++arm) {
            const auto& by = slopes.by_state[arm];
            auto& acceleration = result[arm + 2];
            acceleration.value = slopes.value[arm];
            acceleration.tangent =
                by[0] * y[0].tangent + by[1] * y[1].tangent + by[2] * y[2].tangent + by[3] * y[3].tangent;
            if constexpr (N > 4) add_parameters(slopes.by_parameter[arm], acceleration);
        }
        return result;
    }

private:
    void add_parameters(std::array<double, dynamic_count> by, Number& acceleration) const {
        using enum FitParameter;
        if (point_masses) {
            const double along = by[index_of(gravity_1)] * arms.p[index_of(gravity_1)];
            by[index_of(inertia)] += along / arms.p[index_of(inertia)];
            by[index_of(coupling)] -= along / arms.p[index_of(coupling)];
            by[index_of(gravity_2)] += along / arms.p[index_of(gravity_2)];
        }
        for (std::size_t k = 0; k < dynamic_count; ++k)
            if (direction[k] >= 0) acceleration.tangent[direction[k]] += by[k];
    }
};

}  // namespace doppel
