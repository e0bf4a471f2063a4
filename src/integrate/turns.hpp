#pragma once

#include "integrate/motion.hpp"
#include "physics/bob.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace doppel {

/// The whole turns of the rods of a chain whose state is (x1, y1, x2, y2 …): places tell angles only up to turns, so
/// they are followed from one look to the next, which may be no further apart than half a turn.
class Turns {
public:
    static constexpr double longest_unwatched = 1.0 / 500;  // s; half a turn in it would be 1570 rad/s

    Turns() = default;
    /// From the angles of the rods, rad, with all their turns.
    explicit Turns(const std::vector<double>& angles) {
        for (const double angle : angles) {
            const SinCos<double> turn(angle);
            rods_.push_back({turn.sin, -turn.cos, std::round((angle - std::atan2(turn.sin, turn.cos)) / (2 * pi))});
        }
    }

    bool followed() const { return !rods_.empty(); }

    /// An angle jumps from π to −π where its rod comes by the top from the right.
    template <class State>
    void look(const State& places) {
        using Scalar = typename State::Scalar;
        for (std::size_t i = 0; i < rods_.size(); ++i) {
            const auto q = 2 * static_cast<Eigen::Index>(i);
            const double x = static_cast<double>(i == 0 ? places[q] : Scalar(places[q] - places[q - 2]));
            const double y = static_cast<double>(i == 0 ? places[q + 1] : Scalar(places[q + 1] - places[q - 1]));
            auto& [old_x, old_y, turns] = rods_[i];
            const double turned = old_x * y - old_y * x;  // > 0 counter-clockwise
            const bool was_left = std::signbit(old_x), left = std::signbit(x);
            if (!was_left && left && turned > 0) turns += 1;
            if (was_left && !left && turned < 0) turns -= 1;
            old_x = x;
            old_y = y;
        }
    }

    /// Adds them to the angles of bobs, within (−π, π], seen at the last look.
    void add_to(Bobs<double>& bobs) const {
        for (std::size_t i = 0; i < rods_.size(); ++i)
            if (rods_[i].turns != 0) bobs[i].theta += 2 * pi * rods_[i].turns;
    }

private:
    struct Rod {
        double x, y;   // where it points
        double turns;  // counter-clockwise
    };
    std::vector<Rod> rods_;
};

/// The steps of a fixed step that are taken in one go, of a state of so many numbers: few enough that an interruption
/// is noticed, and that no turn is lost where turns are followed.
inline long steps_in_one_go(const MotionSpec& spec, Eigen::Index dimensions, bool follows_turns) {
    constexpr long most = 200'000;
    const double step = spec.sample_interval.value() / static_cast<double>(spec.steps_per_sample);
    const long steps = std::max(1L, most / static_cast<long>(dimensions));
    return follows_turns ? std::min(steps, std::max(1L, static_cast<long>(Turns::longest_unwatched / step))) : steps;
}

}  // namespace doppel
