#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

// What the manifests of films and of figures are made of.

using Json = nlohmann::ordered_json;

/// Files of a run: name, and where its bytes are now; a folder stands for all in it.
using RunFiles = std::vector<std::pair<std::string, std::filesystem::path>>;

Json json_of_toml(const std::string& toml);

/// Version and revision.
Json program_json();

/// Size and SHA-256 of each file. Throws Error (exit 4).
Json files_json(const RunFiles& files);

/// Throws Error (exit 4).
void write_json(const std::filesystem::path& path, const Json& json);

}  // namespace doppel
