#pragma once

#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "integrate/stepper.hpp"
#include "physics/canonical.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace doppel {

/// Gauss collocation with S stages. With μ_ij = a_ij / b_j the method is
///     L_i = h b_i f(z + Σ_j μ_ij L_j) ,     z ← z + Σ L_i .
/// It is symplectic if μ_ij + μ_ji = 1, even if the b are rounded. To fulfil this to the last bit, the larger one of a
/// pair is rounded, and the other is computed as the difference from 1.
/// Source  Butcher 1964; Antoñana, Makazaga & Murua 2017, Reducing and monitoring round-off error propagation for
///         symplectic implicit Runge–Kutta schemes.
template <class Scalar, std::size_t S>
struct Gauss {
    std::array<Scalar, S> hb;  // s
    std::array<std::array<Scalar, S>, S> mu;

    explicit Gauss(const Scalar& h) {
        using std::sqrt;
        const Scalar half = Scalar(1) / Scalar(2);
        for (std::size_t i = 0; i < S; ++i) mu[i][i] = half;
        if constexpr (S == 2) {
            hb = {h * half, h * half};
            pair(1, 0, half + sqrt(Scalar(3)) / Scalar(3));
        } else {
            static_assert(S == 3);
            const Scalar root = sqrt(Scalar(15));
            hb[0] = hb[2] = h * Scalar(5) / Scalar(18);
            hb[1] = h - Scalar(2) * hb[0];
            pair(1, 0, half + Scalar(3) * root / Scalar(20));
            pair(2, 1, mu[1][0]);
            pair(2, 0, half + Scalar(3) * root / Scalar(25));
        }
    }

private:
    void pair(std::size_t i, std::size_t j, const Scalar& larger) {
        mu[i][j] = larger;
        mu[j][i] = Scalar(1) - larger;
    }
};

/// Gauss collocation at fixed step in canonical variables z = (θ, p), where it is symplectic: the energy error stays
/// bounded (with friction or a drive it is an ordinary method of its order). The stages are found by fixed-point
/// iteration. The first guess extrapolates the stages of earlier steps, and iteration continues until it gains less
/// than rounding. z is summed with compensation. The remaining rounding errors are unbiased, so that the energy error
/// is a random walk without drift.
/// Errors  exit 3 if the iteration does not converge: the step is too long.
/// Source  Hairer, McLachlan & Razakarivony 2008, Achieving Brouwer's law with implicit Runge–Kutta methods;
///         Hairer, Lubich & Wanner, Geometric Numerical Integration, §VIII.6.
template <Hamiltonian Model, std::size_t S, const auto& method>
class GaussCollocation {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    GaussCollocation(Model& model, const State& start, const Scalar& step)
        : form_(model), gauss_(step), step_(step), y_(start), z_(start), rounding_error_(start), at_(start) {
        form_.momenta(y_, z_);
        rounding_error_.setZero();
        moves_.fill(rounding_error_);
        slopes_.fill(rounding_error_);
        past_.fill(moves_);
    }

    void advance(long steps) {
        for (long i = 0; i < steps; ++i) {
            guess();
            solve();
            move();
            ++done_;
        }
        if (steps > 0) form_.velocities(z_, y_);
    }

    const State& state() const { return y_; }
    long evaluations() const { return evaluations_; }

private:
    using Moves = std::array<State, S>;     // L
    static constexpr long remembered = 10;  // steps
    static constexpr int limit = 500;       // iterations

    /// Largest changes of angles and momenta in an iteration.
    struct Change {
        Scalar angle, momentum;
    };

    /// Extrapolates the moves of each stage by the polynomial through its earlier ones; at first, for a constant slope.
    /// (One polynomial through all stages would take their errors, which have order S + 1 and differ, for motion.)
    ///     L_i(n) = Σ_a (−1)^(a+1) (k over a) L_i(n − a),   a = 1 … k
    void guess() {
        if (known_ == 0) {
            form_.rate(z_, angles_[0], slopes_[0]);
            ++evaluations_;
            for (std::size_t i = 0; i < S; ++i) moves_[i] = gauss_.hb[i] * slopes_[0];
            return;
        }
        for (auto& move : moves_) move.setZero();
        Scalar weight(-1);
        for (long a = 1; a <= known_; ++a) {
            weight *= -Scalar(static_cast<int>(known_ + 1 - a)) / Scalar(static_cast<int>(a));
            const auto& past = past_[static_cast<std::size_t>((done_ - a) % remembered)];
            for (std::size_t i = 0; i < S; ++i) add(moves_[i], weight, past[i]);
        }
    }

