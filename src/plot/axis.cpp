#include "plot/axis.hpp"

#include "render/typeface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
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
    // halves, so that the difference of finite values cannot overflow
    if (!logarithmic) return (value / 2 - low / 2) / (high / 2 - low / 2);
    // a ratio that overflows a double is still a difference of logarithms
    const double part = value / low, whole = high / low;
    if (std::isnormal(part) && std::isnormal(whole)) return std::log(part) / std::log(whole);
    return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

float Axis::at(double value) const {
    const double reached = share(logarithmic ? std::max(value, std::min(low, high)) : value);
    return static_cast<float>(from + (to - from) * std::clamp(reached, 0.0, 1.0));
}

namespace {

/// The value multiple · 10^exponent.
struct Step {
    long long multiple = 1;
    int exponent = 0;

    long double value() const { return static_cast<long double>(multiple) * std::pow(10.0L, exponent); }
    double times(long long k) const {
        const auto whole = static_cast<long double>(k * multiple), power = std::pow(10.0L, std::abs(exponent));
        return static_cast<double>(exponent < 0 ? whole / power : whole * power);
    }
};

/// The decimals of number · 10^exponent.
std::string decimal(long long number, int exponent) {
    const double size = Step{std::abs(number), exponent}.times(1);
    return fmt::format("{}{:.{}f}", number < 0 ? "−" : "", size, std::max(0, -exponent));
}

/// The largest k with 10^k ≤ value.
int decade_below(long double value) {
    return static_cast<int>(std::floor(std::log10(value)));
}

/// The label of k steps, on an axis whose largest value is `maximum`.
std::string tick_text(const Step& step, long long k, double maximum) {
    const long long number = k * step.multiple;
    if (number == 0) return step.exponent < 0 && maximum < 1e6 && maximum >= 1e-4 ? decimal(0, step.exponent) : "0";
    if (maximum >= 1e-4 && maximum < 1e6) return decimal(number, step.exponent);
    const int power = decade_below(maximum);
    return fmt::format("{} × {}", decimal(number, step.exponent - power), power_of_ten(power));
}

bool is_named(const Tick& tick) {
    return !tick.text.empty();
}

/// Whether labels and ticks are far enough apart.
bool fits(const std::vector<Tick>& ticks, const Axis& axis, const TickLabels& labels) {
    const Tick* before = nullptr;
    for (const Tick& tick : ticks) {
        if (!is_named(tick)) continue;
        if (before) {
            const float distance = std::abs(axis.at(tick.value) - axis.at(before->value));
            const float need = (labels.length(before->text) + labels.length(tick.text)) / 2 + labels.gap;
            if (tick.text == before->text || distance < std::max(need, labels.spacing)) return false;
        }
        before = &tick;
    }
    return true;
}

/// All multiples of the step on the axis; none if there are too many to be distinct.
std::vector<Tick> multiples(const Step& step, double low, double high) {
    constexpr long double maximum = 1e15L;  // steps; doubles still distinguish k from k + 1
    const long double width = step.value(), from = std::ceil(low / width), to = std::floor(high / width);
    if (!(std::abs(from) * step.multiple < maximum && std::abs(to) * step.multiple < maximum && to - from < 1000))
        return {};
    const double reach = std::max(std::abs(low), std::abs(high));
    std::vector<Tick> ticks;
    // rounding in the division may have missed an end
    for (auto k = static_cast<long long>(from) - 1; k <= static_cast<long long>(to) + 1; ++k)
        if (const double value = step.times(k); value >= low && value <= high)
            ticks.push_back({value, tick_text(step, k, reach)});
    return ticks;
}

/// The value > 0, to ten digits.
Step step_of(double value) {
    Step step{.exponent = decade_below(value) - 9};
    step.multiple = std::llround(value / std::pow(10.0L, step.exponent));
    for (; step.multiple % 10 == 0; step.multiple /= 10) ++step.exponent;
    return step;
}

std::vector<Tick> linear_ticks(const Axis& axis, const TickLabels& labels, std::optional<double> every) {
    const double low = std::min(axis.low, axis.high), high = std::max(axis.low, axis.high);
    const long double span = static_cast<long double>(high) - low;
    const float room = std::abs(axis.to - axis.from);
    if (!(span > 0 && room > 0)) return {};
    // the requested step, or up to 64 times it
    const Step asked = step_of(every.value_or(1));
    for (long long times = 1; every && times <= 64; times *= 2) {
        auto ticks = multiples({asked.multiple * times, asked.exponent}, low, high);
        if (ticks.size() >= 2 && fits(ticks, axis, labels)) return ticks;
    }
    // otherwise the smallest step that fits
    const long double minimum = span * std::max(1.0f, labels.spacing) / room;
    std::vector<Step> steps;
    for (int exponent = decade_below(minimum) - 1; exponent <= decade_below(span) + 1; ++exponent)
        for (const long long nice : {1, 2, 5}) steps.push_back({nice, exponent});
    std::vector<Tick> single;
    for (const Step& step : steps) {
        if (step.value() < 0.999999L * minimum) continue;
        auto ticks = multiples(step, low, high);
        if (!fits(ticks, axis, labels)) continue;
        if (ticks.size() >= 2) return ticks;
        if (ticks.size() > single.size()) single = std::move(ticks);
    }
    // better than a single label: the first and the last of the largest step whose ends are far enough apart
    constexpr std::size_t many = 12;  // ticks that would be a grey band
    std::ranges::reverse(steps);
    for (const Step& step : steps) {
        auto ticks = multiples(step, low, high);
        for (std::size_t i = 1; i + 1 < ticks.size(); ++i) ticks[i].text = "";
        if (ticks.size() > many) ticks.erase(ticks.begin() + 1, ticks.end() - 1);
        if (ticks.size() >= 2 && fits(ticks, axis, labels)) return ticks;
    }
    return single;
}

/// Ticks at the given multiples of each decade, with their labels.
template <class Text>
std::vector<Tick> multiples_of_decades(double low, double high, std::span<const long long> factors, const Text& text) {
    std::vector<Tick> ticks;
    for (int exponent = decade_below(low); exponent <= decade_below(high); ++exponent)
        for (const long long factor : factors)
            if (const double value = Step{factor, exponent}.times(1); value >= low && value <= high)
                ticks.push_back({value, text(factor, exponent)});
    return ticks;
}

/// Ticks at all decades, with a label at every n-th; if there is space, also unlabelled ticks inside the decades.
std::vector<Tick> decades(const Axis& axis, double low, double high, int every) {
    constexpr std::array<long long, 9> inside{1, 2, 3, 4, 5, 6, 7, 8, 9};
    const int count = decade_below(high) - decade_below(low) + 1;
    const bool is_wide = std::abs(axis.to - axis.from) > 28 * static_cast<float>(count);
    return multiples_of_decades(low, high, std::span(inside).first(is_wide ? 9 : 1),
                                [&](long long factor, int exponent) {
                                    return factor == 1 && exponent % every == 0 ? power_of_ten(exponent) : "";
                                });
}

std::vector<Tick> logarithmic_ticks(const Axis& axis, const TickLabels& labels) {
    const double low = std::min(axis.low, axis.high), high = std::max(axis.low, axis.high);
    if (!(low > 0 && low < high)) return {};
    const double span = std::log10(high) - std::log10(low);
    const auto subdivided = [&](const std::vector<long long>& factors) {
        return multiples_of_decades(low, high, factors, [&](long long factor, int exponent) {
            if (low >= 1e-4 && high < 1e6) return decimal(factor, exponent);
            const auto power = power_of_ten(exponent);
            return factor == 1 ? power : fmt::format("{} × {}", factor, power);
        });
    };
    std::vector<std::vector<Tick>> all;  // in the order of preference
    if (span < 2) all.push_back(subdivided({1, 2, 5}));
    for (const int n : {1, 2, 3, 5, 10, 20, 30, 50, 100, 200})
        if (span >= 1) all.push_back(decades(axis, low, high, n));
    if (span < 2) all.push_back(subdivided({1, 3}));
    // the first and the last decade, or 1, 2 or 5 times one
    for (auto ticks : {decades(axis, low, high, 1), subdivided({1, 2, 5})}) {
        std::erase_if(ticks, [](const Tick& tick) { return !is_named(tick); });
        if (ticks.size() > 2) ticks.erase(ticks.begin() + 1, ticks.end() - 1);
        all.push_back(std::move(ticks));
    }
    for (auto& ticks : all)
        if (std::ranges::count_if(ticks, is_named) >= 2 && fits(ticks, axis, labels)) return std::move(ticks);
    return linear_ticks(axis, labels, {});
}

}  // namespace

