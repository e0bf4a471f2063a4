#pragma once

#include <string>
#include <string_view>

namespace doppel::test {

// The program's readers. Each function returns the message of the error, empty if there is none. It throws
// std::logic_error if a reader violates its contract: an Error with another exit code, or a message without a place.
// Other exceptions of the readers pass through.

/// A preset input.toml: a TOML text, in which each comment "#--set KEY=VALUE" is an override. The resolved text must
/// give the same preset again; a film must give a scene or an Error.
std::string read_input(std::string_view input);

/// Arguments of --set, one per line, for a film, or for a figure if the first line is "#NAME".
std::string read_sets(std::string_view input);

/// A file of a figure's trials (figure/computation.hpp); a line that ends in ";?" gets its checksum. Its trials for the
/// figure that it names, one of every kind, are drawn and written.
std::string read_part(std::string_view input);

/// A PNG to compare with.
std::string read_picture(std::string_view input);

/// A font: all its letters are measured and drawn, large and small, in both weights.
std::string read_font(std::string_view input);

}  // namespace doppel::test
