#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace doppel {

/// A fraction in lowest terms, denominator > 0. Used for times and rates that must divide each other exactly.
struct Rational {
    std::int64_t numerator = 0, denominator = 1;

    template <class Scalar>
    Scalar as() const {
        return Scalar(numerator) / Scalar(denominator);
    }
    double value() const { return as<double>(); }
    bool is_whole() const { return denominator == 1; }
    std::string text() const;  // "1/30000", "12"
    friend bool operator==(const Rational&, const Rational&) = default;
};

/// numerator / denominator in lowest terms; nothing if the denominator is 0.
std::optional<Rational> reduced(std::int64_t numerator, std::int64_t denominator);

/// Exact; nothing if a number exceeds 64 bits or the divisor is 0.
std::optional<Rational> product(const Rational& a, const Rational& b);
std::optional<Rational> quotient(const Rational& a, const Rational& b);

/// Parses "1/30000", "0.001", "2.5e-4" exactly. Nothing if the text is no number, or exceeds 64 bits.
std::optional<Rational> parse_rational(std::string_view text);

/// The decimal fraction given by the shortest digits of `value`: 0.1 becomes 1/10.
std::optional<Rational> rational_from_decimal(double value);

}  // namespace doppel
