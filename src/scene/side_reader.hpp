#pragma once

#include "scene/preset.hpp"
#include "scene/toml_reader.hpp"

namespace doppel {

/// Reads [system], [a] or [b]: whatever `side` has already stays where the table does not say otherwise. Throws Error
/// (exit 2), as TomlReader does.
void read_side(TomlReader& table, SideSpec& side);

/// The same where only a chain and its release matter, and how it is stepped is not for the preset to say.
void read_release(TomlReader& table, SideSpec& side);

}  // namespace doppel
