#include "integrate/batch.hpp"
#include "integrate/widths.hpp"
#include "physics/pendulums.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

// A thousand steps of 64 trials in batches at 30 kHz, for each register width of this processor; `ns` is for one step
// of one trial.

namespace doppel {
namespace {

constexpr std::size_t trials = 64;

/// Released between 60° and 120°, so that neighbours move differently.
std::vector<Pendulum<double>> released(std::size_t links) {
    std::vector<Pendulum<double>> all;
    for (std::size_t i = 0; i < trials; ++i) all.push_back(from_rest(std::vector(links, 60 + static_cast<double>(i))));
    return all;
}

void thousand_steps(benchmark::State& state, Model model, std::size_t links, const char* method, int width) {
    Batch ensemble(released(links), model, method, 1.0 / 30000, width);
    for (auto _ : state) ensemble.advance(1000);
    state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * 1e-6 * trials,
                                              benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// The steps between two samples of a figure: 1/120 s.
void thousand_pendulums(benchmark::State& state) {
    std::vector<Pendulum<double>> all;
    while (all.size() < 1000)
        for (const auto& one : released(2)) all.push_back(one);
    all.resize(1000);
    Batch ensemble(all, Model::angles, "euler", 1.0 / 30000);
    for (auto _ : state) ensemble.advance(250);
}
BENCHMARK(thousand_pendulums)->Name("lanes/thousand_pendulums")->Unit(benchmark::kMicrosecond);

const bool registered = [] {
    for (const char* method : {"euler", "rk4"})
        for (const int width : register_widths())
            for (const auto& [name, model] :
                 {std::pair("angles", Model::angles), std::pair("constraints", Model::constraints)})
                for (const std::size_t links : {2u, 3u}) {
                    const auto title = fmt::format("lanes/{}/{}_{}/width_{}", method, name, links, width);
                    benchmark::RegisterBenchmark(title.c_str(), thousand_steps, model, links, method, width)
                        ->Unit(benchmark::kMicrosecond);
                }
    return true;
}();

}  // namespace
}  // namespace doppel
