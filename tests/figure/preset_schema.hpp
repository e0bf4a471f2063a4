#pragma once

#include <string>

namespace doppel::test {

/// The JSON schema (Draft 4) of presets, from the lists of keys: presets/preset.schema.json.
std::string preset_schema();

}  // namespace doppel::test
