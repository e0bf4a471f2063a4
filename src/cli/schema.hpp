#pragma once

#include "scene/preset.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace doppel {

/// The first line of a preset in `folder`, "#:schema PATH\n": the schema in presets/ here, or else the one that is
/// installed with the program; empty where there is neither.
std::string schema_line(const std::filesystem::path& folder = ".");

/// The text of a preset that came with the program, with that line in place of its own.
std::string with_schema_line(const std::string& text);

/// What is wrong with the line of a preset's file: it names a file that is not there, or not this program's schema.
std::optional<std::string> schema_line_fault(const PresetText& preset);

}  // namespace doppel
