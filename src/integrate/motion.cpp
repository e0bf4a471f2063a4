#include "integrate/motion.hpp"

#include "integrate/methods.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/error.hpp"
#include "physics/double_pendulum.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// A model knows its angles only up to whole turns if it is built of particles: they are followed from one look to the
/// next, which may be no further apart than half a turn.
constexpr double longest_unwatched = 1.0 / 500;  // s; half a turn in it would be 1570 rad/s

template <class Mechanism, const auto& table>
class Stepped : public Motion {
public:
    Stepped(const Pendulum& pendulum, double step)
        : model_(pendulum),
          state_(Mechanism::start(pendulum)),
          step_(step),
          watch_(std::max(1L, static_cast<long>(longest_unwatched / step))),
          turns_{pendulum.angle} {}

    void advance(long steps) override {
        while (steps > 0) {
            const long now = std::min(steps, watch_);
            auto y = state_;  // here, so that the compiler keeps it in registers
            for (long i = 0; i < now; ++i) y = doppel::step<table>(model_, y, step_);
            state_ = y;
            steps -= now;
            follow_turns(model_.bobs(state_));
        }
    }

    Observation observe() const override {
        Observation seen{model_.bobs(state_), 0, model_.length_error(state_)};
        seen.energy = energy(seen.bobs, model_.g);
        for (std::size_t i = 0; i < link_count; ++i) seen.bobs[i].theta = unwrapped(seen.bobs[i].theta, turns_[i]);
        return seen;
    }

private:
    /// The angle that is `theta` up to whole turns and nearest to `near`.
    static double unwrapped(double theta, double near) {
        const double turns = std::round((near - theta) / (2 * pi));
        return turns == 0 ? theta : theta + 2 * pi * turns;
    }

    void follow_turns(const Bobs<double>& bobs) {
        for (std::size_t i = 0; i < link_count; ++i) turns_[i] = unwrapped(bobs[i].theta, turns_[i]);
    }

    Mechanism model_;
    typename Mechanism::State state_;
    double step_;                           // s
    long watch_;                            // steps between two looks at the angles
    std::array<double, link_count> turns_;  // the angles at the last look, unwrapped, rad
};

template <class Mechanism>
std::unique_ptr<Motion> stepped(std::string_view method, const Pendulum& pendulum, double step) {
    std::unique_ptr<Motion> motion;
    for_each_method([&]<const auto & table>() {
        if (table.name == method) motion = std::make_unique<Stepped<Mechanism, table>>(pendulum, step);
    });
    if (!motion) throw bad_input("there is no method \"{}\"", method);
    return motion;
}

}  // namespace

std::unique_ptr<Motion> make_motion(Model model, std::string_view method, const Pendulum& pendulum, double step) {
    return model == Model::angles ? stepped<DoublePendulum<double>>(method, pendulum, step)
                                  : stepped<RodChain<double>>(method, pendulum, step);
}

}  // namespace doppel
