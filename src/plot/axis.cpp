#include "plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace doppel {
std::string power_of_ten(int exponent) {
    constexpr std::string_view digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    if (exponent == 0) return "1";
    if (exponent == 1) return "10";
    std::string text = exponent < 0 ? "10⁻" : "10";
    for (const char digit : fmt::format("{}", std::abs(exponent))) text += digits[digit - '0'];
    return text;
}

double Axis::share(double value) const {
    if (low == high) return 0.5;
    // halves, so that no difference of finite values overflows
    if (!logarithmic) return (value / 2 - low / 2) / (high / 2 - low / 2);
    // a ratio beyond what a double holds is still a difference of logarithms
    const double part = value / low, whole = high / low;
    if (std::isnormal(part) && std::isnormal(whole)) return std::log(part) / std::log(whole);
    return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

float Axis::at(double value) const {
    const double reached = share(logarithmic ? std::max(value, std::min(low, high)) : value);
    return static_cast<float>(from + (to - from) * std::clamp(reached, 0.0, 1.0));
}

std::vector<Tick> decade_ticks(const Axis& axis, float label_px) {
    constexpr double slack = 1e-9;  // log10(0.001) may miss −3 by a rounding
    const int first = static_cast<int>(std::ceil(std::log10(axis.low) - slack));
    const int last = static_cast<int>(std::floor(std::log10(axis.high) + slack));
    const float decade = std::abs(axis.to - axis.from) / static_cast<float>(std::log10(axis.high / axis.low));
    const int every = std::max(1, static_cast<int>(std::ceil(label_px / decade)));
    std::vector<Tick> ticks;
    for (int exponent = first; exponent <= last; ++exponent)
        ticks.push_back({std::pow(10.0, exponent), exponent % every == 0 ? power_of_ten(exponent) : ""});
    return ticks;
}

std::vector<Tick> round_ticks(const Axis& axis, float label_px) {
    const double span = axis.high - axis.low;
    const double least = span * std::max(1.0f, label_px) / std::max(1.0f, std::abs(axis.to - axis.from));
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    double step = 10 * power;
    for (const double nice : {1.0, 2.0, 5.0})
        if (nice * power >= least) {
            step = nice * power;
            break;
        }
    std::vector<Tick> ticks;
    // none where no step is a number or the axis has no two values that it tells apart
    if (!(span > 0 && std::isfinite(span) && std::isnormal(step) && axis.high + step > axis.high)) return ticks;
    if (std::abs(axis.low) / step > 1e15 || std::abs(axis.high) / step > 1e15) return ticks;
    const auto first = static_cast<long>(std::ceil(axis.low / step - 1e-9));
    const auto last = static_cast<long>(std::floor(axis.high / step + 1e-9));
    for (long k = first; k <= last; ++k) {
        const double value = static_cast<double>(k) * step;
        ticks.push_back({value, fmt::format("{:.6g}", value)});
    }
    return ticks;
}

}  // namespace doppel