    void solve() {
        bool angles_done = false, momenta_done = false;
        const auto n = z_.size() / 2;
        Change before = iterate();
        known_ = is_good_guess(before) ? std::min(known_ + 1, remembered) : 0;
        for (int i = 1; i < limit; ++i) {
            const Change now = iterate();
            angles_done = angles_done || is_done(now.angle, before.angle, z_.head(n), moves_[0].head(n));
            momenta_done = momenta_done || is_done(now.momentum, before.momentum, z_.tail(n), moves_[0].tail(n));
            if (angles_done && momenta_done) return;
            before = now;
        }
        throw method_failed(
            "{}: step {}: the stages still change by {:.2g} rad after {} iterations; choose a smaller step_s than {:g}",
            method.name, done_ + 1, static_cast<double>(before.angle), limit, static_cast<double>(step_));
    }

    /// L_i ← h b_i f(z + Σ_j μ_ij L_j), all from the previous L, so that the processor works on the stages in parallel.
    Change iterate() {
        const auto n = z_.size();
        for (std::size_t i = 0; i < S; ++i) {
            for (Eigen::Index c = 0; c < n; ++c) {
                Scalar sum = rounding_error_[c];
                for (std::size_t j = 0; j < S; ++j) sum += gauss_.mu[i][j] * moves_[j][c];
                at_[c] = z_[c] + sum;
            }
            form_.rate(at_, angles_[i], slopes_[i]);
        }
        evaluations_ += static_cast<long>(S);

        Change change{Scalar(0), Scalar(0)};
        for (std::size_t i = 0; i < S; ++i)
            for (Eigen::Index c = 0; c < n; ++c) {
                using std::abs;
                const Scalar moved = gauss_.hb[i] * slopes_[i][c];
                const Scalar size = abs(moved - moves_[i][c]);
                Scalar& largest = c < n / 2 ? change.angle : change.momentum;
                if (!(size <= largest)) largest = size;
                moves_[i][c] = moved;
            }
        return change;
    }

    /// Whether the first change was small compared with the moves; otherwise the next guess ignores earlier steps.
    bool is_good_guess(const Change& first) const {
        const auto n = z_.size() / 2;
        return Scalar(4) * first.angle <= moves_[0].head(n).cwiseAbs().maxCoeff() &&
               Scalar(4) * first.momentum <= moves_[0].tail(n).cwiseAbs().maxCoeff();
    }

    /// Whether the iteration has converged: at the rate now / before the next change would be below rounding, or
    /// changes no longer decrease and are small enough to be rounding. For NaN it is false.
    template <class Values, class Moved>
    static bool is_done(const Scalar& now, const Scalar& before, const Values& values, const Moved& moved) {
        static const Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
        const Scalar size = moved.cwiseAbs().maxCoeff();
        if (now * now <= Scalar(0.125) * epsilon * size * before) return true;
        return !(now < before) && now <= Scalar(1024) * epsilon * (size + values.cwiseAbs().maxCoeff());
    }

    /// z ← z + Σ L_i; the rounding error is carried over to the next step.
    void move() {
        for (Eigen::Index c = 0; c < z_.size(); ++c) {
            Scalar sum = rounding_error_[c];
            for (std::size_t i = 0; i < S; ++i) sum += moves_[i][c];
            const Scalar from = z_[c];
            z_[c] += sum;
            rounding_error_[c] = (from - z_[c]) + sum;
        }
        past_[static_cast<std::size_t>(done_ % remembered)] = moves_;
    }

    Canonical<Model> form_;
    Gauss<Scalar, S> gauss_;
    Scalar step_;
    long done_ = 0, evaluations_ = 0;
    long known_ = 0;  // number of earlier steps for the guess
    State y_, z_, rounding_error_;
    Moves moves_;
    std::array<Moves, remembered> past_;  // step n is at index n modulo `remembered`
    std::array<typename Canonical<Model>::Angles, S> angles_;
    State at_;
    Moves slopes_;
};

struct Gauss4 {
    static constexpr Method method{"gauss4", "Gauss collocation 4", 4, false,
                                   "implicit; symplectic and time-reversible without friction"};
    template <Hamiltonian Model>
    using Stepper = GaussCollocation<Model, 2, method>;
};

struct Gauss6 {
    static constexpr Method method{"gauss6", "Gauss collocation 6", 6, false,
                                   "implicit; symplectic and time-reversible without friction"};
    template <Hamiltonian Model>
    using Stepper = GaussCollocation<Model, 3, method>;
};

}  // namespace doppel
