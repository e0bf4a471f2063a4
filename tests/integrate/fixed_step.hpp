#pragma once

#include "integrate/dormand_prince.hpp"
#include "numeric/quad.hpp"

namespace doppel {

/// An adaptive pair with fixed steps.
template <System Model, const auto& pair>
struct AtFixedStep {
    using State = typename Model::State;

    Model& model;
    State y;
    Quad h;
    Slopes<Model, pair> slopes{y};

    AtFixedStep(Model& m, const State& start, const Quad& step) : model(m), y(start), h(step) {}
    void advance(long steps) {
        for (long i = 0; i < steps; ++i) {
            model.rate(y, slopes[0]);
            slopes.template evaluate<1, pair.stages>(model, y, h);
            slopes.finish(y, h, y);
        }
    }
    const State& state() const { return y; }
};

template <class Adaptive>
struct Fixed {
    static constexpr Method method = Adaptive::method;
    template <System Model>
    using Stepper = AtFixedStep<Model, Adaptive::pair>;
};

}  // namespace doppel
