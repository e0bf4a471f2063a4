#pragma once

#include <random>
#include <string>
#include <vector>

namespace doppel::test {

/// The words, numbers and strings of TOML texts, to make others of.
std::vector<std::string> tokens_of(const std::vector<std::string>& texts);

/// `text` changed in 1 to 4 places: numbers made extreme, words swapped for `tokens`, lines dropped, doubled or moved,
/// bytes flipped, the end cut off, comments "#--set KEY=VALUE" added. The same for the same `random`, on every machine.
std::string mutated(std::string text, const std::vector<std::string>& tokens, std::mt19937& random);

/// `bytes` changed in 1 to 4 places: bits flipped, digits and bytes changed, pieces dropped or doubled, the end cut
/// off.
std::string damaged(std::string bytes, std::mt19937& random);

}  // namespace doppel::test
