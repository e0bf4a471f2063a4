#pragma once

#include "scene/preset.hpp"

#include <string>

namespace doppel {

/// The preset as it was understood, every key with its value: TOML that read_preset() reads back to the same scene.
std::string resolved_toml(const Preset& preset);

/// The part that decides the motion: the rest of [scene], then the sides.
std::string resolved_pair(const Preset& preset);
/// [a] and [b] with everything in them, inside the table that `above` names ("curve.").
std::string resolved_sides(const Preset& preset, const std::string& above = "");

/// [system] where only a chain and its release matter.
std::string resolved_release(const SideSpec& side);

/// The same without the release.
std::string resolved_chain(const SideSpec& side);

/// [video] with everything in it.
std::string resolved_video(const VideoSpec& video);

/// A number where it is whole, "a/b" where it is not.
std::string toml_ratio(const Rational& value);

/// A basic TOML string, with its quotes.
std::string toml_text(const std::string& text);

}  // namespace doppel
