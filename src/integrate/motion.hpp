#pragma once

#include "physics/pendulum.hpp"

#include <memory>
#include <string_view>

namespace doppel {

/// The state of a pendulum at one sample, the same for every model.
struct Observation {
    Bobs<double> bobs;        // angles unwrapped
    double energy = 0;        // J
    double length_error = 0;  // of the worst rod, m
};

/// A mechanism that moves, as the sample loop sees it. Virtual, because it is asked 120 times a second; the steps
/// inside advance(), 30 000 times a second, are a template behind this door.
class Motion {
public:
    virtual ~Motion() = default;
    virtual void advance(long steps) = 0;
    virtual Observation observe() const = 0;
};

enum class Model { angles, constraints };

/// The model, stepped by the method of that name with steps of `step` seconds, released as `pendulum` says.
/// Throws Error (exit 2) where no method has that name.
std::unique_ptr<Motion> make_motion(Model model, std::string_view method, const Pendulum& pendulum, double step);

}  // namespace doppel
