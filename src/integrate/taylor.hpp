#pragma once

#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "integrate/series.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/stepper.hpp"
#include "numeric/compensated.hpp"
#include "numeric/quad.hpp"
#include "numeric/roots.hpp"
#include "physics/angle_chain.hpp"
#include "physics/mechanism.hpp"
#include "physics/physical_chain.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace doppel {

/// The Taylor method. Each step computes the series of the motion to a high order by recurrence. Its length follows
/// from the last coefficients; output times do not shorten a step, because the series is valid everywhere inside it.
///
/// Order   p = 10 − ½ ln ε, more than the usual 1 − ½ ln ε, because the work grows more like p than like p².
/// Step    h = min (ε / |c_k|)^(1/k) over the last four coefficients of the rates, relative to the scale of the rates;
///         at most twice the previous one. Rates have larger errors than angles, by a factor of about p/h.
/// Rounding errors of the state are carried over to the next step.
/// Source  Jorba & Zou 2005, A software package for the numerical integration of ODEs by means of high-order Taylor
///         methods, Experimental Mathematics 14:99.
template <class S>
class SeriesStepper {
public:
    using Scalar = S;
    using State = typename Series<Scalar>::State;

    /// `series_to` returns the series up to an order; `system` is needed if it projects or has events. `order` from 5
    /// to 64, or 0: from the tolerance. Throws Error (exit 2) for a tolerance that the scalar cannot reach.
    SeriesStepper(const std::function<std::unique_ptr<Series<Scalar>>(int order)>& series_to,
                  std::unique_ptr<AnySystem<State>> system, const State& start, double tolerance, int order)
        : tolerance_(tolerance),
          order_(order_for(tolerance, order)),
          series_(series_to(order_)),
          system_(std::move(system)),
          base_(start),
          lost_(State::Zero(start.size())),
          change_(start),
          out_(start) {
        if (has_events()) system_->take_modes(base_);
    }

    void advance(const Scalar& seconds) {
        at(time_.advance(seconds, step_, [&] { next_step(static_cast<double>(seconds)); }));
    }
    void look_ahead(const Scalar& seconds) {
        at(time_.look_ahead(seconds, step_, [&] { next_step(static_cast<double>(seconds)); }));
    }
    const State& state() const { return out_; }

    /// Instead of advance(), for users that evaluate inside every step: moves to the end of the last step and expands
    /// the next one there. at(t) is valid for 0 ≤ t ≤ step(), s from its start; at(step()) has the same bits as at(0)
    /// of the next step.
    void take_step() {
        time_ = {};
        next_step(static_cast<double>(step_));
        at(Scalar(0));
    }
    const State& at(const Scalar& t) {
        series_->move(t, change_);
        out_ = base_ + (change_ + lost_);
        project(out_);
        return out_;
    }
    const Scalar& step() const { return step_; }
    /// A coordinate in the step; at both ends it equals at().
    Bernstein on_step(Eigen::Index coordinate) {
        std::vector<double> powers{static_cast<double>(at(Scalar(0))[coordinate])};
        for (int k = 0; k <= order_; ++k) powers.push_back(series_->rate(k, coordinate) / (k + 1));
        auto path = Bernstein::of_powers(powers, static_cast<double>(step_));
        path.b.back() = static_cast<double>(at(step_)[coordinate]);
        return path;
    }

    int order() const { return order_; }
    long steps() const { return steps_; }
    Scalar smallest_step() const { return smallest_; }
    /// The number of orders computed, each of which costs about as much as a right-hand side.
    long evaluations() const { return steps_ * order_; }

private:
    static int order_for(double tolerance, int requested) {
        const auto minimum = 4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
        if (!(tolerance >= minimum))
            throw bad_input("taylor: tolerance = {:.3g} is too small for {} digits; it must be at least {:.1g}",
                            tolerance, std::numeric_limits<Scalar>::digits10 + 1, minimum);
        const long order = requested == 0 ? std::lround(10 - 0.5 * std::log(tolerance)) : requested;
        return static_cast<int>(std::clamp(order, watched_coefficients + 1L, 64L));
    }
    bool has_events() const { return system_ && system_->switches(); }
    void project(State& y) {
        if (system_) system_->project(y);
    }

    /// Moves to the end of the step and expands the next one there. `seconds`, the requested interval, is used to
    /// detect vanishing steps.
    void next_step(double seconds) {
        if (steps_ > 0) {
            series_->move(step_, change_);
            for (Eigen::Index i = 0; i < base_.size(); ++i) add_compensated(base_[i], lost_[i], change_[i]);
            project(base_);
            if (ends_at_event_) {
                system_->settle(base_);
                lost_.setZero();
            }
        }
        expand(seconds);
    }

