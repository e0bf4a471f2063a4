#pragma once

#include "scene/preset.hpp"
#include "scene/toml_reader.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace doppel {

// Tables of presets, for films and figures. Each function leaves alone what the table does not say, and throws Error
// (exit 2) as TomlReader does.

/// `kind` of [scene]: of a film, and of the figures (figure/kinds.cpp).
inline constexpr std::string_view pair_kind = "pair";
inline constexpr std::array<std::string_view, 12> scene_kinds{pair_kind,        "sweep",     "curves",   "convergence",
                                                              "spectrum",       "section",   "flip-map", "links",
                                                              "work-precision", "stability", "drift",    "audit"};

/// One of scene_kinds.
std::string read_kind(TomlReader& scene);

/// `duration_s` and `sample_hz` of [scene].
void read_clock(TomlReader& scene, Preset& preset);

/// [system], [a] or [b].
void read_side(TomlReader& table, SideSpec& side);

/// [system] where only a chain and its release matter, and how it is stepped is not for the preset to say.
void read_release(TomlReader& table, SideSpec& side);

/// [system], then [a] and [b] on top, each from level to level: what a later one says goes on top of the earlier.
void read_sides(const TomlDocument& document, const std::vector<TomlReader*>& levels, Preset& preset);

/// Steps and samples must fall on each other exactly.
void check_clock(const Preset& preset, const TomlReader& scene);

}  // namespace doppel
