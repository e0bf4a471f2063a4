#pragma once

#include "scene/cost_table.hpp"
#include "scene/scene.hpp"

#include <optional>

namespace doppel {

/// How finely to step: a tolerance, or steps to a sample.
struct Pace {
    double tolerance = 0;
    long steps = 1;
};

/// One model and method for a side that asks for an accuracy, at any setting. Tolerances are 1 or 3 times a power of
/// ten, steps to a sample 1, 2, 3, 4, 6, 8, 12 …
class Way {
public:
    /// `time_unit` = √(l/g) or the like, s, in which the table measures steps.
    Way(const SideSpec& spec, const Rational& sample_hz, const MeasuredWay& measured, double time_unit);

    /// What the table suggests.
    const Pace& start() const { return start_; }
    const MethodEntry& method() const { return method_; }

    Side side(const Pace& setting) const;
    /// Errs a thousandth as much, or as little as the precision allows; with steps, a sixteenth.
    Pace finer(const Pace& setting) const;
    /// A setting that errs about `factor` times as much, > or < 1; nothing where there is none, or it takes far more
    /// steps than the table's.
    std::optional<Pace> scaled(const Pace& setting, double factor) const;

private:
    SideSpec spec_;
    Rational sample_hz_;
    MethodEntry method_;
    double finest_, finest_check_;  // tolerances
    Pace start_;
};

inline constexpr double finest_in_table = 1e-11;  // rad, that is asked of the table

/// The ways of the table that a side may take, cheapest first.
std::vector<MeasuredWay> allowed_ways(const SideSpec& spec, double accuracy);

}  // namespace doppel
