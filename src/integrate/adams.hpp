#pragma once

#include "integrate/dormand_prince.hpp"

#include <array>

namespace doppel {

constexpr std::array<Fraction, 8> over_120960(const std::array<long, 8>& numerators) {
    std::array<Fraction, 8> weights;
    for (std::size_t j = 0; j < weights.size(); ++j) weights[j] = {numerators[j], 120960};
    return weights;
}
/// The linear multistep methods of order 8 with exact fractions, newest slope first:
///     predictor  y ← y + h Σ_j b_j f_{n−j}
///     corrector  y ← y + h Σ_j c_j f_{n+1−j},  where f_{n+1} is the slope at the prediction
/// Source  Adams & Bashforth 1883, Moulton 1926; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I,
///         §III.1.
struct AdamsWeights {
    static constexpr auto bashforth =
        over_120960({434241, -1152169, 2183877, -2664477, 2102243, -1041723, 295767, -36799});
    static constexpr auto moulton = over_120960({36799, 139849, -121797, 123133, -88547, 41499, -11351, 1375});
};

/// Adams–Bashforth–Moulton at fixed step: predict, evaluate, correct, evaluate; two evaluations per step. The first
/// seven steps, and those after an event, lack earlier slopes and are taken by dop853, which has the same order.
template <System Model>
class AdamsStepper {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    AdamsStepper(Model& model, const State& start, const Scalar& step)
        : model_(model), y_(start), at_(start), sum_(start), h_(step), starter_(start) {
        past_.fill(start);
        take_modes(model_, y_);
        model_.rate(y_, past_[0]);
    }

    void advance(long steps) {
        if constexpr (HasEvents<Model>)
            if (model_.switches()) {
                for (; steps > 0; --steps) step_to_event();
                return;
            }
        for (; steps > 0 && known_ < past_.size(); --steps) start_step();
        for (; steps > 0; --steps) step();
    }

    const State& state() const { return y_; }
    long evaluations() const { return evaluations_; }

private:
    static constexpr std::size_t order = AdamsWeights::bashforth.size();

    void start_step() {
        starter_[0] = past_[newest_];
        one_step(y_, h_);
        newest_ = known_++;
        arrive();
    }
    /// A step by dop853 without earlier slopes; starter_[0] is the slope at y.
    void one_step(State& y, const Scalar& h) {
        starter_.template evaluate<1, Dop853::pair.stages>(model_, y, h);
        starter_.finish(y, h, at_);
        y.swap(at_);
        evaluations_ += static_cast<long>(Dop853::pair.stages) - 1;
    }

    /// After an event earlier slopes are useless: starts again at the end of the step.
    void step_to_event() requires HasEvents<Model> {
        before_ = y_;
        if (known_ < past_.size())
            start_step();
        else
            step();
        if (!(model_.margin(y_) < Scalar(0))) return;
        y_ = before_;
        step_through_events(model_, y_, h_, [&](State& y, const Scalar& t) {
            model_.rate(y, starter_[0]);
            ++evaluations_;
            one_step(y, t);
        });
        newest_ = 0;
        known_ = 1;
        arrive();
    }

    void step() {
        sum<AdamsWeights::bashforth>(sum_);
        at_ = y_ + h_ * sum_;
        newest_ = (newest_ + 1) % order;  // the predicted slope replaces the oldest one
        model_.rate(at_, past_[newest_]);
        ++evaluations_;
        sum<AdamsWeights::moulton>(sum_);
        y_ += h_ * sum_;
        arrive();
    }

    /// Adds the slope at the new state as the newest one.
    void arrive() {
        project(model_, y_);
        model_.rate(y_, past_[newest_]);
        ++evaluations_;
    }

    /// out ← Σ_j weight_j f_{newest−j}
    template <const auto& weights>
    void sum(State& out) const {
        out.fill(Scalar(-0.0));
        for (std::size_t j = 0; j < order; ++j) out += value<Scalar>(weights[j]) * past_[(newest_ + order - j) % order];
    }

    Model& model_;
    State y_, at_, sum_, before_;
    Scalar h_;
    std::array<State, order> past_;       // slopes, a ring that ends at `newest_`
    std::size_t newest_ = 0, known_ = 1;  // index of the newest slope; number of slopes
    long evaluations_ = 1;
    Slopes<Model, Dop853::pair> starter_;
};

struct Adams {
    static constexpr Method method{"adams", "Adams–Bashforth–Moulton 8", 8, false, "explicit, multistep"};
    template <System Model>
    using Stepper = AdamsStepper<Model>;
};

}  // namespace doppel
