#pragma once

#include <array>
#include <cstddef>

namespace doppel {

/// A fraction as it is printed, exact in every scalar.
struct Fraction {
    long numerator = 0, denominator = 1;
};

/// An explicit Runge–Kutta method of S stages (Butcher's tableau; the systems here do not depend on time, so c is left
/// out).
///     k_i = f(y + h Σ_{j<i} a_ij k_j),   y ← y + h Σ b_i k_i
template <std::size_t S>
struct Tableau {
    std::array<std::array<Fraction, S>, S> a;
    std::array<Fraction, S> b;
};

}  // namespace doppel
