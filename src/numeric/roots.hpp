#pragma once

#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

namespace doppel {

/// An interval in which a function rises through 0: < 0 at `low`, ≥ 0 at `high`.
struct Bracket {
    double low, high;
};

/// A polynomial on 0 ≤ t ≤ length by its Bernstein coefficients b_0 … b_n: its values at the ends are b_0 and b_n, and
/// all values lie between the smallest and largest coefficient. The number of sign changes of the coefficients exceeds
/// the number of roots by an even number (Descartes' rule). Bisection until at most one change is left isolates all
/// roots.
/// Source  Farin, Curves and Surfaces for CAGD, §5–6; Lane & Riesenfeld 1981, BIT 21:112.
struct Bernstein {
    std::pmr::vector<double> b;
    double length = 1;

    /// From Σ a_i t^i.
    static Bernstein of_powers(std::span<const double> a, double length,
                               std::pmr::memory_resource* memory = std::pmr::get_default_resource());

    /// Where it rises through `level`, in order, each in a bracket of its own; in the memory of b. Two roots closer than
    /// 1e-15 of the length may be missed.
    std::pmr::vector<Bracket> rises(double level = 0) const;
};

/// The time in a bracket at which a function rises through 0: Newton's method, with bisection if it would leave the
/// bracket. A bracket wider than `widest` is bisected first. at(t) returns a struct with members `value` and `rate`.
template <class At>
double root(Bracket bracket, const At& at, double widest = std::numeric_limits<double>::infinity()) {
    auto& [low, high] = bracket;
    while (high - low > widest) {
        const double middle = 0.5 * (low + high);
        (at(middle).value > 0 ? high : low) = middle;
    }
    double t = 0.5 * (low + high), before = high;
    for (int i = 0; i < 100 && t != before; ++i) {
        const auto now = at(t);
        if (now.value == 0) return t;
        (now.value < 0 ? low : high) = before = t;
        t -= now.value / now.rate;
        if (!(t >= low && t <= high)) t = 0.5 * (low + high);
    }
    return t;
}

}  // namespace doppel