float TickLabels::length(const std::string& text) const {
    return across ? text_width(text, size) : size;
}

Tick tick_at(double value) {
    if (value == 0) return {0, "0"};
    return {value, tick_text(step_of(std::abs(value)), value < 0 ? -1 : 1, std::abs(value))};
}

std::vector<Tick> chart_ticks(const Axis& axis, const TickLabels& labels, std::optional<double> every) {
    if (!std::isfinite(axis.low) || !std::isfinite(axis.high)) return {};
    return axis.logarithmic ? logarithmic_ticks(axis, labels) : linear_ticks(axis, labels, every);
}

std::vector<Tick> spaced_ticks(const Axis& axis, bool across, float em, std::optional<double> every,
                               const std::vector<Tick>& own) {
    const float length = std::abs(axis.to - axis.from);
    // in small charts the numbers are closer together
    const float spacing = across ? std::max(length / 15, std::min(3.6f * em, length / 4))
                                 : std::max({length / 11, std::min(2.4f * em, length / 5), 1.6f * em});
    TickLabels labels{.size = em, .gap = (across ? 1.1f : 0.5f) * em, .spacing = 0, .across = across};
    if (!own.empty() && fits(own, axis, labels)) return own;
    labels.spacing = spacing;
    auto ticks = chart_ticks(axis, labels, every);
    if (across || std::ranges::count_if(ticks, is_named) >= 2) return ticks;
    labels.spacing = 1.15f * em;  // two lines of text are better than one
    labels.gap = 0;
    return chart_ticks(axis, labels, every);
}

