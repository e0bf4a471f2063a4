#pragma once

#include "numeric/quad.hpp"
#include "numeric/sin_cos.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace doppel {

/// 256 bits, about 77 digits.
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<256, boost::multiprecision::digit_base_2, void, int>,
    boost::multiprecision::et_off>;

/// 2^−power, exact for 0 ≤ power ≤ 1074.
constexpr double half_to_the(int power) {
    return power == 0 ? 1 : half_to_the(power - 1) / 2;
}

/// At least x ≥ 0 after up to six operations of doubles ≥ 0, whatever the rounding mode; also if some were lost to
/// underflow.
constexpr double widened(double x) {
    return x * (1 + 0x1p-50) + 0x1p-960;
}

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
    /// The largest relative error of + − × / and √, rounded to nearest: 2⁻⁵³ for double.
    static constexpr double roundoff = half_to_the(std::numeric_limits<Scalar>::digits);

    Scalar center = Scalar(0);
    double radius = 0;

    Ball() = default;
    Ball(int exact) : Ball(Scalar(exact), 0) {}
    Ball(Scalar middle, double spread = 0) : center(std::move(middle)), radius(spread), center_size_(size_of(center)) {}
    /// In another precision.
    template <class Other, class OtherCount>
    explicit Ball(const Ball<Other, OtherCount>& other) requires(!std::is_same_v<Other, Scalar>)
        : Ball(Scalar(other.center), other.radius) {
        const Other rest = other.center - Other(center);  // exact
        if (rest != Other(0)) radius = widened(radius + Ball<Other>(rest).center_size());
    }

    /// At least |x| for every x in the ball.
    double size() const { return widened(center_size_ + radius); }
    /// At least the centre's size.
    double center_size() const { return center_size_; }
    /// At most |x| for every x in the ball; ≤ 0 if it contains 0.
    double least() const { return std::max(low(), -high()); }
    /// Doubles below and above all of the ball.
    double low() const { return bound(-1); }
    double high() const { return bound(1); }

    friend bool operator==(const Ball& a, const Ball& b) = default;
    /// An order of balls, not of their numbers.
    friend bool operator<(const Ball& a, const Ball& b) {
        return std::tie(a.center, a.radius) < std::tie(b.center, b.radius);
    }
    friend Ball operator+(const Ball& a, const Ball& b) { return rounded(a.center + b.center, a.radius + b.radius); }
    friend Ball operator-(const Ball& a, const Ball& b) { return rounded(a.center - b.center, a.radius + b.radius); }
    friend Ball operator-(const Ball& a) { return {Scalar(-a.center), a.radius}; }
    friend Ball operator*(const Ball& a, const Ball& b) {
        return rounded(a.center * b.center,
                       a.center_size_ * b.radius + b.center_size_ * a.radius + a.radius * b.radius);
    }
    /// b must not contain 0; the radius is infinite or NaN otherwise.
    friend Ball operator/(const Ball& a, const Ball& b) {
        // |a/b − c| ≤ (ra + |c| rb) / (|b| − rb), with the quotient c of the centres
        const Ball ratio(Scalar(a.center / b.center));
        const double least = b.least();
        return rounded(ratio.center, least > 0 ? widened(a.radius + ratio.center_size_ * b.radius) / least : INFINITY);
    }
    Ball& operator+=(const Ball& b) { return *this = *this + b; }
    Ball& operator-=(const Ball& b) { return *this = *this - b; }
    Ball& operator*=(const Ball& b) { return *this = *this * b; }
    /// Of the numbers ≥ 0 in a ball.
    friend Ball sqrt(const Ball& a) {
        using std::sqrt;
        if (!(a.least() > 0)) return {Scalar(0), widened(std::sqrt(a.size()))};
        // |√x − r| = |x − r²| / (√x + r)
        const Ball root(Scalar(sqrt(a.center))), least(Scalar(std::sqrt(a.least()) * (1 - 0x1p-50)));
        return {root.center, ((a - root * root) / (root + least)).size()};
    }
    /// With whatever is missing from a sum, at most `more` in size.
    Ball widened_by(double more) const { return {center, widened(radius + more)}; }

private:
    static double size_of(const Scalar& x) {
        const double nearest = static_cast<double>(x);
        return widened(nearest < 0 ? -nearest : nearest);
    }
    static Ball rounded(Scalar center, double spread) {
        Ball ball(std::move(center), 0);
        const double rounding = Count::rounding * 2 * roundoff * ball.center_size_;
        ball.radius = widened(spread + rounding);
        return ball;
    }
    double bound(int side) const {
        const Ball<double, Count> nearest(*this);
        if (nearest.radius == 0) return nearest.center;
        return nearest.center + side * widened(nearest.radius + 0x1p-52 * std::abs(nearest.center));
    }

    double center_size_ = 0;
};

/// The ball of a decimal literal, "-90.003" or "6.674e-11", read within two units in the last place. With more than 33
/// characters it stands for all numbers that have the same quad.
inline Ball<Wide> ball_of_decimal(const std::string& text) {
    const Ball<Wide> nearest{Wide(text)};
    if (nearest.center == Wide(0)) return nearest;
    constexpr std::size_t exact_digits = 33;
    return nearest.widened_by(4 * nearest.size() *
                              (text.size() > exact_digits ? Ball<Quad>::roundoff : Ball<Wide>::roundoff));
}

/// π, from its first 80 digits.
template <class B>
B pi_ball() {
    static const B known(
        Ball<Wide>(Wide("3.1415926535897932384626433832795028841971693993751058209749445923078164062862089"), 1e-76));
    return known;
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
        cos = sums[0].widened_by(rest);
        sin = sums[1].widened_by(rest);
        for (int turns = quarter & 3; turns > 0; --turns) sin = std::exchange(cos, -sin);
    }
};

}  // namespace doppel
