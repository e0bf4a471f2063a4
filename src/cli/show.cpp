#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/print.hpp"
#include "scene/preset.hpp"

#include <unistd.h>

#include <memory>
#include <sstream>

namespace doppel {

namespace {

/// As it is into a file; a terminal gets lines that it can but show.
void show(const std::string& text) {
    if (!isatty(STDOUT_FILENO)) return write_out(text);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) print_line("{}", line);
}

}  // namespace

void add_show(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("show", "The TOML of a preset, a start for one of your own");
    command.footer("Example:\n  doppel show butterfly > mine.toml");
    command.add_option("PRESET", *name, "Name (see doppel list) or path")->required();
    command.callback([name] { show(find_preset(*name, &watch_interrupts()).text); });
}

}  // namespace doppel
