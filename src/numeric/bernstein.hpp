#pragma once

#include <span>
#include <vector>

namespace doppel {

/// A polynomial on 0 … 1 by its Bernstein coefficients, b_0 … b_n: it starts at b_0, ends at b_n, and stays between the
/// least and the greatest. It has no more roots there than the coefficients change sign, and as many but for pairs
/// (Descartes' rule); cut in halves until no more than one change is left, they tell all roots apart.
/// Source  Farin, Curves and Surfaces for CAGD, §5–6; Lane & Riesenfeld 1981, BIT 21:112.
struct Bernstein {
    std::vector<double> b;

    /// Of Σ a_i t^i on 0 ≤ t ≤ length.
    static Bernstein of_powers(std::span<const double> a, double length);

    /// Where it rises through 0, in order: each between the two, as parts of 0 … 1, with the value < 0 at the first and
    /// ≥ 0 at the second. A pair of roots closer than 1e-15 may be missed.
    struct Bracket {
        double low, high;
    };
    std::vector<Bracket> rises() const;
};

}  // namespace doppel
