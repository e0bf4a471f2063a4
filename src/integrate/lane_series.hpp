#pragma once

#include "integrate/series.hpp"
#include "physics/pendulum.hpp"

#include <memory>

namespace doppel {

/// The part of LaneSeries that is compiled for each register width (integrate/lane_series_width.cpp, with the rules of
/// integrate/batch_width.cpp). For orders up to 64.
class LaneRecurrence {
public:
    virtual ~LaneRecurrence();
    virtual void expand(const double* state) = 0;
    virtual void move(double h, double* change) const = 0;
    virtual const double* rates(int k) const = 0;  // ω_k of each link
};
/// For registers of `width` doubles. The caller deletes it.
template <int width>
LaneRecurrence* make_lane_recurrence(const Pendulum<double>& p, int order);
template <>
LaneRecurrence* make_lane_recurrence<2>(const Pendulum<double>& p, int order);
template <>
LaneRecurrence* make_lane_recurrence<4>(const Pendulum<double>& p, int order);

/// AngleSeries for two or three links of double, computed side by side in four lanes. It is several times as fast, and
/// has the same bits whether a register has 4 doubles or 2.
class LaneSeries final : public Series<double> {
public:
    /// `width` doubles per register, 2 or 4; 0: the wider of these that this processor has.
    LaneSeries(const Pendulum<double>& p, int order, int width = 0);

    void expand(const State& y) override;
    void move(const double& h, State& change) override { lanes_->move(h, change.data()); }
    double rate(int k, Eigen::Index link) const override { return lanes_->rates(k)[link]; }

private:
    double largest(int k) const override;  // |ω_k|

    std::size_t links_;
    std::unique_ptr<LaneRecurrence> lanes_;
};

}  // namespace doppel
