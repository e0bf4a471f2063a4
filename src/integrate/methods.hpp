#pragma once

#include "integrate/euler.hpp"
#include "integrate/rk4.hpp"

#include <array>
#include <string_view>

namespace doppel {

/// A method as presets name it and people read it.
struct Method {
    std::string_view name;   // value of `integrator`
    std::string_view title;  // in words
    int order;               // its error shrinks like step^order
};

/// Calls visit.operator()<table>() for every method there is. The list stands here and nowhere else.
template <class Visit>
constexpr void for_each_method(Visit&& visit) {
    visit.template operator()<euler>();
    visit.template operator()<rk4>();
}

inline constexpr std::array<Method, 2> methods = [] {
    std::array<Method, 2> all;
    std::size_t n = 0;
    for_each_method([&]<const auto & table>() { all[n++] = {table.name, table.title, table.order}; });
    return all;
}();

}  // namespace doppel
