#include "cli/commands.hpp"
#include "cli/options.hpp"

#include <memory>

namespace doppel {

void add_simulate(CLI::App& app) {
    auto options = std::make_shared<RunCommandOptions>();
    auto& command = *app.add_subcommand("simulate", "Runs presets without pictures: CSV and manifest, no OpenGL");
    command.footer("Example:\n  doppel simulate butterfly --set 'system.integrator=\"rk4\"'");
    add_run_options(command, *options, "Has no effect on a table");
    command.callback([options] {
        run_all(read_scenes(*options), *options, {.out = options->out, .pictures = false, .jobs = options->jobs});
    });
}

}  // namespace doppel
