#pragma once

#include "base/error.hpp"
#include "integrate/runge_kutta.hpp"
#include "integrate/stepper.hpp"
#include "numeric/portable_math.hpp"

#include <cmath>
#include <limits>

namespace doppel {

/// An embedded Runge–Kutta pair with step size control by a tolerance. The output time lies inside the last step, where
/// the state is interpolated, so that sampling never changes the steps.
///
/// The error of a step, root mean square over the components of the state, is kept below
///     tolerance · (1 + |y_i|)
/// with y_i in rad and rad/s, or m and m/s: the tolerance is both absolute and relative.
///
/// Source  Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, §II.4 to II.6.
template <System Model, const auto& pair, const Method& method>
class Adaptive {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    /// Throws Error (exit 2) for a tolerance that the scalar cannot reach.
    Adaptive(Model& model, const State& start, const Scalar& tolerance)
        : model_(model), tolerance_(tolerance), y0_(start), y1_(start), out_(start), scratch_(start), k_(start) {
        const Scalar minimum = Scalar(4) * std::numeric_limits<Scalar>::epsilon();
        if (!(tolerance >= minimum))
            throw bad_input("{}: tolerance = {:.3g} is too small for {} digits; it must be at least {:.1g}",
                            method.name, static_cast<double>(tolerance), std::numeric_limits<Scalar>::digits10 + 1,
                            static_cast<double>(minimum));
        take_modes(model_, y1_);
        model_.rate(y1_, k_[end]);
        h_ = first_step();
        evaluations_ = 2;
    }

    /// Continues from another, similar state with the same step size.
    void reset(const State& start) {
        y1_ = out_ = start;
        take_modes(model_, y1_);
        ends_at_event_ = false;
        model_.rate(y1_, k_[end]);
        ++evaluations_;
        span_ = Scalar(0);
        time_ = {};
        interpolates_ = false;
    }

    void advance(const Scalar& seconds) {
        sample(time_.advance(seconds, span_, [&] { step(seconds); }));
    }
    void look_ahead(const Scalar& seconds) {
        sample(time_.look_ahead(seconds, span_, [&] { step(seconds); }));
    }

    const State& state() const { return out_; }
    long steps() const { return steps_; }
    Scalar smallest_step() const { return smallest_; }
    long evaluations() const { return evaluations_; }

private:
    static constexpr std::size_t end = pair.stages;  // index of the slope at the end of a step
    static constexpr bool error_needs_end = [] {
        bool needs = false;
        for (const auto& row : pair.error) needs |= !is_zero(row[end]);
        return needs;
    }();

    /// Takes a step that the tolerance accepts, from y1. `seconds`, the requested interval, is used to detect a
    /// vanishing h.
    void step(const Scalar& seconds) {
        if (ends_at_event_) {
            if constexpr (HasEvents<Model>) model_.settle(y1_);
            model_.rate(y1_, k_[end]);
            ++evaluations_;
            ends_at_event_ = false;
        }
        if constexpr (HasEvents<Model>)
            if (model_.switches() && h_ > model_.longest_step()) h_ = model_.longest_step();
        y0_.swap(y1_);
        k_[0].swap(k_[end]);
        for (double limit = pair.control.grow;; limit = 1) {
            if (!(h_ > std::numeric_limits<Scalar>::epsilon() * seconds))
                throw method_failed(
                    "{}: no step down to {:.3g} s meets tolerance = {:.3g}; the motion has a singularity there, and no "
                    "explicit method can pass it",
                    method.name, static_cast<double>(h_), static_cast<double>(tolerance_));
            take(h_);
            const double error = error_of_step();
            if (error <= 1) {
                h_ *= Scalar(growth(error, error_before_, limit));
                error_before_ = error > 1e-4 ? error : 1e-4;
                break;
            }
            h_ *= Scalar(growth(error, 1, 1));
        }
        arrive();
        if (steps_ == 0 || span_ < smallest_) smallest_ = span_;
        ++steps_;
        if constexpr (HasEvents<Model>)
            if (model_.switches()) end_at_event();
    }

    void take(const Scalar& h) {
        k_.template evaluate<1, end>(model_, y0_, h);
        k_.finish(y0_, h, y1_);
        if constexpr (error_needs_end) model_.rate(y1_, k_[end]);
        evaluations_ += static_cast<long>(error_needs_end ? end : end - 1);
        span_ = h;
    }
    /// Accepts the step: the slope at its end becomes that at the next start.
    void arrive() {
        project(model_, y1_);
        if (!error_needs_end || projects(model_)) {
            model_.rate(y1_, k_[end]);
            ++evaluations_;
        }
        interpolates_ = false;
    }

