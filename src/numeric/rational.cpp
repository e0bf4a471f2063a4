#include "numeric/rational.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <limits>
#include <numeric>

namespace doppel {

std::string Rational::text() const {
    return is_whole() ? fmt::format("{}", numerator) : fmt::format("{}/{}", numerator, denominator);
}

std::optional<Rational> reduced(std::int64_t numerator, std::int64_t denominator) {
    constexpr auto lowest = std::numeric_limits<std::int64_t>::min();
    if (denominator == 0 || numerator == lowest || denominator == lowest) return std::nullopt;
    if (denominator < 0) {
        numerator = -numerator;
        denominator = -denominator;
    }
    const auto divisor = std::gcd(numerator, denominator);
    return Rational{numerator / divisor, denominator / divisor};
}

std::optional<Rational> product(const Rational& a, const Rational& b) {
    // reduces crosswise first, so that only products that do not fit are refused
    const auto left = reduced(a.numerator, b.denominator);
    const auto right = reduced(b.numerator, a.denominator);
    if (!left || !right) return std::nullopt;
    Rational result;
    if (__builtin_mul_overflow(left->numerator, right->numerator, &result.numerator) ||
        __builtin_mul_overflow(left->denominator, right->denominator, &result.denominator))
        return std::nullopt;
    return result;
}

std::optional<Rational> quotient(const Rational& a, const Rational& b) {
    const auto inverse = reduced(b.denominator, b.numerator);
    return inverse ? product(a, *inverse) : std::nullopt;
}

namespace {

/// [+-]digits[.digits][e[+-]digits], exactly.
std::optional<Rational> parse_decimal(std::string_view text) {
    Rational result;
    std::size_t at = 0;
    const bool negative = at < text.size() && text[at] == '-';
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;

    // all digits as one whole number, and the number of decimals
    int exponent = 0;
    bool any = false, point = false;
    for (; at < text.size() && text[at] != 'e' && text[at] != 'E'; ++at) {
        const char c = text[at];
        if (c == '.' && !point) {
            point = true;
            continue;
        }
        if (!std::isdigit(static_cast<unsigned char>(c))) return std::nullopt;
        if (__builtin_mul_overflow(result.numerator, 10, &result.numerator) ||
            __builtin_add_overflow(result.numerator, c - '0', &result.numerator))
            return std::nullopt;
        exponent -= point;
        any = true;
    }
    if (!any) return std::nullopt;

    if (at < text.size()) {
        int written = 0;
        auto digits = text.substr(at + 1);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), written);
        if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
        if (written < -1000 || written > 1000) return std::nullopt;
        exponent += written;
    }
    if (negative) result.numerator = -result.numerator;
    for (; exponent > 0 && result.numerator != 0; --exponent)
        if (__builtin_mul_overflow(result.numerator, 10, &result.numerator)) return std::nullopt;
    for (; exponent < 0 && result.numerator != 0; ++exponent)
        if (result.numerator % 10 == 0)
            result.numerator /= 10;
        else if (__builtin_mul_overflow(result.denominator, 10, &result.denominator))
            return std::nullopt;
    return reduced(result.numerator, result.denominator);
}

}  // namespace

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
