#include "base/error.hpp"
#include "base/machine.hpp"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <string>

// Complete commands as a user types them: CPU time of the program, and the elapsed time in "wall s".

namespace doppel {
namespace {

double cpu_of_children() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void figure(benchmark::State& state, const std::string& presets) {
    const auto out = std::filesystem::temp_directory_path() / "doppel-bench-figures";
    double waited = 0;
    for (auto _ : state) {
        std::filesystem::remove_all(out);
        const double cpu = cpu_of_children(), wall = seconds_of(CLOCK_MONOTONIC);
        const auto command =
            fmt::format("{} figure {} --out '{}' --progress none >/dev/null", DOPPEL_PROGRAM, presets, out.string());
        if (std::system(command.c_str()) != 0) throw method_failed("this command failed: {}", command);
        waited += seconds_of(CLOCK_MONOTONIC) - wall;
        state.SetIterationTime(cpu_of_children() - cpu);
    }
    std::filesystem::remove_all(out);
    state.counters["wall s"] = waited / static_cast<double>(state.iterations());
}

const bool registered = [] {
    const auto add = [](const std::string& name, const std::string& presets) {
        benchmark::RegisterBenchmark(("figure/" + name).c_str(),
                                     [presets](benchmark::State& state) { figure(state, presets); })
            ->Iterations(1)
            ->UseManualTime()
            ->Unit(benchmark::kSecond);
    };
    add("study", "fig2-left fig2-right fig3-left fig3-right fig4-left fig4-right fig5-left fig5-right fig6 fig7 fig8");
    for (const char* name :
         {"fig8", "flip-map", "lyapunov-spectrum", "droplet", "poincare", "stability", "drift", "speed-accuracy"})
        add(name, name);
    return true;
}();

}  // namespace
}  // namespace doppel
