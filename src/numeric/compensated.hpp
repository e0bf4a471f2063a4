#pragma once

#include <limits>

namespace doppel {

/// Adds `more` to sum + lost with almost no rounding error.
/// Source  Knuth, The Art of Computer Programming 2, §4.2.2.
template <class Scalar>
void add_compensated(Scalar& sum, Scalar& lost, const Scalar& more) {
    const Scalar all = more + lost, total = sum + all, part = total - sum;
    lost = (sum - (total - part)) + (all - part);
    sum = total;
}

/// A number as the sum of a scalar and its rounding error.
/// Source  Dekker 1971, A floating-point technique for extending the available precision, Numer. Math. 18:224.
template <class Scalar>
struct Compensated {
    Scalar value, rest;
};

template <class Scalar>
Compensated<Scalar> exact_difference(const Scalar& a, const Scalar& b) {
    const Scalar value = a - b, part = value - a;
    return {value, (a - (value - part)) - (b + part)};
}

template <class Scalar>
Compensated<Scalar> exact_product(const Scalar& a, const Scalar& b) {
    // 2^s + 1 for s bits of 2 s, or one less
    const Scalar splitter = Scalar(std::numeric_limits<Scalar>::digits > 64 ? 0x1p57 : 0x1p27) + Scalar(1);
    const auto high = [&](const Scalar& x) {
        const Scalar shifted = x * splitter;
        return Scalar(shifted - (shifted - x));
    };
    const Scalar value = a * b, a1 = high(a), a2 = a - a1, b1 = high(b), b2 = b - b1;
    return {value, ((a1 * b1 - value) + a1 * b2 + a2 * b1) + a2 * b2};
}

}  // namespace doppel
