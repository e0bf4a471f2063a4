#pragma once

#include "errors.hpp"
#include "numeric/state.hpp"
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

namespace doppel {

inline const std::atomic<bool> never = false;

/// Overrides in the form of --set: {"video.size=[480, 270]", …}.
inline std::vector<Override> sets(const std::vector<std::string>& arguments) {
    std::vector<Override> all;
    for (const auto& argument : arguments) all.push_back(parse_set(argument));
    return all;
}

inline Scene scene_of(const std::string& preset, const std::vector<std::string>& arguments = {}) {
    return make_scene(read_preset(find_preset(preset), sets(arguments)));
}

/// The preset "x" of this text.
inline Preset preset_from(const std::string& text, const std::vector<std::string>& arguments = {},
                          const std::string& path = "x.toml") {
    return read_preset({"x", path, text, path}, sets(arguments));
}
inline Scene scene_from(const std::string& text, const std::vector<std::string>& arguments = {}) {
    return make_scene(preset_from(text, arguments));
}

template <class Action>
test::Thrown error_of(Action&& action) {
    return test::thrown_by(action);
}

/// The message of the error in the input (exit 2) that `action` throws.
template <class Action>
std::string refusal(Action&& action) {
    const auto [code, message] = error_of(action);
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    return message;
}

/// Expects that a preset of this text, or its scene, is refused with this message.
inline void expect_refused(const std::string& text, const std::string& message) {
    EXPECT_EQ(refusal([&] { scene_from(text); }), message) << text;
}

/// Whether the text contains these words, for EXPECT_TRUE.
inline testing::AssertionResult says(const std::string& text, const std::string& words) {
    if (text.find(words) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "\"" << words << "\" is not in: " << text;
}

}  // namespace doppel
