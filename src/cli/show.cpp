#include "cli/commands.hpp"
#include "scene/preset.hpp"

#include <fmt/format.h>

#include <memory>

namespace doppel {

void add_show(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("show", "The TOML of a preset, a start for one of your own");
    command.footer("Example:\n  doppel show butterfly > mine.toml");
    command.add_option("PRESET", *name, "Name (see doppel list) or path")->required();
    command.callback([name] { fmt::print("{}", find_preset(*name).text); });
}

}  // namespace doppel
