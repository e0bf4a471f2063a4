#pragma once

#include "base/error.hpp"

#include <limits>
#include <optional>

namespace doppel {

// A model whose right-hand side is only smooth between events, as with joints that stick and slip, has
//
//     switches()       whether there are events
//     take_modes(y)    at the start: chooses the law that applies until the first event, and adapts y to it
//     settle(y)        the same at an event
//     margin(y)        ≥ 0 until the next event
//     longest_step()   s; in longer steps a margin could become negative and positive again unnoticed
//
// rate() uses the same law between events, however far a trial step goes.

/// Of models that have these functions for others, but never switch.
template <class Model>
inline constexpr bool never_switches = false;

template <class Model>
concept HasEvents = requires(Model& model, typename Model::State& y) {
    requires !never_switches<Model>;
    model.switches();
    model.take_modes(y);
    model.settle(y);
    model.margin(y);
    model.longest_step();
};

template <class Model>
bool switches([[maybe_unused]] const Model& model) {
    if constexpr (HasEvents<Model>)
        return model.switches();
    else
        return false;
}
template <class Model, class State>
void take_modes([[maybe_unused]] Model& model, [[maybe_unused]] State& y) {
    if constexpr (HasEvents<Model>)
        if (model.switches()) model.take_modes(y);
}

/// The smallest time, to rounding, at which the margin is negative; it is ≥ 0 at `low` ≥ 0, and negative at `high`.
template <class Scalar, class Margin>
Scalar bisect_event(Scalar low, Scalar high, const Scalar& h, Margin&& margin) {
    while (high - low > std::numeric_limits<Scalar>::epsilon() * h) {
        const Scalar middle = (low + high) / Scalar(2);
        if (!(low < middle && middle < high)) break;
        (margin(middle) < Scalar(0) ? high : low) = middle;
    }
    return high;
}

/// The time just after the first event in a step of h, s, to rounding; `state_at(t)` is the state at 0 ≤ t ≤ h. The
/// margin is evaluated at the ends of eight equal parts, and close to the ends of the step. Around a local minimum of
/// these values, the minimum is found by golden section.
template <HasEvents Model, class Scalar, class StateAt>
std::optional<Scalar> first_event(Model& model, const Scalar& h, StateAt&& state_at) {
    constexpr int points = 11;
    constexpr double places[points]{0, 0.001, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.999, 1};
    const auto margin = [&](const Scalar& t) { return model.margin(state_at(t)); };
    Scalar at[points], seen[points];
    for (int i = 0; i < points; ++i) {
        at[i] = h * Scalar(places[i]);
        seen[i] = margin(at[i]);
        if (i >= 2 && seen[i - 1] < seen[i - 2] && seen[i - 1] < seen[i] && !(seen[i - 1] < Scalar(0))) {
            Scalar low = at[i - 2], high = at[i];
            for (int k = 0; k < 25; ++k) {
                const Scalar part = Scalar(0.381966011) * (high - low), left = low + part, right = high - part;
                const Scalar on_left = margin(left), on_right = margin(right);
                if (on_left < Scalar(0)) return bisect_event(at[i - 2], left, h, margin);
                if (on_right < Scalar(0)) return bisect_event(at[i - 2], right, h, margin);
                (on_left < on_right ? high : low) = on_left < on_right ? right : left;
            }
        }
        if (i > 0 && seen[i] < Scalar(0)) return bisect_event(at[i - 1], at[i], h, margin);
    }
    return std::nullopt;
}

/// Counts consecutive events at the same time. Throws Error (exit 3) if they do not end.
class RepeatedEvents {
public:
    /// An event so long after the start of a step, s.
    template <class Scalar>
    void note(const Scalar& event, const Scalar& step) {
        constexpr int maximum = 100;
        count_ = event > Scalar(4) * std::numeric_limits<Scalar>::epsilon() * step ? 0 : count_ + 1;
        if (count_ > maximum)
            throw method_failed("joints stick and slip {} times at one time; the motion cannot continue", maximum);
    }

private:
    int count_ = 0;
};

/// Takes a fixed step of h, s, in parts between events; `take(y, t)` takes a step of t.
template <HasEvents Model, class State, class Scalar, class Take>
void step_through_events(Model& model, State& y, const Scalar& h, Take&& take) {
    State from = y, at = y;
    const auto state_at = [&](const Scalar& t) -> const State& {
        at = from;
        take(at, t);
        return at;
    };
    RepeatedEvents repeated;
    for (Scalar left = h;;) {
        from = y;
        y = state_at(left);
        if (!(model.margin(y) < Scalar(0))) return;
        const Scalar event =
            bisect_event(Scalar(0), left, left, [&](const Scalar& t) { return model.margin(state_at(t)); });
        y = state_at(event);
        model.settle(y);
        repeated.note(event, h);
        left -= event;
        if (!(left > Scalar(0))) return;
    }
}

}  // namespace doppel
