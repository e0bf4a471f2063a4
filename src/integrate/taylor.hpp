#pragma once

#include "base/error.hpp"
#include "integrate/angle_series.hpp"
#include "integrate/mechanism_series.hpp"
#include "integrate/methods.hpp"
#include "integrate/stepper.hpp"
#include "integrate/taped_series.hpp"
#include "numeric/compensated.hpp"
#include "numeric/roots.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace doppel {

/// The Taylor method. Each step computes the series of the motion to a high order by recurrence, and goes as far as its
/// last coefficients allow; output times shorten no step, as the series holds anywhere inside one.
///
/// Order   p = 10 − ½ ln ε (taylor_order()).
/// Step    h = min (ε / |c_k|)^(1/k) over the last four coefficients of the rates, relative to the rates' amount.
///         Rates are the harder part: an angle errs by about h/p times as much. No step is more than twice the one
///         before.
/// Rounding of the state is carried over to the next step, and time is kept as a distance from the start of the step.
/// Source  Jorba & Zou 2005, A software package for the numerical integration of ODEs by means of high-order Taylor
///         methods, Experimental Mathematics 14:99.
template <HasSeries Model>
class TaylorStepper {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    /// `order` from 5 to 64, or 0: by the tolerance. Throws Error (exit 2) for a tolerance that the scalar cannot give.
    TaylorStepper(Model& model, const State& start, const Scalar& tolerance, int order = 0)
        : model_(model),
          tolerance_(checked(plain_value(tolerance))),
          order_(std::clamp(order == 0 ? taylor_order(tolerance_) : order, watched_coefficients + 1, most_orders)),
          series_(model, order_),
          base_(start),
          lost_(State::Zero(start.size())),
          change_(start),
          out_(start) {
        take_modes(model_, base_);
    }

    /// On from another state, by a step of at most twice the last: for one much like the last.
    void reset(const State& start) {
        base_ = out_ = start;
        take_modes(model_, base_);
        ends_at_event_ = false;
        lost_.setZero();
        offset_ = offset_lost_ = Scalar(0);
        expand(plain_value(step_));
    }

    void advance(const Scalar& seconds) {
        add_compensated(offset_, offset_lost_, seconds);
        while (offset_ > step_) next_step(plain_value(seconds));
        at(offset_);
    }

    const State& state() const { return out_; }

    /// In place of advance(), for what evaluates inside every step: on to the end of the last one, where the next is
    /// expanded. On it, at(t) holds for 0 ≤ t ≤ step(), s from where it starts; at(step()) is at(0) of the one after,
    /// to the bit.
    void take_step() {
        offset_ = step_;
        offset_lost_ = Scalar(0);
        next_step(plain_value(step_));
        at(Scalar(0));
    }
    const State& at(const Scalar& t) {
        series_.move(t, change_);
        out_ = base_ + (change_ + lost_);
        project(model_, out_);
        return out_;
    }
    const Scalar& step() const { return step_; }
    /// The angle of a link on the step, rad, at whose ends it is what at() says.
    Bernstein angle(int link) requires requires(typename SeriesOf<Model>::type series) { series.rate(0, 0); }
    {
        std::vector<double> powers{at(Scalar(0))[link]};
        for (int k = 0; k <= order_; ++k) powers.push_back(series_.rate(k, link) / (k + 1));
        auto angle = Bernstein::of_powers(powers, step_);
        angle.b.back() = at(step_)[link];
        return angle;
    }

    int order() const { return order_; }
    long steps() const { return steps_; }
    Scalar smallest_step() const { return smallest_; }
    /// Orders computed: each costs about what a right-hand side would.
    long evaluations() const { return steps_ * order_; }

private:
    static constexpr double growth = 2;
    static constexpr int most_orders = 64;

    static double checked(double tolerance) {
        const double least = 4 * plain_value(std::numeric_limits<Scalar>::epsilon());
        if (!(tolerance >= least))
            throw bad_input("taylor: tolerance = {:.3g} cannot be met with {} digits; the finest is {:.1g}", tolerance,
                            std::numeric_limits<Scalar>::digits10 + 1, least);
        return tolerance;
    }

