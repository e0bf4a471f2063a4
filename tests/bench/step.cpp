#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "numeric/state.hpp"

#include <benchmark/benchmark.h>

// A thousand steps of one pendulum, P1 (90/90 at 30 kHz): the µs shown are ns a step.

namespace doppel {
namespace {

void thousand_steps(benchmark::State& state, Model model, std::string_view method) {
    Pendulum p;
    p.angle = {radians(90), radians(90)};
    auto motion = make_motion(model, method, p, 1.0 / 30000);
    for (auto _ : state) motion->advance(1000);
}

BENCHMARK_CAPTURE(thousand_steps, angles_euler, Model::angles, "euler")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(thousand_steps, angles_rk4, Model::angles, "rk4")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(thousand_steps, constraints_euler, Model::constraints, "euler")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(thousand_steps, constraints_rk4, Model::constraints, "rk4")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace doppel
