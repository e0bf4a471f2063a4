#pragma once

#include "integrate/tableau.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace doppel {

/// y + h Σ_j weight_j k_j over the weights that are not zero; which those are is known to the compiler.
template <const auto& weights, class State, class Slopes, std::size_t... J>
State advanced(const State& y, const typename State::Scalar& h, const Slopes& k, std::index_sequence<J...>) {
    using Scalar = typename State::Scalar;
    State sum = State::Constant(Scalar(-0.0));  // unlike +0, it changes no sum and costs no addition
    [[maybe_unused]] const auto add = [&]<std::size_t j>() {
        constexpr Fraction w = weights[j];
        if constexpr (w.numerator != 0) sum += (Scalar(w.numerator) / Scalar(w.denominator)) * k[j];
    };
    (add.template operator()<J>(), ...);
    return y + h * sum;
}

/// One step of size h with `table`. Any system with rate(State), any scalar; no allocation.
template <const auto& table, class Model>
typename Model::State step(const Model& model, const typename Model::State& y, const typename Model::State::Scalar& h) {
    constexpr std::size_t stages = table.b.size();
    std::array<typename Model::State, stages> k;

    // slopes k_i = f(y + h Σ_{j<i} a_ij k_j)
    const auto slope = [&]<std::size_t i>() {
        static constexpr auto row = table.a[i];
        k[i] = model.rate(advanced<row>(y, h, k, std::make_index_sequence<i>()));
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (slope.template operator()<I>(), ...);
    }
    (std::make_index_sequence<stages>());

    // y + h Σ b_i k_i
    static constexpr auto b = table.b;
    return advanced<b>(y, h, k, std::make_index_sequence<stages>());
}

}  // namespace doppel
