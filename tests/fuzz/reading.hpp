#pragma once

#include <string>
#include <string_view>

namespace doppel::test {

/// Reads `input` as the program would read a preset input.toml: a TOML text, in which each comment "#--set KEY=VALUE"
/// is an override. What was read must be read again from its resolved text, as the same; a film must make a scene, or
/// an Error. Returns the refusal's message, empty where all was read. Throws std::logic_error where the readers break
/// their word: an Error that is not exit 2, a message without a place, a resolved text that is another preset.
/// Whatever else they throw, it throws.
std::string read_input(std::string_view input);

}  // namespace doppel::test
