#pragma once

#include "integrate/euler_carried.hpp"
#include "integrate/runge_kutta.hpp"

#include <type_traits>

namespace doppel {

/// Euler 1768: positions advance with the old velocities, velocities with the old forces.
struct Euler {
    static constexpr Method method{"euler", "explicit Euler", 1, false, "explicit"};
    static constexpr Tableau<1> table{.a = {}, .b = {{{1, 1}}}};
    template <System Model>
    using Stepper = std::conditional_t<has_carried_euler<Model>, CarriedEuler<Model>, RungeKutta<Model, table>>;
};

}  // namespace doppel