    /// Goes to the end of the step and expands the next one there. `seconds`, the interval asked for, tells when steps
    /// have vanished.
    void next_step(double seconds) {
        if (steps_ > 0) {
            series_.move(step_, change_);
            for (Eigen::Index i = 0; i < base_.size(); ++i) add_compensated(base_[i], lost_[i], change_[i]);
            project(model_, base_);
            add_compensated(offset_, offset_lost_, Scalar(-step_));
            if constexpr (HasEvents<Model>)
                if (ends_at_event_) {
                    model_.settle(base_);
                    lost_.setZero();
                }
        }
        expand(seconds);
    }

    void expand(double seconds) {
        series_.expand(base_);
        const double h = chosen_step();
        step_ = Scalar(h);
        if constexpr (HasEvents<Model>) {
            if (model_.switches() && step_ > model_.longest_step()) step_ = model_.longest_step();
            ends_at_event_ = model_.switches() && ends_at_event();
        }
        if (!(h > plain_value(std::numeric_limits<Scalar>::epsilon()) * seconds))
            throw method_failed(
                "taylor: a step of {:.3g} s is all that tolerance = {:.3g} allows, too little to get on; "
                "the motion has a singularity there, which no explicit method passes",
                h, tolerance_);
        if (steps_ == 0 || step_ < smallest_) smallest_ = step_;
        ++steps_;
    }

    /// Whether the model has an event in the step, which then ends there.
    bool ends_at_event() requires HasEvents<Model> {
        const auto event = first_event(model_, step_, [&](const Scalar& t) -> const State& {
            series_.move(t, change_);
            change_ = base_ + (change_ + lost_);
            return change_;
        });
        if (!event) return false;
        stall_.note(*event > Scalar(4) * std::numeric_limits<Scalar>::epsilon() * step_);
        step_ = *event;
        return true;
    }

    double chosen_step() {
        double exponent = 900;  // log2 h
        for (int k = order_ - watched_coefficients + 1; k <= order_; ++k) {
            exponent = std::min(exponent, log2_step(k));
        }
        const double longest = series_.longest_step();
        const double h =
            std::min({power_of_two(std::max(exponent, -900.0)), longest, steps_ == 0 ? longest : growth * free_step_});
        free_step_ = h;
        if constexpr (requires { series_.first_event(h); })
            return series_.first_event(h);
        else
            return h;
    }

    /// Of the step that coefficient k allows, s.
    double log2_step(int k) const {
        const auto check = [&](double size) {
            if (!(size <= std::numeric_limits<double>::max()))
                throw method_failed("taylor: coefficient {} of the series is not finite; the motion has blown up", k);
        };
        if constexpr (requires { series_.log2_size(k); }) {
            const double size = series_.log2_size(k);
            check(size);
            return (rough_log2(tolerance_) - size) / k;
        } else {
            const double size = series_.size(k);
            check(size);
            return rough_log2(tolerance_ / size) / k;
        }
    }

    /// 2^a within 0.3 % for |a| < 1000.
    static double power_of_two(double a) {
        const double whole = std::floor(a), part = a - whole;
        const auto power = std::bit_cast<double>((static_cast<std::int64_t>(whole) + 1023) << 52);
        return power * (1 + part * (0.6565 + 0.3435 * part));
    }

    Model& model_;
    double tolerance_;
    int order_;
    typename SeriesOf<Model>::type series_;
    State base_, lost_;                                    // where the step starts, and what rounding took from it
    State change_, out_;                                   // the state at the output time
    Scalar step_ = Scalar(0), smallest_ = Scalar(0);       // s
    double free_step_ = 0;                                 // s, what the step would be but for events
    Scalar offset_ = Scalar(0), offset_lost_ = Scalar(0);  // s, from the start of the step to the output time
    long steps_ = 0;
    bool ends_at_event_ = false;  // the step
    Stall stall_;
};

/// The Taylor method, for every model that has a series (integrate/taylor_series.hpp).
struct Taylor {
    static constexpr Method method{"taylor", "Taylor series", 0, true, "explicit, order from the tolerance"};
    template <HasSeries Model>
    using Stepper = TaylorStepper<Model>;
};

}  // namespace doppel
