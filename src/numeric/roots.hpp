#pragma once

#include <limits>
#include <span>
#include <vector>

namespace doppel {

/// Times between which something rises through 0: < 0 at `low`, ≥ 0 at `high`.
struct Bracket {
    double low, high;
};

/// A polynomial on 0 ≤ t ≤ length by its Bernstein coefficients, b_0 … b_n: it starts at b_0, ends at b_n, and stays
/// between the least and the greatest. It has no more roots there than the coefficients change sign, and as many but
/// for pairs (Descartes' rule); cut in halves until no more than one change is left, they tell all roots apart.
/// Source  Farin, Curves and Surfaces for CAGD, §5–6; Lane & Riesenfeld 1981, BIT 21:112.
struct Bernstein {
    std::vector<double> b;
    double length = 1;

    /// Of Σ a_i t^i.
    static Bernstein of_powers(std::span<const double> a, double length);

    /// Where it rises through `level`, in order, each in a bracket of its own. A pair of roots closer than 1e-15 of the
    /// length may be missed.
    std::vector<Bracket> rises(double level = 0) const;
};

/// The time within a bracket at which something rises through 0: Newton's method, halving where it would leave the
/// bracket; a bracket wider than `widest` is cut in halves first. at(t) gives the value and its rate, in members of these
/// names; where the value is 0 the time is found.
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
