#include "integrate/euler.hpp"
#include "integrate/runge_kutta.hpp"
#include "peers/chain_rate.hpp"
#include "physics/angle_chain.hpp"
#include "physics/pendulums.hpp"
#include "physics/physical_chain.hpp"
#include "physics/rod_chain.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <type_traits>
#include <vector>

// A thousand steps of one pendulum at 30 kHz, every link released at 90°: the µs shown equal ns per step.

namespace doppel {
namespace {

template <class Model>
auto released(std::size_t links) {
    const auto p = from_rest(std::vector(links, 90.0));
    if constexpr (std::is_same_v<Model, PhysicalChain<double>>) {
        auto bodies = rods(p);
        bodies.friction.viscous.assign(links, 0.01);
        return bodies;
    } else {
        return p;
    }
}

template <class Stepper, class Model>
void thousand_steps(const char* method, const char* model, std::size_t links) {
    const auto title = fmt::format("{}_{}/{}", model, links, method);
    benchmark::RegisterBenchmark(title.c_str(), [links](benchmark::State& state) {
        const auto p = released<Model>(links);
        Model pendulum(p);
        Stepper stepper(pendulum, Model::start(p), 1.0 / 30000);
        for (auto _ : state) {
            stepper.advance(1000);
            benchmark::DoNotOptimize(stepper.state());
        }
    })->Unit(benchmark::kMicrosecond);
}

template <class Model>
void all_methods(const char* model, std::size_t links) {
    thousand_steps<RungeKutta<Model, Euler::table>, Model>("euler, nothing incremental", model, links);
    thousand_steps<Euler::Stepper<Model>, Model>("euler", model, links);
    thousand_steps<Midpoint::Stepper<Model>, Model>("midpoint", model, links);
    thousand_steps<Rk4::Stepper<Model>, Model>("rk4", model, links);
}

/// Three links in the form a careful user of a library writes, for comparison.
struct ByHand {
    using Scalar = double;
    using State = doppel::State<double, 6>;

    ChainRate<3> chain;

    explicit ByHand(const Pendulum<double>& p) : chain(p) {}
    static State start(const Pendulum<double>& p) { return released_in_angles<double, 3>(p); }
    void rate(const State& y, State& dydt) { chain(y.data(), dydt.data()); }
};

const bool registered = [] {
    all_methods<DoublePendulum<double>>("angles", 2);
    all_methods<AngleChain<double, 3>>("angles", 3);
    all_methods<ByHand>("angles by hand", 3);
    all_methods<AngleChain<double, Eigen::Dynamic>>("angles", 8);
    for (const std::size_t links : {2, 3, 8}) all_methods<PhysicalChain<double>>("bodies", links);
    all_methods<RodChain<double, 2>>("constraints", 2);
    all_methods<RodChain<double, 3>>("constraints", 3);
    all_methods<RodChain<double, Eigen::Dynamic>>("constraints", 8);
    return true;
}();

}  // namespace
}  // namespace doppel