    /// If an event lies inside the last step, takes the step again up to the event.
    void end_at_event() requires HasEvents<Model> {
        const auto state_at = [&](const Scalar& t) -> const State& {
            interpolate(t);
            return out_;
        };
        const auto event = first_event(model_, span_, state_at);
        if (!event) return;
        repeated_events_.note(*event, span_);
        take(*event);
        arrive();
        ends_at_event_ = true;
    }

    /// h_next / h; at most `limit`. An error that is NaN shrinks the step.
    static double growth(double error, double before, double limit) {
        constexpr StepControl control = pair.control;
        const double factor =
            control.safety * portable_pow(error, -control.exponent) * portable_pow(before, control.memory);
        if (!(factor > control.shrink)) return control.shrink;
        return factor < limit ? factor : limit;
    }

    /// The error ε relative to the tolerance; 1 if it is just met.
    double error_of_step() {
        using std::sqrt;
        static constexpr auto first = pair.error[0];
        k_.template sum<first>(scratch_);
        const Scalar e1 = norm_squared(scratch_);
        if constexpr (pair.error.size() == 1) {
            return static_cast<double>(Scalar(h_ * sqrt(e1)));
        } else {
            static constexpr auto second = pair.error[1];
            k_.template sum<second>(scratch_);
            const Scalar e2 = norm_squared(scratch_);
            if (e1 == Scalar(0)) return 0;
            return static_cast<double>(Scalar(h_ * e1 / sqrt(e1 + e2 / Scalar(100))));
        }
    }

    /// Mean square of the components, each in units of its tolerance.
    Scalar norm_squared(const State& error) const {
        using std::abs;
        Scalar sum(0);
        for (Eigen::Index i = 0; i < error.size(); ++i) {
            const Scalar before = abs(y0_[i]), after = abs(y1_[i]);
            const Scalar part = error[i] / (tolerance_ * (Scalar(1) + (before < after ? after : before)));
            sum += part * part;
        }
        return sum / Scalar(error.size());
    }

    /// The initial step size, which is rather too short than too long (section II.4, "starting step size").
    Scalar first_step() {
        const double size = std::sqrt(static_cast<double>(norm_squared(y1_)));
        const double slope = std::sqrt(static_cast<double>(norm_squared(k_[end])));
        const double guess = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * size / slope;
        scratch_ = y1_ + Scalar(guess) * k_[end];
        model_.rate(scratch_, k_[0]);
        scratch_ = k_[0] - k_[end];
        const double curvature = std::sqrt(static_cast<double>(norm_squared(scratch_))) / guess;
        const double bend = slope > curvature ? slope : curvature;
        const double step = bend <= 1e-15 ? 1e-3 * guess : portable_pow(0.01 / bend, 1.0 / method.order);
        return Scalar(step < 100 * guess ? step : 100 * guess);
    }

    /// Sets out_ to the state at the output time, `offset` s from the start of the last step.
    void sample(const Scalar& offset) {
        if (offset == span_)
            out_ = y1_;
        else
            interpolate(offset);
    }

    /// Sets out_ to the state at t s from the start of the last step.
    void interpolate(const Scalar& t) {
        if (!interpolates_) {
            k_.evaluate_dense(model_, y0_, span_);
            evaluations_ += static_cast<long>(Slopes<Model, pair>::all - end - 1);
            interpolates_ = true;
        }
        const Scalar s = t / span_, rest = Scalar(1) - s;
        out_.setZero();
        for (std::size_t row = pair.dense.size(); row-- > 0;) {
            k_.sum_with(pair.dense[row], scratch_);
            out_ = (row % 2 == 0 ? rest : s) * (span_ * scratch_ + out_);
        }
        scratch_ = y1_ - y0_;
        out_ += Scalar(2) * scratch_ - span_ * (k_[0] + k_[end]);
        out_ = y0_ + s * (scratch_ + rest * (span_ * k_[0] - scratch_ + s * out_));
        project(model_, out_);
    }

    Model& model_;
    Scalar tolerance_;
    Scalar h_ = Scalar(0), span_ = Scalar(0);  // s, of the next step and of the last one
    OutputTime<Scalar> time_;
    Scalar smallest_ = Scalar(0);  // s
    double error_before_ = 1e-4;
    long steps_ = 0, evaluations_ = 0;
    bool interpolates_ = false;   // the slopes for interpolation are those of the last step
    bool ends_at_event_ = false;  // the last step
    RepeatedEvents repeated_events_;
    State y0_, y1_, out_;  // at the start and the end of the last step; at the output time
    State scratch_;
    Slopes<Model, pair> k_;
};

}  // namespace doppel
