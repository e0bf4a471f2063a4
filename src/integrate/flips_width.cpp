// Compiled once for each register width, with the rules of integrate/batch_width.cpp.

#include "integrate/flips_kernel.hpp"
#include "numeric/state.hpp"

#include <cmath>
#include <limits>

namespace doppel {
namespace {

/// Finds flips in lanes. When the pendulum of a lane has flipped, or its time is over, the next release takes the lane.
template <class Pack>
class FlipLanes {
public:
    explicit FlipLanes(const FlipRequest& request) : request_(request) {}

    bool run() {
        for (auto& group : groups_)
            for (int lane = 0; lane < Pack::width; ++lane) {
                group.trial[lane] = none;
                take_next(group, lane);
            }
        while (busy_ > 0) {
            if (request_.stop->load(std::memory_order_relaxed)) return false;
            for (int i = 0; i < steps_between_checks; ++i) step();
        }
        return true;
    }

private:
    using Series = FlipSeries<Pack>;

    static constexpr int registers = 2;  // one is computed while the other waits for results
    static constexpr int steps_between_checks = 64;
    static constexpr double min_step = 1e-9;  // s; if only less is allowed, the run has failed
    static constexpr double never = std::numeric_limits<double>::infinity();
    static constexpr double broken = std::numeric_limits<double>::quiet_NaN();
    static constexpr std::size_t none = ~std::size_t(0);
    struct Group {
        FlipChain<Pack> chain;
        Series series;
        Pack time;  // s, since the release
        std::size_t trial[Pack::width];
    };

    [[gnu::always_inline]] void step() {
        for (auto& group : groups_) group.series.start(group.chain);
        for (int k = 0; k < flip_order; ++k)
            for (auto& group : groups_) group.series.extend(group.chain, k);
        for (auto& group : groups_) finish(group);
    }

    /// Moves to the end of the step. Lanes whose rods may flip in it, or whose time ends, are examined.
    [[gnu::always_inline]] void finish(Group& group) {
        auto& now = group.series.term[0];
        const Pack h = group.series.step(request_.allowed, group.chain.longest);
        const auto end = group.series.at(h);
        const Pack after = group.time + h;
        const Pack reach1 = reach(h, now.theta[0], end.theta[0], now.omega[0], end.omega[0]);
        const Pack reach2 = reach(h, now.theta[1], end.theta[1], now.omega[1], end.omega[1]);
        const auto dull =
            (reach1 < Pack(pi)) & (reach2 < Pack(pi)) & (after < Pack(request_.duration)) & (Pack(min_step) < h);
        bool done[Pack::width] = {};
        const bool all_dull = all_of(dull);
        if (!all_dull)
            for (int lane = 0; lane < Pack::width; ++lane) {
                const double first = reach1[lane] > pi ? flip_of(group, 0, lane, h[lane], end) : never;
                const double second = reach2[lane] > pi ? flip_of(group, 1, lane, h[lane], end) : never;
                done[lane] = is_done(group, lane, h[lane], second < first ? second : first);
            }
        for (int i = 0; i < 2; ++i) {
            now.theta[i] = end.theta[i];
            now.omega[i] = end.omega[i];
        }
        group.time = after;
        if (!all_dull)
            for (int lane = 0; lane < Pack::width; ++lane)
                if (done[lane]) take_next(group, lane);
    }

    /// An upper bound of |θ| in a step: if the rod turns back, it moves no further than the larger rate does in half
    /// the time.
    [[gnu::always_inline]] static Pack reach(const Pack& h, const Pack& theta, const Pack& theta_end, const Pack& omega,
                                             const Pack& omega_end) {
        return greater(abs(theta), abs(theta_end)) + Pack(0.5) * h * greater(abs(omega), abs(omega_end));
    }

    /// Whether the pendulum of a lane flips in this step, `flip` s after its start, or its time ends; stores the
    /// result.
    bool is_done(const Group& group, int lane, double h, double flip) {
        if (group.trial[lane] == none) return false;
        const double time = group.time[lane] + flip;
        const bool breaks = !(h > min_step);
        if (!(time <= group.time[lane] + h) && group.time[lane] + h < request_.duration && !breaks) return false;
        request_.times[group.trial[lane]] = time <= request_.duration ? time : breaks ? broken : never;
        return true;
    }

    static double flip_of(const Group& group, int rod, int lane, double h, const typename Series::Ends& end) {
        RodOnStep on_step{.h = h, .theta = {}, .omega = {}, .theta_end = end.theta[rod][lane]};
        for (int k = 0; k <= flip_order; ++k) {
            on_step.theta[k] = group.series.term[k].theta[rod][lane];
            on_step.omega[k] = group.series.term[k].omega[rod][lane];
        }
        return first_flip(on_step);
    }

    /// Gives a lane the next release whose time is to be found, or a hanging pendulum at rest.
    void take_next(Group& group, int lane) {
        if (group.trial[lane] != none) --busy_;
        while (next_ < request_.count && !(request_.times[next_] < 0)) ++next_;
        const bool is_left = next_ < request_.count;
        busy_ += is_left;
        group.trial[lane] = is_left ? next_ : none;
        group.time.set(lane, 0);
        const auto& p = is_left ? request_.pendulums[next_] : *request_.hanging;
        const double l1 = p.length[0], l2 = p.length[1], ratio = p.mass[0] / p.mass[1], longer = l2 / l1;
        const double swing = std::sqrt((l2 < l1 ? l2 : l1) / std::abs(p.gravity));  // s, natural time of a rod
        group.chain.gravity.set(lane, p.gravity / l1);
        group.chain.ratio.set(lane, ratio);
        group.chain.masses.set(lane, 1 + ratio);
        group.chain.longer.set(lane, longer);
        group.chain.minus_by_longer.set(lane, -1 / longer);
        group.chain.longest.set(lane, request_.duration < swing ? request_.duration : swing);
        auto& now = group.series.term[0];
        for (std::size_t i = 0; i < 2; ++i) {
            now.theta[i].set(lane, p.angle[i]);
            now.omega[i].set(lane, p.rate[i]);
        }
        next_ += is_left;
    }

    FlipRequest request_;
    std::size_t next_ = 0;
    int busy_ = 0;  // lanes with a pendulum
    Group groups_[registers];
};

struct ThisBuild;

}  // namespace

template <>
bool find_flips<compiled_width>(const FlipRequest& request) {
    return FlipLanes<Lanes<compiled_width, ThisBuild>>(request).run();
}

}  // namespace doppel
