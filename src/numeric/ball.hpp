#pragma once

#include "numeric/quad.hpp"
#include "numeric/sin_cos.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace doppel {

/// 256 bits, about 77 digits.
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<256, boost::multiprecision::digit_base_2, void, int>,
    boost::multiprecision::et_off>;

/// The largest relative error of + − × / and √, rounded to nearest.
template <class Scalar>
inline constexpr double unit_roundoff = 0x1p-53;
template <>
inline constexpr double unit_roundoff<Quad> = 0x1p-113;
template <>
inline constexpr double unit_roundoff<Wide> = 0x1p-256;

/// At least x ≥ 0 after up to six operations of doubles ≥ 0, whatever the rounding mode; also if some were lost to
/// underflow.
constexpr double widened(double x) {
    return x * (1 + 0x1p-50) + 0x1p-960;
}

/// A number ≥ 0 that is rounded up.
struct UpperBound {
    double value = 0;

    UpperBound() = default;
    UpperBound(double x) : value(x) {}
    friend UpperBound operator+(const UpperBound& a, const UpperBound& b) { return widened(a.value + b.value); }
    friend UpperBound operator*(const UpperBound& a, const UpperBound& b) { return widened(a.value * b.value); }
    UpperBound& operator+=(const UpperBound& b) { return *this = *this + b; }
};

/// What a ball counts; all of it for a proof. Tests leave parts out to see that they are needed.
struct Counted {
    static constexpr double rounding = 1, series_remainder = 1;
};

/// All real numbers within `radius` of `center`. The results of + − × / √ contain those of all numbers in the operands:
/// rounding is counted by widening the radius. Only the operations of Scalar, rounded to nearest, are relied upon, no
/// rounding mode and no function of a library.
/// Source  Moore, Interval Analysis, 1966; van der Hoeven, Ball arithmetic, 2009.
template <class Scalar, class Count = Counted>
struct Ball {
    static constexpr double roundoff = unit_roundoff<Scalar>;
    using InWide = Ball<Wide, Count>;

    Scalar center = Scalar(0);
    double radius = 0;

    Ball() = default;
    Ball(int exact) : center(exact) {}
    Ball(const Scalar& exact) requires(!std::is_same_v<Scalar, int>) : center(exact) {}
    Ball(Scalar middle, double spread) : center(std::move(middle)), radius(spread) {}
    /// In another precision.
    template <class Other>
    explicit Ball(const Ball<Other, Count>& other) requires(!std::is_same_v<Other, Scalar>)
        : Ball(rounded(Scalar(other.center), other.radius)) {}

    /// At least |x| for every x in the ball.
    double size() const { return widened(center_size() + radius); }
    /// At least the centre's size.
    double center_size() const { return size_of(center); }
    /// At most |x| for every x in the ball; ≤ 0 if it contains 0.
    double least() const {
        const double least = std::abs(static_cast<double>(center)) * (1 - 0x1p-50) - radius;
        return least > 0 ? least * (1 - 0x1p-50) : least;
    }
    /// Doubles below and above all of the ball.
    double low() const { return bound(-1); }
    double high() const { return bound(1); }

    friend Ball operator+(const Ball& a, const Ball& b) { return rounded(a.center + b.center, a.radius + b.radius); }
    friend Ball operator-(const Ball& a, const Ball& b) { return rounded(a.center - b.center, a.radius + b.radius); }
    friend Ball operator-(const Ball& a) { return {Scalar(-a.center), a.radius}; }
    friend Ball operator*(const Ball& a, const Ball& b) {
        return rounded(a.center * b.center,
                       a.center_size() * b.radius + b.center_size() * a.radius + a.radius * b.radius);
    }
    /// b must not contain 0; the radius is infinite or NaN otherwise.
    friend Ball operator/(const Ball& a, const Ball& b) {
        // |a/b − c| ≤ (ra + |c| rb) / (|b| − rb), with the quotient c of the centres
        const Scalar ratio = a.center / b.center;
        const double least = b.least();
        return rounded(ratio, least > 0 ? widened(a.radius + size_of(ratio) * b.radius) / least : INFINITY);
    }
    Ball& operator+=(const Ball& b) { return *this = *this + b; }
    Ball& operator-=(const Ball& b) { return *this = *this - b; }
    Ball& operator*=(const Ball& b) { return *this = *this * b; }
    /// Of a ball of numbers > 0.
    friend Ball sqrt(const Ball& a) {
        using std::sqrt;
        // |√x − r| = |x − r²| / (√x + r) ≤ |x − r²| / r
        const Ball root(Scalar(sqrt(a.center))), error = (a - root * root) / root;
        return {root.center, error.size()};
    }
    /// With whatever is missing from a sum, at most `more` in size.
    Ball widened_by(double more) const { return {center, widened(radius + more)}; }

private:
    static double size_of(const Scalar& x) {
        const double nearest = static_cast<double>(x);
        return widened(nearest < 0 ? -nearest : nearest);
    }
    static Ball rounded(Scalar center, double spread) {
        const double rounding = Count::rounding * 2 * unit_roundoff<Scalar> * size_of(center);
        return {std::move(center), widened(spread + rounding)};
    }
    double bound(int side) const {
        const double nearest = static_cast<double>(center);
        const Scalar rest = center - Scalar(nearest);
        if (radius == 0 && rest == Scalar(0)) return nearest;
        return nearest + side * widened(widened(radius + size_of(rest)) + 0x1p-52 * std::abs(nearest));
    }
};

