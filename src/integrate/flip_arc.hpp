#pragma once

#include "numeric/lanes.hpp"
#include "numeric/state.hpp"

#include <limits>

namespace doppel {

/// The motion of one rod within one step: the series of its angle and of its rate. `Build`: see Lanes.
template <int order, class Build>
struct FlipArc {
    static constexpr double never = std::numeric_limits<double>::infinity();

    double theta[order + 1], omega[order + 1];

    struct Point {
        double t, theta, omega;  // s, rad, rad/s
    };
    Point at(double t) const {
        Point p{t, theta[order], omega[order]};
        for (int k = order - 1; k >= 0; --k) {
            p.theta = p.theta * t + theta[k];
            p.omega = p.omega * t + omega[k];
        }
        return p;
    }

    /// Whether |θ| may exceed π between two points. Where it turns between them it gains no more than the greater rate
    /// makes in half the time.
    static bool may_flip(const Point& from, const Point& to) {
        return greater(size(from.theta), size(to.theta)) +
                   0.5 * (to.t - from.t) * greater(size(from.omega), size(to.omega)) >
               pi;
    }

    /// When |θ| first exceeds π between two points, s; infinity where it does not. Halves what may hold a flip: until
    /// none hides before it, and on where a rod turns, so that one that turns back at once is found as well.
    double first_flip(const Point& from, const Point& to, int halved = 0) const {
        if (!may_flip(from, to)) return never;
        if (halved >= 5 && size(to.theta) > pi) return root(from, to);
        if (halved == 24 || (halved >= 5 && !turns_back(from, to))) return never;
        const Point middle = at(0.5 * (from.t + to.t));
        const double before = first_flip(from, middle, halved + 1);
        return before <= middle.t ? before : first_flip(middle, to, halved + 1);
    }

private:
    static double size(double x) { return x < 0 ? -x : x; }
    static bool turns_back(const Point& from, const Point& to) {
        return from.theta * from.omega > 0 && to.theta * to.omega < 0;
    }

    /// Where |θ| = π between two points on either side: Newton's method, halving where it would leave them.
    double root(Point below, Point beyond) const {
        const double flip = beyond.theta < 0 ? -pi : pi;
        double t = 0.5 * (below.t + beyond.t), before = beyond.t;
        for (int i = 0; i < 100 && t != before; ++i) {
            const Point here = at(t);
            (size(here.theta) > pi ? beyond : below) = here;
            before = t;
            t -= (here.theta - flip) / here.omega;
            if (!(t >= below.t && t <= beyond.t)) t = 0.5 * (below.t + beyond.t);
        }
        return t;
    }
};

}  // namespace doppel
