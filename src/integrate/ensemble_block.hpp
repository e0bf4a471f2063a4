#pragma once

#include "integrate/ensemble_kernel.hpp"
#include "integrate/euler.hpp"
#include "integrate/midpoint.hpp"
#include "integrate/rk4.hpp"
#include "integrate/semi_implicit_euler.hpp"
#include "numeric/lanes.hpp"
#include "physics/pendulum.hpp"

#include <tuple>
#include <utility>

namespace doppel {

/// The methods that step many trials side by side: of fixed step and explicit, so that all trials do the same.
using EnsembleMethods = std::tuple<Euler, SemiImplicitEuler, Midpoint, Rk4>;

/// The block of one model and one method, in lanes or, alone, in double.
template <class Model, class Which>
class SteppedBlock final : public EnsembleBlock {
public:
    using Scalar = typename Model::Scalar;
    using Stepper = typename Which::template Stepper<Model>;

    SteppedBlock(const Pendulum<Scalar>& pendulum, double step)
        : model_(pendulum), stepper_(model_, Model::start(pendulum), Scalar(step)) {}

    void advance(long steps) override { stepper_.advance(steps); }
    std::size_t dimensions() const override { return static_cast<std::size_t>(stepper_.state().size()); }
    void read(std::size_t lane, double* entries) const override {
        const auto& y = stepper_.state();
        for (Eigen::Index i = 0; i < y.size(); ++i) {
            if constexpr (is_lanes<Scalar>)
                entries[i] = y[i][static_cast<int>(lane)];
            else
                entries[i] = y[i];
        }
    }

private:
    Model model_;
    Stepper stepper_;
};

/// The trials from `first` side by side.
template <class Side>
Pendulum<Side> pendulum_of(const EnsembleRequest& request, std::size_t first) {
    Pendulum<Side> pendulum;
    const auto fill = [&](Side& side, const double* values) {
        if constexpr (is_lanes<Side>)
            for (int lane = 0; lane < Side::width; ++lane) {
                const std::size_t trial = first + static_cast<std::size_t>(lane);
                side.set(lane, values[trial < request.trials ? trial : request.trials - 1]);
            }
        else
            side = values[first];
    };
    const auto fill_all = [&](std::vector<Side>& sides, const double* values) {
        sides.resize(request.links);
        for (std::size_t j = 0; j < request.links; ++j) fill(sides[j], values + j * request.trials);
    };
    fill_all(pendulum.mass, request.mass);
    fill_all(pendulum.length, request.length);
    fill_all(pendulum.angle, request.angle);
    fill_all(pendulum.rate, request.rate);
    fill(pendulum.gravity, request.gravity);
    return pendulum;
}

/// The block with the method asked for.
template <class Model>
EnsembleBlock* with_method(const EnsembleRequest& request, const Pendulum<typename Model::Scalar>& pendulum) {
    EnsembleBlock* block = nullptr;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        ((request.method == I
              ? void(block = new SteppedBlock<Model, std::tuple_element_t<I, EnsembleMethods>>(pendulum, request.step))
              : void()),
         ...);
    }
    (std::make_index_sequence<std::tuple_size_v<EnsembleMethods>>());
    return block;
}

}  // namespace doppel