/// The ball of a decimal literal, "-90.003" or "6.674e-11". Beyond 33 digits it stands for all numbers that have the
/// same quad.
template <class B>
B ball_of_decimal(std::string_view text) {
    B digits(0), scale(1);
    int exponent = 0, count = 0;
    bool is_negative = false, after_point = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '-') is_negative = true;
        if (c == '.') after_point = true;
        if (c >= '0' && c <= '9') {
            digits = digits * B(10) + B(c - '0');
            exponent -= after_point ? 1 : 0;
            count += count > 0 || c != '0' ? 1 : 0;
        }
        if (c == 'e' || c == 'E') {
            exponent += std::stoi(std::string(text.substr(i + 1)));
            break;
        }
    }
    if (count == 0) return B(0);
    for (int i = 0; i < std::abs(exponent); ++i) scale *= B(10);
    const B size = exponent < 0 ? digits / scale : digits * scale;
    constexpr int exact_digits = 33;
    const B value = count > exact_digits ? size.widened_by(size.size() * 4 * unit_roundoff<Quad>) : size;
    return is_negative ? -value : value;
}

/// π = 16 atan(1/5) − 4 atan(1/239), Machin 1706
template <class Target>
const Target& pi_ball() {
    static const Target pi = [] {
        using B = typename Target::InWide;
        const auto atan_of_inverse = [](int n) {
            // Σ ±1 / ((2k + 1) n^(2k+1)); alternating, so the rest is below its first term
            B power = B(1) / B(n), sum(0);
            for (int k = 0;; ++k) {
                const B term = power / B(2 * k + 1);
                if (term.size() < 1e-3 * B::roundoff) return sum.widened_by(term.size());
                sum += k % 2 == 0 ? term : -term;
                power = power / B(n * n);
            }
        };
        return Target(B(16) * atan_of_inverse(5) - B(4) * atan_of_inverse(239));
    }();
    return pi;
}

template <class Scalar, class Count>
struct SinCos<Ball<Scalar, Count>> {
    using B = Ball<Scalar, Count>;
    B sin, cos;

    /// By Taylor's series around 0 after subtracting quarter turns. The rest of a series is below |y|ⁿ/n!.
    explicit SinCos(const B& angle) {
        const double quarters = std::round(static_cast<double>(angle.center) / (M_PI / 2));
        if (!(std::abs(quarters) < 1e6)) {
            sin = cos = {Scalar(0), 1.0};  // all there is
            return;
        }
        const int quarter = static_cast<int>(quarters);
        const B reduced = angle - B(quarter) * (pi_ball<B>() / B(2)), y(reduced.center);
        B term(1), sums[2] = {B(0), B(0)};  // of cosine and sine
        int n = 0;
        for (; term.size() > 1e-3 * B::roundoff; ++n, term = term * y / B(n)) sums[n % 2] += n % 4 < 2 ? term : -term;
        const double rest = Count::series_remainder * widened(2 * term.size() + reduced.radius);
        const B c = sums[0].widened_by(rest), s = sums[1].widened_by(rest);
        const int turns = quarter & 3;
        sin = turns == 0 ? s : turns == 1 ? c : turns == 2 ? -s : -c;
        cos = turns == 0 ? c : turns == 1 ? -s : turns == 2 ? -c : s;
    }
};

}  // namespace doppel

template <class Scalar, class Count>
struct Eigen::NumTraits<doppel::Ball<Scalar, Count>> : Eigen::GenericNumTraits<doppel::Ball<Scalar, Count>> {
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 2,
        AddCost = 10,
        MulCost = 20
    };
};
