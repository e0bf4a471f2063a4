#pragma once

#include <span>
#include <string_view>

namespace doppel {

/// A method as presets name it and people read it; every method's file holds its own.
struct Method {
    std::string_view name;        // value of `integrator`
    std::string_view title;       // in words
    int order;                    // its error shrinks like step^order; 0 = chosen from the tolerance
    bool adaptive;                // goes by `tolerance` in place of `step_s`
    std::string_view properties;  // "explicit", "implicit, symplectic, time-reversible"
};

/// A method with the models it can step.
struct MethodEntry : Method {
    bool angles, constraints, mechanism;
    bool stabilised;  // constraints that are held otherwise (integrate/stabilise.hpp): its steps end by project()
};

/// All of them, in the order of integrate/registry.hpp.
std::span<const MethodEntry> methods();

/// Their names, in the same order.
std::span<const std::string_view> names_of_methods();

/// The one of that name; null where there is none.
const MethodEntry* find_method(std::string_view name);

}  // namespace doppel
