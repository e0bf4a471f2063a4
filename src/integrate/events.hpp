#pragma once

#include "base/error.hpp"

#include <limits>
#include <optional>

namespace doppel {

// A model whose right-hand side is smooth only between events, as with joints that stick and slip, offers
//
//     switches()       whether it has events
//     take_modes(y)    at the start: y ← how the motion goes on from y; which law holds until the first event
//     settle(y)        the same at an event
//     margin(y)        0 or more until the next event
//
// rate() keeps to one law in between, however far a trial step goes.

template <class Model>
concept HasEvents = requires(Model model, typename Model::State& y) {
    model.switches();
    model.take_modes(y);
    model.settle(y);
    model.margin(y);
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

/// The first event in a step of h, s, to rounding and behind it; looked for at the ends of that many equal parts.
/// `state_at(t)` is the state at 0 < t ≤ h.
template <HasEvents Model, class Scalar, class StateAt>
std::optional<Scalar> first_event(Model& model, const Scalar& h, int parts, StateAt&& state_at) {
    const auto is_past = [&](const Scalar& t) { return model.margin(state_at(t)) < Scalar(0); };
    const auto end_of = [&](int part) { return part == parts ? h : Scalar(h * Scalar(part) / Scalar(parts)); };
    for (int part = 1; part <= parts; ++part) {
        Scalar low = end_of(part - 1), high = end_of(part);
        if (!is_past(high)) continue;
        while (high - low > std::numeric_limits<Scalar>::epsilon() * h) {
            const Scalar middle = (low + high) / Scalar(2);
            if (!(low < middle && middle < high)) break;
            (is_past(middle) ? high : low) = middle;
        }
        return high;
    }
    return std::nullopt;
}

/// Counts events one at a time of which none leaves the one before. Throws Error (exit 3) where they do not end.
class Stall {
public:
    void note(bool advances) {
        constexpr int most = 100;
        count_ = advances ? 0 : count_ + 1;
        if (count_ > most)
            throw method_failed("joints change between rest and motion {} times at one time; the motion cannot go on",
                                most);
    }

private:
    int count_ = 0;
};

/// A step of h, s, of a method at fixed step, in parts where events are: `take(y, t)` is one of t.
template <HasEvents Model, class State, class Scalar, class Take>
void step_through_events(Model& model, State& y, const Scalar& h, Take&& take) {
    State from = y, at = y;
    const auto state_at = [&](const Scalar& t) -> const State& {
        at = from;
        take(at, t);
        return at;
    };
    Stall stall;
    for (Scalar left = h;;) {
        from = y;
        const auto event = first_event(model, left, 1, state_at);
        y = state_at(event.value_or(left));
        if (!event) return;
        model.settle(y);
        stall.note(*event > Scalar(4) * std::numeric_limits<Scalar>::epsilon() * h);
        left -= *event;
        if (!(left > Scalar(0))) return;
    }
}

}  // namespace doppel
