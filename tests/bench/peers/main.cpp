#include "base/error.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"
#include "figure/run.hpp"
#include "library_chart.hpp"
#include "peers.hpp"

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>

#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>

namespace doppel {
namespace {

/// The processor's name and the month: times have no meaning without them.
std::string where_and_when() {
    std::ifstream about("/proc/cpuinfo");
    const std::string key = "model name";
    std::string processor = "an unnamed processor";
    for (std::string line; std::getline(about, line);)
        if (line.starts_with(key) && line.find(": ") != std::string::npos) {
            processor = line.substr(line.find(": ") + 2);
            break;
        }
    for (const std::string word : {"(R)", "(TM)", " CPU", " Processor"})
        for (auto at = processor.find(word); at != std::string::npos; at = processor.find(word))
            processor.erase(at, word.size());
    return fmt::format("{}, {:%B %Y}", processor, fmt::localtime(std::time(nullptr)));
}

/// A work-precision chart like that of `doppel figure`, but of the methods of other libraries.
void make_figure(const RunCommandOptions& options) {
    std::vector<FigurePreset> figures{
        library_chart(find_preset(options.presets.front()), overrides_of(options), all_peers())};
    figures[0].name += "-libraries";
    figures[0].title += fmt::format(": other libraries, on {}", where_and_when());
    ProgressReport show(progress_style(options.progress), figures[0].name, figures[0].experiment->unit());
    const FigureReport report{[&](std::size_t, const FigureProgress& progress) {
                                  show({std::lround(progress.done), std::lround(progress.total)});
                              },
                              [&](std::size_t, const std::string& sentence) { show.note(sentence); },
                              [&](std::size_t, const RunResult& result) { show.done(result); }};
    try {
        run_figures(figures, {.out = options.out, .jobs = options.jobs}, watch_interrupts(), report);
    } catch (...) {
        show.clear();
        throw;
    }
}

int failed(ExitCode code, const char* message) {
    fmt::print(stderr, "doppel-peers: {}\n", message);
    return static_cast<int>(code);
}

}  // namespace
}  // namespace doppel

int main(int argc, char** argv) {
    using namespace doppel;
    try {
        CLI::App app(
            "Speed against accuracy: a chart of methods of Boost.odeint, GSL and SUNDIALS, beside the best of "
            "Doppel's.",
            "doppel-peers");
        RunCommandOptions options;
        add_run_options(app, options, "Threads that compute what is not timed");
        app.get_option("PRESET")->required(false)->expected(1);
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            if (error.get_exit_code() == 0) return app.exit(error);
            return failed(ExitCode::bad_input, fmt::format("{}; see doppel-peers --help", error.what()).c_str());
        }
        if (options.presets.empty()) options.presets = {"speed-accuracy"};
        make_figure(options);
        return static_cast<int>(ExitCode::done);
    } catch (const Error& error) {
        return failed(error.code(), error.what());
    } catch (const std::exception& error) {
        return failed(ExitCode::io_failed, error.what());
    }
}
