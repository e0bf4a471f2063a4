#pragma once

#include "integrate/flip_arc.hpp"
#include "integrate/flips_kernel.hpp"

namespace doppel {

/// Finds flips in lanes. As soon as a lane's pendulum has flipped, or its time is over, the next release takes its
/// place.
template <class Side>
class FlipLanes {
public:
    explicit FlipLanes(const FlipRequest& request) : request_(request) {}

    FlipOutcome run() {
        for (auto& group : groups_)
            for (int lane = 0; lane < Side::width; ++lane) {
                group.trial[lane] = none;
                take_next(group, lane);
            }
        while (busy_ > 0) {
            if (request_.stop->load(std::memory_order_relaxed)) return FlipOutcome::stopped;
            for (int i = 0; i < steps_between_looks; ++i) step();
        }
        return broken_ ? FlipOutcome::broken : FlipOutcome::found;
    }

private:
    using Series = FlipSeries<Side>;
    using Arc = FlipArc<Series::order, Side>;
    using Point = typename Arc::Point;

    static constexpr int registers = 2;  // while one waits for its results the other works
    static constexpr int steps_between_looks = 64;
    static constexpr double least_step = 1e-9;  // s; where no more is allowed the numbers have broken down
    static constexpr std::size_t none = ~std::size_t(0);

    struct Group {
        Series series;
        Side time;  // s, since the release
        std::size_t trial[Side::width];
    };

    [[gnu::always_inline]] void step() {
        for (auto& group : groups_) group.series.start(request_.chain);
        for (int k = 0; k < Series::order; ++k)
            for (auto& group : groups_) group.series.extend(request_.chain, k);
        for (auto& group : groups_) finish(group);
    }

    /// To the end of the step, with a closer look at the lanes where something may happen on the way.
    [[gnu::always_inline]] void finish(Group& group) {
        auto& now = group.series.term[0];
        const Side h = group.series.step(request_.allowed, request_.longest);
        const auto end = group.series.at(h);
        const Side after = group.time + h;
        const auto dull = (reach(h, now.theta[0], end.theta[0], now.omega[0], end.omega[0]) < Side(pi)) &
                          (reach(h, now.theta[1], end.theta[1], now.omega[1], end.omega[1]) < Side(pi)) &
                          (after < Side(request_.duration)) & (h > Side(least_step));
        bool done[Side::width] = {};
        const bool all_dull = all_of(dull);
        if (!all_dull)
            for (int lane = 0; lane < Side::width; ++lane) done[lane] = is_done(group, lane, h[lane], end);
        for (int i = 0; i < 2; ++i) {
            now.theta[i] = end.theta[i];
            now.omega[i] = end.omega[i];
        }
        group.time = after;
        if (!all_dull)
            for (int lane = 0; lane < Side::width; ++lane)
                if (done[lane]) take_next(group, lane);
    }

    /// As FlipArc::may_flip, for all lanes.
    [[gnu::always_inline]] static Side reach(const Side& h, const Side& theta, const Side& theta_end, const Side& omega,
                                             const Side& omega_end) {
        return greater(abs(theta), abs(theta_end)) + Side(0.5) * h * greater(abs(omega), abs(omega_end));
    }

    /// Whether a lane's pendulum flips in this step or comes to the end of its time; which is noted.
    bool is_done(const Group& group, int lane, double h, const typename Series::Ends& end) {
        if (group.trial[lane] == none) return false;
        const double first = first_flip(group, 0, lane, h, end), second = first_flip(group, 1, lane, h, end);
        const double flip = group.time[lane] + (second < first ? second : first);
        const bool breaks = !(h > least_step);
        if (!(flip <= group.time[lane] + h) && group.time[lane] + h < request_.duration && !breaks) return false;
        broken_ |= breaks;
        request_.times[group.trial[lane]] = flip <= request_.duration ? flip : Arc::never;
        return true;
    }

    /// s after the start of the step
    double first_flip(const Group& group, int rod, int lane, double h, const typename Series::Ends& end) const {
        const auto& term = group.series.term;
        const Point from{0, term[0].theta[rod][lane], term[0].omega[rod][lane]};
        const Point to{h, end.theta[rod][lane], end.omega[rod][lane]};
        if (!Arc::may_flip(from, to)) return Arc::never;
        Arc arc;
        for (int k = 0; k <= Series::order; ++k) {
            arc.theta[k] = term[k].theta[rod][lane];
            arc.omega[k] = term[k].omega[rod][lane];
        }
        return arc.first_flip(from, to);
    }

    /// Gives a lane the next release whose time is to be found; where there is none, one at rest that hangs.
    void take_next(Group& group, int lane) {
        if (group.trial[lane] != none) --busy_;
        while (next_ < request_.count && !(request_.times[next_] < 0)) ++next_;
        const bool is_left = next_ < request_.count;
        busy_ += is_left;
        group.trial[lane] = is_left ? next_ : none;
        group.time.set(lane, 0);
        auto& start = group.series.term[0];
        start.theta[0].set(lane, is_left ? request_.releases[next_].theta1 : 0);
        start.theta[1].set(lane, is_left ? request_.releases[next_].theta2 : 0);
        for (int i = 0; i < 2; ++i) start.omega[i].set(lane, is_left ? request_.omega[i] : 0);
        next_ += is_left;
    }

    FlipRequest request_;
    std::size_t next_ = 0;
    int busy_ = 0;  // lanes with a pendulum
    bool broken_ = false;
    Group groups_[registers];
};

}  // namespace doppel
