#pragma once

#include "integrate/motion.hpp"
#include "numeric/portable_math.hpp"
#include "physics/bob.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace doppel {

/// Counts the whole turns of a chain's rods for the state (x1, y1, x2, y2 … vx1, vy1 …). Positions only give angles
/// modulo turns, so the angles are tracked from state to state by the rates.
class Turns {
public:
    static constexpr double longest = 1.0 / 500;  // s
    static constexpr double largest_turn = 0.5;   // rad

    Turns() = default;
    /// From the angles of the rods, rad, including turns.
    explicit Turns(const std::vector<double>& angles) {
        for (const double angle : angles) {
            const SinCos<double> turn(angle);
            const double within = portable_atan2(turn.sin, turn.cos);
            rods_.push_back({within, 0, std::round((angle - within) / (2 * pi))});
        }
    }

    bool followed() const { return !rods_.empty(); }

    /// Updates the turns for a state `seconds` after the previous one; 0 for the release.
    template <class State>
    void update(const State& y, double seconds) {
        fastest_ = 0;
        for (std::size_t i = 0; i < rods_.size(); ++i) {
            const auto q = 2 * static_cast<Eigen::Index>(i), v = y.size() / 2 + q;
            const auto along = [&](Eigen::Index of) {
                using Scalar = typename State::Scalar;
                return static_cast<double>(i == 0 ? y[of] : Scalar(y[of] - y[of - 2]));
            };
            const double x = along(q), height = along(q + 1);
            const double angle = portable_atan2(x, -height);
            const double rate = (x * along(v + 1) - height * along(v)) / (x * x + height * height);
            auto& rod = rods_[i];
            rod.turns += std::round((rod.angle + turned(rod.rate, rate, seconds) - angle) / (2 * pi));
            rod.angle = angle;
            rod.rate = rate;
            fastest_ = std::max(fastest_, std::abs(rate));
        }
    }

    /// The longest allowed time to the next update(), s.
    double longest_interval() const { return std::min(longest, largest_turn / fastest_); }

    /// Adds the turns to the angles of bobs, within (−π, π], at the last update().
    template <class Scalar>
    void add_to(Bobs<Scalar>& bobs) const {
        for (std::size_t i = 0; i < rods_.size(); ++i)
            if (rods_[i].turns != 0) bobs[i].theta += Scalar(2) * pi_of<Scalar>() * Scalar(rods_[i].turns);
    }

private:
    struct Rod {
        double angle;  // rad, within (−π, π]
        double rate;   // rad/s
        double turns;  // counter-clockwise
    };

    /// The rotation of a rod, rad, to within half a turn. If the rates at both ends differ too much, as for a rod that
    /// swings to and fro, the shorter way is assumed.
    static double turned(double before, double after, double seconds) {
        const bool agree = std::abs(after - before) * seconds < 2 * largest_turn;
        return agree ? 0.5 * (before + after) * seconds : 0;
    }

    std::vector<Rod> rods_;
    double fastest_ = 0;  // rad/s, at the last update()
};

/// The number of fixed steps to take at a time, for a state of this dimension: few enough that an interruption is
/// noticed.
inline long steps_in_one_go(Eigen::Index dimensions) {
    constexpr long maximum = 200'000;
    return std::max(1L, maximum / static_cast<long>(dimensions));
}

/// The number of steps until turns must be updated.
inline long steps_within(double longest_interval, double step) {
    return std::max(1L, static_cast<long>(longest_interval / step));
}

}  // namespace doppel
