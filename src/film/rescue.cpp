#include "film/rescue.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace doppel {
namespace {

/// Whether the side comes to `sample`; `effort` ← what it took.
bool holds(const Scene& scene, const Side& side, const BreakDown& fault, const std::atomic<bool>& stop,
           Effort& effort) {
    SideRun run(scene, side, fault.side);
    try {
        for (long sample = 0; sample <= fault.sample; ++sample) {
            run.next(stop);
            effort = run.effort();
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed && error.code() != ExitCode::interrupted) throw;
        return false;
    }
    return true;
}

}  // namespace

std::string step_that_holds(const Scene& scene, const BreakDown& fault, const std::atomic<bool>& stop) {
    auto side = fault.side == 'a' ? scene.a : scene.b;
    Effort effort;
    if (side.method.adaptive) {
        holds(scene, side, fault, stop, effort);
        if (effort.smallest_step == 0) return "not even a first step held";
        return fmt::format("the smallest step that held was {:.3g} s; a smaller tolerance may hold",
                           effort.smallest_step);
    }
    auto finest = side.step;                 // that was tried
    constexpr long most_steps = 20'000'000;  // a few seconds for a double pendulum
    for (int halvings = 1; halvings < 40 && !stop; ++halvings) {
        const auto half = quotient(side.step, {2, 1});
        if (!half) break;
        side.step = *half;
        side.motion.steps_per_sample *= 2;
        const auto bobs = static_cast<long>(side.mass.size());
        if (side.motion.steps_per_sample > most_steps / (bobs * std::max(1L, fault.sample))) break;
        if (holds(scene, side, fault, stop, effort))
            return fmt::format("halved until it held: step_s = \"{}\" comes further", side.step.text());
        finest = side.step;
    }
    return fmt::format("no step down to {} s held", finest.text());
}

}  // namespace doppel
