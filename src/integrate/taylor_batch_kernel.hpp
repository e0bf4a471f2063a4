#pragma once

#include "integrate/taylor_series.hpp"
#include "numeric/lanes.hpp"
#include "physics/angle_chain.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace doppel {

// What integrate/taylor_batch.cpp and the code for one kind of processor (integrate/taylor_batch_width.cpp) share, by the
// rules of integrate/batch_width.cpp.

/// Chains in angles; `members` as in BatchRequest (integrate/batch_kernel.hpp).
struct TaylorBatchRequest {
    std::size_t members, links;
    const double *mass, *length, *angle, *rate;  // of link j of member i at [j · members + i]
    const double* gravity;                       // one a member
    double tolerance;
    int order;
    double interval;  // s, between two samples
};

/// All members in the lanes of one processor.
class TaylorLanes {
public:
    virtual ~TaylorLanes();
    /// The states at the samples first … first + count − 1, of which each call takes the next: 2 · links numbers for each
    /// member, sample by sample.
    virtual void compute(long first, long count, double* states) = 0;
};

template <int width>
TaylorLanes* make_taylor_lanes(const TaylorBatchRequest& request);
template <>
TaylorLanes* make_taylor_lanes<2>(const TaylorBatchRequest& request);
template <>
TaylorLanes* make_taylor_lanes<4>(const TaylorBatchRequest& request);
template <>
TaylorLanes* make_taylor_lanes<8>(const TaylorBatchRequest& request);

inline constexpr int most_batch_orders = 32;

/// The series of chains side by side, one a lane, with r_i = l_i (cosθ_i, sinθ_i) across the rods and
/// F_i = Σ_{j≥i} m_j (q_j″ + g ŷ): of order k R_k = Σ_{j≥1} r_j ω_{k+1−j}, and a = (k + 1) ω_{k+1} solves
///     M_0 a = −( r_0 · F_k[R] + Σ_{j=1}^k r_j · F_{k−j} ) .
/// Source  recurrences of this kind: Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
template <class Pack, int N>
struct LanesOfSeries {
    using Half = State<Pack, N>;

    AngleChain<Pack, N> chain;
    int order;
    /// Coefficients of one order: r_i (m), ω_i (rad/s), θ_i (rad) and F_i (N).
    struct Term {
        Pack x[N], y[N], rate[N], angle[N], fx[N], fy[N];
    };
    Term term[most_batch_orders + 2];

    [[gnu::always_inline]] void expand(const Half& angle, const Half& rate) {
        chain.update(angle);
        for (int i = 0; i < N; ++i) {
            term[0].x[i] = chain.length[i] * chain.cos[i];
            term[0].y[i] = chain.length[i] * chain.sin[i];
            term[0].rate[i] = rate[i];
            term[1].x[i] = -(term[0].y[i] * rate[i]);
            term[1].y[i] = term[0].x[i] * rate[i];
        }
        for (int k = 0; k < order; ++k) next(k);
        for (int k = 0; k <= order; ++k)
            for (int i = 0; i < N; ++i) term[k].angle[i] = term[k].rate[i] * Pack(1.0 / (k + 1));
    }

    /// What angles and rates change by in a time t, s.
    [[gnu::always_inline]] void move(const Pack& t, Half& angle, Half& rate) const {
        for (int i = 0; i < N; ++i) {
            angle[i] = term[order].angle[i];
            rate[i] = term[order].rate[i];
        }
        for (int k = order - 1; k > 0; --k)
            for (int i = 0; i < N; ++i) {
                angle[i] = angle[i] * t + term[k].angle[i];
                rate[i] = rate[i] * t + term[k].rate[i];
            }
        for (int i = 0; i < N; ++i) {
            angle[i] = (angle[i] * t + term[0].angle[i]) * t;
            rate[i] = rate[i] * t;
        }
    }

    /// The step of TaylorStepper, s, but for how much it may grow.
    [[gnu::always_inline]] Pack step(double tolerance) const {
        constexpr double tiny = 1e-290, most = 900;  // tiny: of what rests all coefficients are 0
        const Pack allowed = Pack(tolerance) * ((greatest(0) + sqrt(greatest(1))) + Pack(tiny));
        Pack exponent(most);  // log2 h
        for (int k = order - watched_coefficients + 1; k <= order; ++k)
            exponent = lesser(exponent, rough_log2(allowed / (greatest(k) + Pack(tiny))) * Pack(1.0 / k));
        return rough_exp2(exponent);
    }

private:
    /// ω_{k+1}, r_{k+2} and F_k from all before.
    [[gnu::always_inline]] void next(int k) {
        Pack x[N], y[N], moment_x[N], moment_y[N];
        for (int i = 0; i < N; ++i) {
            x[i] = term[k + 1].x[i] * term[0].rate[i];
            y[i] = term[k + 1].y[i] * term[0].rate[i];
            moment_x[i] = moment_y[i] = Pack(0);
        }
        for (int j = 1; j <= k; ++j) {
            const Term &one = term[j], &other = term[k - j], &after = term[k + 1 - j];
            for (int i = 0; i < N; ++i) {
                x[i] += one.x[i] * after.rate[i];
                y[i] += one.y[i] * after.rate[i];
                moment_x[i] += one.x[i] * other.fx[i];
                moment_y[i] += one.y[i] * other.fy[i];
            }
        }
        find_forces(k, x, y);
        Half moment, turn;
        for (int i = 0; i < N; ++i)
            moment[i] = -((moment_x[i] + moment_y[i]) + (term[0].x[i] * term[k].fx[i] + term[0].y[i] * term[k].fy[i]));
        chain.solve_mass(moment, turn);
        for (int i = 0; i < N; ++i) {
            const Pack rate = turn[i] * Pack(1.0 / (k + 1));
            x[i] += term[0].x[i] * rate;
            y[i] += term[0].y[i] * rate;
            term[k + 1].rate[i] = rate;
            term[k + 2].x[i] = -(y[i] * Pack(1.0 / (k + 2)));
            term[k + 2].y[i] = x[i] * Pack(1.0 / (k + 2));
        }
        find_forces(k, x, y);
    }

    [[gnu::always_inline]] void find_forces(int k, const Pack (&x)[N], const Pack (&y)[N]) {
        Pack bob_x[N], bob_y[N], sum_x(0), sum_y(0);
        for (int i = 0; i < N; ++i) {
            bob_x[i] = sum_x += x[i];
            bob_y[i] = sum_y += y[i];
        }
        sum_x = sum_y = Pack(0);
        for (int i = N - 1; i >= 0; --i) {
            const Pack& m = chain.pendulum.mass[static_cast<std::size_t>(i)];
            sum_x += m * bob_x[i];
            sum_y += m * bob_y[i];
            if (k == 0) sum_y += m * chain.pendulum.gravity;
            term[k].fx[i] = sum_x * Pack(k + 1);
            term[k].fy[i] = sum_y * Pack(k + 1);
        }
    }

    [[gnu::always_inline]] Pack greatest(int k) const {
        Pack most = abs(term[k].rate[0]);
        for (int i = 1; i < N; ++i) most = greater(most, abs(term[k].rate[i]));
        return most;
    }
};

}  // namespace doppel
