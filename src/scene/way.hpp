#pragma once

#include "scene/cost_table.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace doppel {

/// One model and method for a side that asks for an accuracy, at any setting of its ladder: tolerances 1 or 3 times a
/// power of ten, or 1, 2, 3, 4, 6, 8, 12 … steps to a sample. A rung is one finer than the rung before.
class Way {
public:
    /// `time_unit` = √(l/g) or the like, s, in which the table measures steps.
    Way(const SideSpec& spec, const Rational& sample_hz, const MeasuredWay& measured, double time_unit);

    int start() const { return start_; }  // what the table suggests
    int loosest() const { return 0; }
    int finest() const { return finest_; }  // that the precision allows; with steps, some sixty times the table's
    const MethodEntry& method() const { return method_; }

    Side side(int rung) const;

private:
    SideSpec spec_;
    Rational sample_hz_;
    MethodEntry method_;
    int start_, finest_;
};

inline constexpr double finest_in_table = 1e-11;  // rad, that is asked of the table

/// The ways of the table that a side may take, cheapest first; more accurate ones than the table's are ordered as its
/// last.
std::vector<MeasuredWay> allowed_ways(const SideSpec& spec, double accuracy);

}  // namespace doppel
