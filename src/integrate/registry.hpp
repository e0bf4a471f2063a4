#pragma once

#include "integrate/adams.hpp"
#include "integrate/dormand_prince.hpp"
#include "integrate/euler.hpp"
#include "integrate/gauss.hpp"
#include "integrate/rattle.hpp"
#include "integrate/runge_kutta.hpp"
#include "integrate/taylor.hpp"

#include <tuple>
#include <type_traits>

namespace doppel {

/// Every method there is, in the order in which they are listed. This list stands here and nowhere else.
using Methods =
    std::tuple<Euler, SemiImplicitEuler, Midpoint, Rk4, Dopri5, Dop853, Adams, Gauss4, Gauss6, Taylor, Rattle, Rattle6>;

/// Whether a method can step a model: its class says what it requires of one.
template <class Which, class Model>
inline constexpr bool serves = requires {
    typename Which::template Stepper<Model>;
};

/// Calls visit.operator()<Which>() for every method.
template <class Visit>
constexpr void for_each_method(Visit&& visit) {
    [&]<class... Which>(std::type_identity<std::tuple<Which...>>) {
        (visit.template operator()<Which>(), ...);
    }(std::type_identity<Methods>());
}

}  // namespace doppel
