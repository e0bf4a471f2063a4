#pragma once

#include "output/transaction.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace doppel {

// What the manifests of films and of figures are made of.

using Json = nlohmann::ordered_json;

Json json_of_toml(const std::string& toml);

/// Version and revision.
Json program_json();

/// Adds the files of the run, those that are finished, and those of earlier runs that stay, with size and SHA-256; then
/// writes the manifest as the last of them, "NAME.json". Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, Json manifest);

}  // namespace doppel
