#include "numeric/rational.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <utility>

namespace doppel {
namespace {

__extension__ using Long = __int128;

/// In lowest terms, if these fit.
std::optional<Rational> fraction(Long numerator, Long denominator) {
    if (denominator == 0) return std::nullopt;
    Long divisor = numerator, rest = denominator;
    while (rest != 0) divisor = std::exchange(rest, divisor % rest);
    if ((divisor < 0) != (denominator < 0)) divisor = -divisor;
    numerator /= divisor;
    denominator /= divisor;
    constexpr Long largest = std::numeric_limits<std::int64_t>::max();
    if (numerator > largest || -numerator > largest || denominator > largest) return std::nullopt;
    return Rational{static_cast<std::int64_t>(numerator), static_cast<std::int64_t>(denominator)};
}

/// [+-]digits[.digits][e[+-]digits], exactly.
std::optional<Rational> parse_decimal(std::string_view text) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    const auto e = text.find_first_of("eE");
    std::string digits(text.substr(0, e));
    int exponent = 0;
    if (e != std::string_view::npos) {
        text.remove_prefix(e + 1);
        if (text.starts_with('+')) text.remove_prefix(1);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
        if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
        if (exponent < -1000 || exponent > 1000) return std::nullopt;
    }
    if (const auto point = digits.find('.'); point != std::string::npos) {
        digits.erase(point, 1);
        exponent -= static_cast<int>(digits.size() - point);
    }
    if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;

    Long numerator = 0, denominator = 1;
    const auto append = [](Long& number, int digit) {
        return !__builtin_mul_overflow(number, 10, &number) && !__builtin_add_overflow(number, digit, &number);
    };
    for (const char digit : digits)
        if (!append(numerator, digit - '0')) return std::nullopt;
    for (; exponent != 0 && numerator != 0; exponent -= exponent > 0 ? 1 : -1)
        if (!append(exponent > 0 ? numerator : denominator, 0)) return std::nullopt;
    return fraction(negative ? -numerator : numerator, denominator);
}

}  // namespace

std::string Rational::text() const {
    return is_whole() ? fmt::format("{}", numerator) : fmt::format("{}/{}", numerator, denominator);
}

std::optional<Rational> reduced(std::int64_t numerator, std::int64_t denominator) {
    return fraction(numerator, denominator);
}

std::optional<Rational> product(const Rational& a, const Rational& b) {
    return fraction(Long(a.numerator) * b.numerator, Long(a.denominator) * b.denominator);
}

std::optional<Rational> quotient(const Rational& a, const Rational& b) {
    return fraction(Long(a.numerator) * b.denominator, Long(a.denominator) * b.numerator);
}

std::optional<Rational> parse_rational(std::string_view text) {
    const auto slash = text.find('/');
    if (slash == std::string_view::npos) return parse_decimal(text);
    const auto above = parse_decimal(text.substr(0, slash));
    const auto below = parse_decimal(text.substr(slash + 1));
    return above && below ? quotient(*above, *below) : std::nullopt;
}

std::optional<Rational> rational_from_decimal(double value) {
    return parse_decimal(fmt::format("{}", value));
}

}  // namespace doppel
