#pragma once

#include <stdexcept>

namespace doppel {

/// A decimal constant with 32 digits: the sum of two doubles that do not overlap. For published coefficients that are
/// used in both quad and double.
struct Decimal {
    double high = 0, low = 0;

    constexpr Decimal operator-() const { return {-high, -low}; }
};

namespace literals {

/// For example 0.0526001519587677318785587544488016_d; digits and one point, at most 36 of them.
consteval Decimal operator""_d(const char* text) {
    __extension__ using Whole = unsigned __int128;  // 38 digits

    Whole digits = 0, scale = 1;
    bool point = false;
    for (; *text != '\0'; ++text) {
        if (*text == '.') {
            point = true;
            continue;
        }
        if (*text < '0' || *text > '9' || digits > Whole(-1) / 20 || scale > Whole(-1) / 40)
            throw std::invalid_argument("a _d literal is made of no more than 36 digits and a point");
        digits = 10 * digits + static_cast<Whole>(*text - '0');
        if (point) scale *= 10;
    }
    if (digits == 0) return {};

    // the leading power of two of the quotient, then its bits by long division
    double bit = 1;
    while (digits / 2 >= scale) scale *= 2, bit *= 2;
    while (digits < scale) digits *= 2, bit /= 2;
    Decimal value;
    for (int i = 0; i < 106; ++i) {
        if (digits >= scale) {
            digits -= scale;
            (i < 53 ? value.high : value.low) += bit;
        }
        digits *= 2;
        bit /= 2;
    }
    return value;
}

}  // namespace literals
}  // namespace doppel
