#pragma once

#include "integrate/method.hpp"

#include <span>
#include <string_view>

namespace doppel {

/// A method with the models it can step.
struct MethodEntry : Method {
    bool angles, constraints, mechanism;
    bool stabilised;  // constraints that are held otherwise (integrate/stabilise.hpp)
};

/// All of them, in the order of integrate/registry.hpp.
std::span<const MethodEntry> methods();

/// The one of that name; null where there is none.
const MethodEntry* find_method(std::string_view name);

}  // namespace doppel
