#include "plot/chart_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// The extent of the values on one axis.
class Extent {
public:
    explicit Extent(bool logarithmic) : logarithmic_(logarithmic) {}

    bool can_show(double value) const { return std::isfinite(value) && (value > 0 || !logarithmic_); }
    void add(double value) {
        if (!can_show(value)) return;
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }

    /// The range with a `margin` at either side, except for ends that `axis` sets.
    Axis range(const PlotAxis& axis, double margin) const {
        double low = low_, high = high_;
        if (!(low <= high)) low = logarithmic_ ? 1 : 0, high = logarithmic_ ? 10 : 1;
        // if the given end is on the wrong side of the values, the other is chosen beyond it
        if (axis.low && !axis.high) high = above(*axis.low, high), low = std::min(*axis.low, low);
        if (axis.high && !axis.low) low = below(*axis.high, low), high = std::max(*axis.high, high);
        if (low == high) low = below(low, low), high = above(high, high);
        if (logarithmic_) {
            const double part = std::pow(10.0, margin * (std::log10(high) - std::log10(low)));
            low = std::max(low / part, std::numeric_limits<double>::min());
            high = std::min(high * part, largest);
        } else {
            const double part = 2 * margin * (high / 2 - low / 2);
            low = low >= 0 && low < part ? 0 : std::max(low - part, -largest);
            high = std::min(high + part, largest);
        }
        Axis made{.low = axis.low.value_or(low), .high = axis.high.value_or(high), .logarithmic = logarithmic_};
        if (made.low == made.high) made.low = below(made.low, made.low), made.high = above(made.high, made.high);
        return made;
    }

private:
    /// `value`, or something a little larger than `limit`.
    double above(double limit, double value) const {
        if (value > limit) return value;
        return logarithmic_ ? std::min(limit * 3, largest)
               : limit == 0 ? 1
                            : std::min(limit + 0.1 * std::abs(limit), largest);
    }
    double below(double limit, double value) const {
        if (value < limit) return value;
        return logarithmic_ ? limit / 3 : limit == 0 ? -1 : std::max(limit - 0.1 * std::abs(limit), -largest);
    }

    bool logarithmic_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

}  // namespace

PlotRanges fitted_ranges(const Plot& plot) {
    Extent x(plot.x.logarithmic), y(plot.y.logarithmic), right(plot.right && plot.right->logarithmic);
    bool spread = !plot.map.has_value();
    for (const Curve& curve : plot.curves) {
        Extent& values = curve.right && plot.right ? right : y;
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
            if (!x.can_show(curve.x[i]) || !values.can_show(curve.y[i])) continue;
            x.add(curve.x[i]);
            values.add(curve.y[i]);
            if (curve.uncertainty.empty()) continue;
            values.add(curve.y[i] - std::abs(curve.uncertainty[i]));
            values.add(curve.y[i] + std::abs(curve.uncertainty[i]));
        }
    }
    for (const Rule& rule : plot.rules) (rule.orientation == Rule::Orientation::vertical ? x : y).add(rule.at);
    PlotRanges ranges{x.range(plot.x, spread ? 0.015 : 0), y.range(plot.y, spread ? 0.05 : 0), {}};
    if (plot.right) ranges.right = right.range(*plot.right, 0.05);
    return ranges;
}

MapScale::MapScale(const HeatMap& map) {
    Extent values(map.logarithmic);
    if (!map.low || !map.high)
        for (const float value : map.values) values.add(static_cast<double>(value));
    axis = values.range({.low = map.low, .high = map.high, .logarithmic = map.logarithmic}, 0);
    if (map.threshold) step = axis.share(*map.threshold);
}

Color MapScale::color(double share) const {
    constexpr double below = 0.3, above = 0.93;
    return map_color(!step ? share : share > *step ? above : below);
}

}  // namespace doppel