DisplayList axis_items(const Axis& axis, const std::vector<Tick>& ticks, const Area& area, const Area& within,
                       const AxisStyle& style) {
    const bool across = style.edge == AxisStyle::Edge::bottom, right = style.edge == AxisStyle::Edge::right;
    const float em = style.em,
                edge = across  ? area.bottom
                       : right ? area.right
                               : area.left,
                out = across || right ? 1 : -1;
    DisplayList list;
    const auto add_line = [&](float at, float from, float to, Color color) {
        if (!(style.line > 0)) return;
        const auto [low, high] = std::minmax(from, to);
        list.push_back(across ? vertical_line(at, low, high, style.line, color)
                              : horizontal_line(at, low, high, style.line, color));
    };
    const auto last = std::find_if(ticks.rbegin(), ticks.rend(), is_named);
    for (const Tick& tick : ticks) {
        const float at = axis.at(tick.value);
        const bool named = is_named(tick);
        if (named && style.has_grid)
            add_line(at, across ? area.top : area.left, across ? area.bottom : area.right, style.grid);
        add_line(at, edge, edge + out * (named ? 0.34f : 0.18f) * em, style.frame);
        if (!named || !style.has_numbers) continue;
        if (!across) {
            list.push_back(label(tick.text, {edge + out * 0.55f * em, at + 0.36f * em}, em, style.text,
                                 right ? Align::left : Align::right));
            continue;
        }
        // the number is centred below its tick; a unit follows it
        const std::string unit = &tick == &*last ? style.unit : "";
        const float half = text_width(tick.text, em) / 2, end = half + text_width(unit, em);
        if (at - half < within.left - 0.5f || at + end > within.right + 0.5f) continue;
        list.push_back(label(tick.text + unit, {unit.empty() ? at : at + end, edge + 1.45f * em}, em, style.text,
                             unit.empty() ? Align::center : Align::right));
    }
    return list;
}

}  // namespace doppel
