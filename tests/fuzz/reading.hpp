#pragma once

#include <string>
#include <string_view>

namespace doppel::test {

// What the program reads, read as it would be. Each returns the refusal's message, empty where all was read, and throws
// std::logic_error where a reader breaks its word: an Error of another exit code, a message without a place. Whatever
// else the readers throw, they throw.

/// A preset input.toml: a TOML text, in which each comment "#--set KEY=VALUE" is an override. What was read must be
/// read again from its resolved text, as the same; a film must make a scene, or an Error.
std::string read_input(std::string_view input);

/// Arguments of --set, a line each, for a film; for a figure where the first line is "#NAME".
std::string read_sets(std::string_view input);

/// A file of a figure's trials (figure/part_file.hpp); a line that ends in ";?" gets the checksum that it lacks. What
/// it holds of the figure that it names, some of every kind, is drawn and written.
std::string read_part(std::string_view input);

/// A PNG to compare with.
std::string read_picture(std::string_view input);

/// A font: all letters that it has are measured and drawn, large and small, in both weights.
std::string read_font(std::string_view input);

}  // namespace doppel::test
