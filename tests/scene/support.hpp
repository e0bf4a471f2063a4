#pragma once

#include "base/error.hpp"
#include "numeric/state.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

/// Overrides in the form of --set: {"video.size=[480, 270]", …}.
inline std::vector<Override> sets(const std::vector<std::string>& arguments) {
    std::vector<Override> all;
    for (const auto& argument : arguments) all.push_back(parse_set(argument));
    return all;
}

inline Scene scene_of(const std::string& preset, const std::vector<std::string>& arguments = {}) {
    return make_scene(read_preset(find_preset(preset), sets(arguments)));
}

/// The error that `action` throws; the test fails if it throws none.
template <class Action>
std::pair<ExitCode, std::string> error_of(Action&& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.code(), error.what()};
    }
    return {ExitCode::done, "nothing was thrown"};
}

}  // namespace doppel
