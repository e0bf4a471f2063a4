#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace doppel {

/// What the scripts of "doppel completion" ask for, "doppel complete SHELL WORD…": what the last word may become, a line
/// each; for zsh and fish with a tab and a few words on it. The words are as they were typed, quotes included.
std::string completions(CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace doppel
