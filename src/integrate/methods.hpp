#pragma once

#include <span>
#include <string_view>

namespace doppel {

/// The description of a method, for presets and users; it is defined in the method's file.
struct Method {
    std::string_view name;        // value of `integrator`
    std::string_view title;       // in words
    int order;                    // its error is proportional to step^order; 0 = chosen from the tolerance
    bool adaptive;                // uses `tolerance` instead of `step_s`
    std::string_view properties;  // "explicit", "implicit, symplectic, time-reversible"
};

/// The computing effort of a motion up to now.
struct Effort {
    long steps = 0, evaluations = 0;  // evaluations of the right-hand side
    double smallest_step = 0;         // s
};

/// A method with the models that it supports.
struct MethodEntry : Method {
    bool angles, constraints, mechanism;
    bool stabilised;  // with constraints that project() restores after each step (integrate/stabilise.hpp)
};

/// All methods, in the order of integrate/registry.hpp.
std::span<const MethodEntry> methods();

/// Their names, in the same order.
std::span<const std::string_view> names_of_methods();

/// The method with that name; null if there is none.
const MethodEntry* find_method(std::string_view name);

}  // namespace doppel
