#include "cli/commands.hpp"
#include "scene/preset.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace doppel {

void add_list(CLI::App& app) {
    app.add_subcommand("list", "The presets and their titles")->callback([] {
        const auto presets = builtin_presets();
        std::size_t width = 0;
        for (const auto& preset : presets) width = std::max(width, preset.name.size());
        for (const auto& preset : presets) fmt::print("{:<{}}  {}\n", preset.name, width, read_preset(preset).title);
    });
}

}  // namespace doppel
