#include "numeric/portable_math.hpp"

#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace doppel {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// ln 2 as a sum of two; the product of the first with a double's exponent is exact
constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;

/// z c_0 + z² c_1 + …
template <std::size_t count>
double polynomial(double z, const double (&c)[count]) {
    double sum = 0;
    for (std::size_t i = count; i-- > 0;) sum = (sum + c[i]) * z;
    return sum;
}

/// For t ≥ 0: atan t = atan c + atan((t − c) / (1 + c t)), with the nearest of five values c.
/// Source  the constants of fdlibm's s_atan.c (Sun Microsystems 1993)
double arctangent(double t) {
    static constexpr double even[]{3.33333333333329318027e-01, 1.42857142725034663711e-01, 9.09088713343650656196e-02,
                                   6.66107313738753120669e-02, 4.97687799461593236017e-02, 1.62858201153657823623e-02};
    static constexpr double odd[]{-1.99999999998764832476e-01, -1.11111104054623557880e-01, -7.69187620504482999495e-02,
                                  -5.83357013379057348645e-02, -3.65315727442169155270e-02};
    double high = 0, low = 0, x = t;  // atan c as a sum of two
    if (t >= 39.0 / 16) {
        high = 1.57079632679489655800e+00, low = 6.12323399573676603587e-17, x = -1 / t;
    } else if (t >= 19.0 / 16) {
        high = 9.82793723247329054082e-01, low = 1.39033110312309984516e-17, x = (t - 1.5) / (1 + 1.5 * t);
    } else if (t >= 11.0 / 16) {
        high = 7.85398163397448278999e-01, low = 3.06161699786838301793e-17, x = (t - 1) / (1 + t);
    } else if (t >= 7.0 / 16) {
        high = 4.63647609000806093515e-01, low = 2.26987774529616870924e-17, x = (2 * t - 1) / (2 + t);
    }
    const double square = x * x, fourth = square * square;
    double of_even = 0;
    for (std::size_t i = std::size(even); i-- > 0;) of_even = of_even * fourth + even[i];
    const double sum = square * of_even + polynomial(fourth, odd);
    return high - ((x * sum - low) - x);
}

}  // namespace

/// x = 2^k (1 + f) with √½ < 1 + f < √2, and log(1 + f) = 2 artanh s, s = f / (2 + f).
/// Source  the constants of fdlibm's e_log.c (Sun Microsystems 1993)
double portable_log(double x) {
    static constexpr double c[]{6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
                                2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
                                1.479819860511658591e-01};
    if (x == 0) return -infinity;
    if (!(x > 0) || x == infinity) return x > 0 ? x : std::numeric_limits<double>::quiet_NaN();
    int k = 0;
    double significand = std::frexp(x, &k);  // ½ ≤ … < 1
    if (significand < 0x1.6a09e667f3bcdp-1) {
        significand *= 2;
        --k;
    }
    const double f = significand - 1, s = f / (2 + f), half_square = 0.5 * f * f;
    const double rest = polynomial(s * s, c);
    return k * ln2_high - ((half_square - (s * (half_square + rest) + k * ln2_low)) - f);
}

/// e^x = 2^k e^r with |r| ≤ ½ ln 2, and e^r = 1 + 2r / (2 − c), where c is an even polynomial in r.
/// Source  the constants of fdlibm's e_exp.c (Sun Microsystems 1993)
double portable_exp(double x) {
    static constexpr double p[]{1.66666666666666019037e-01, -2.77777777770155933842e-03, 6.61375632143793436117e-05,
                                -1.65339022054652515390e-06, 4.13813679705723846039e-08};
    constexpr double by_ln2 = 1.44269504088896338700;
    if (std::isnan(x)) return x;
    if (x > 709.78) return infinity;
    if (x < -706) return 0;
    const int k = static_cast<int>(std::lround(x * by_ln2));
    const double high = x - k * ln2_high, low = k * ln2_low, r = high - low;
    const double c = r - polynomial(r * r, p);
    return std::ldexp(1 - ((low - r * c / (2 - c)) - high), k);
}

double portable_pow(double x, double y) {
    return portable_exp(y * portable_log(x));
}

double portable_atan2(double y, double x) {
    constexpr double pi_low = 1.2246467991473531772e-16, pi_high = 3.14159265358979311600;
    if (std::isnan(x) || std::isnan(y)) return x + y;
    const bool is_left = std::signbit(x);
    if (y == 0) return is_left ? std::copysign(pi_high, y) : y;
    const double width = std::abs(x), height = std::abs(y);
    if (width == 0 || height / width > 0x1p60) return std::copysign(pi_high / 2, y);
    const double angle = height == infinity && width == infinity ? pi_high / 4 : arctangent(height / width);
    return std::copysign(is_left ? pi_high - (angle - pi_low) : angle, y);
}

}  // namespace doppel
