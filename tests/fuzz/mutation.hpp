#pragma once

#include <random>
#include <string>
#include <vector>

namespace doppel::test {

/// The words, numbers and strings of TOML texts, used to build mutations.
std::vector<std::string> tokens_of(const std::vector<std::string>& texts);

/// `text` changed in 1 to 4 places: extreme numbers, words replaced by `tokens`, lines removed, repeated or moved,
/// bytes changed, the end cut off, comments "#--set KEY=VALUE" added. The same for equal `random`, on every machine.
std::string mutated(std::string text, const std::vector<std::string>& tokens, std::mt19937& random);

/// `bytes` changed in 1 to 4 places: bits, digits and bytes changed, pieces removed or repeated, the end cut
/// off.
std::string damaged(std::string bytes, std::mt19937& random);

}  // namespace doppel::test