    void expand(double seconds) {
        series_->expand(base_);
        const double h = chosen_step();
        step_ = Scalar(h);
        if (has_events()) {
            if (step_ > system_->longest_step()) step_ = system_->longest_step();
            ends_at_event_ = ends_at_event();
        }
        if (!(h > static_cast<double>(std::numeric_limits<Scalar>::epsilon()) * seconds))
            throw method_failed(
                "taylor: the largest step is {:.3g} s at tolerance = {:.3g}, which is too small to continue; "
                "the motion has a singularity there, and no explicit method can pass it",
                h, tolerance_);
        if (steps_ == 0 || step_ < smallest_) smallest_ = step_;
        ++steps_;
    }

    /// Whether the system has an event in the step, which then ends there.
    bool ends_at_event() {
        const auto event = first_event(*system_, step_, [&](const Scalar& t) -> const State& {
            series_->move(t, change_);
            change_ = base_ + (change_ + lost_);
            return change_;
        });
        if (!event) return false;
        repeated_events_.note(*event, step_);
        step_ = *event;
        return true;
    }

    double chosen_step() {
        constexpr double growth = 2;
        double exponent = 900;  // log2 h
        for (int k = order_ - watched_coefficients + 1; k <= order_; ++k) {
            const double room = series_->log2_tolerance_ratio(tolerance_, k);
            if (std::isnan(room))
                throw method_failed("taylor: coefficient {} of the series is not finite; the motion diverged", k);
            exponent = std::min(exponent, room / k);
        }
        const double longest = series_->longest_step();
        free_step_ =
            std::min({power_of_two(std::max(exponent, -900.0)), longest, steps_ == 0 ? longest : growth * free_step_});
        return series_->first_event(free_step_);
    }
    /// 2^a within 0.3 % for |a| < 1000.
    static double power_of_two(double a) {
        const double whole = std::floor(a), part = a - whole;
        const auto power = std::bit_cast<double>((static_cast<std::int64_t>(whole) + 1023) << 52);
        return power * (1 + part * (0.6565 + 0.3435 * part));
    }

    double tolerance_;
    int order_;
    std::unique_ptr<Series<Scalar>> series_;
    std::unique_ptr<AnySystem<State>> system_;
    State base_, lost_;                               // start of the step, and its rounding error
    State change_, out_;                              // the state at the output time
    Scalar step_ = Scalar(0), smallest_ = Scalar(0);  // s
    double free_step_ = 0;                            // s, length of the step without events
    OutputTime<Scalar> time_;
    long steps_ = 0;
    bool ends_at_event_ = false;  // the step
    RepeatedEvents repeated_events_;
};
// Compiled in integrate/taylor.cpp.
extern template class SeriesStepper<double>;
extern template class SeriesStepper<Quad>;

// The series of a model, if there is one. A chain of particles on rods uses the series of the equivalent mechanism.
// Projection after every step gives the same motion; Baumgarte's terms do not, so that is excluded.
template <class Scalar, int N>
std::unique_ptr<Series<Scalar>> series_of(const AngleChain<Scalar, N>& model, int order) {
    return series_of(model.pendulum, order);
}
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const DoublePendulum<Scalar>& d, int order) {
    const Pendulum<Scalar> chain{{d.m1, d.m2}, {d.l1, d.l2}, {Scalar(0), Scalar(0)}, {Scalar(0), Scalar(0)}, d.g};
    return series_of(chain, order);
}
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Mechanism<Scalar>& model, int order) {
    return series_of(model.parts, order);
}
template <class Scalar, int N>
std::unique_ptr<Series<Scalar>> series_of(const RodChain<Scalar, N>& model, int order) {
    return series_of(parts_of(model.pendulum), order);
}
template <class Model>
std::unique_ptr<Series<typename Model::Scalar>> series_of(const Baumgarte<Model>&, int) = delete;

template <class Model>
concept HasSeries = requires(const Model& model) {
    series_of(model, 1);
};

template <HasSeries Model>
class TaylorStepper : public SeriesStepper<typename Model::Scalar> {
public:
    using Scalar = typename Model::Scalar;
    using State = typename SeriesStepper<Scalar>::State;

    /// `order` as for SeriesStepper.
    TaylorStepper(Model& model, const typename Model::State& start, const Scalar& tolerance, int order = 0)
        : SeriesStepper<Scalar>([&](int to) { return series_of(model, to); }, system_of(model), start,
                                static_cast<double>(tolerance), order) {}

private:
    static std::unique_ptr<AnySystem<State>> system_of([[maybe_unused]] Model& model) {
        if constexpr (std::is_same_v<typename Model::State, State>) return std::make_unique<HeldSystem<Model&>>(model);
        return nullptr;
    }
    static_assert(std::is_same_v<typename Model::State, State> || !(HasEvents<Model> || Projects<Model>),
                  "what projects or has events has a state of any size");
};

struct Taylor {
    static constexpr Method method{"taylor", "Taylor series", 0, true, "explicit, order from the tolerance"};
    template <HasSeries Model>
    using Stepper = TaylorStepper<Model>;
};

}  // namespace doppel
