#include "fuzz/reading.hpp"

#include "base/error.hpp"
#include "figure/preset.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <sstream>
#include <stdexcept>
#include <vector>

namespace doppel::test {
namespace {

constexpr std::string_view option = "--set ";

std::vector<Override> overrides_in(const std::string& text) {
    std::vector<Override> overrides;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("#--set ")) overrides.push_back(parse_set(line.substr(1 + option.size())));
    return overrides;
}

/// A place: "input.toml…", "--set KEY…", or the preset for errors of several keys ("input: side a: …").
bool names_a_place(std::string_view message) {
    return message.starts_with("input.toml:") || message.starts_with(option) || message.starts_with("input: ") ||
           message.find(" and --set ") != std::string_view::npos;
}

void expect_same(const std::string& resolved, const std::string& again) {
    if (resolved != again)
        throw std::logic_error("the resolved preset is read as another:\n" + resolved + "\n---\n" + again);
}

/// Reads the resolved text back.
template <class Read>
void read_again(const std::string& resolved, const Read& read) {
    try {
        expect_same(resolved, read(PresetText{"input", "input.toml", resolved}));
    } catch (const Error& error) {
        throw std::logic_error(std::string("the resolved preset is refused: ") + error.what() + "\n" + resolved);
    }
}

/// Finds errors of a system as a whole; skips accuracies and long chains, which would take too long.
void try_scene(const Preset& preset) {
    constexpr std::size_t few = 12;
    for (const auto* side : {&preset.a, &preset.b})
        if (side->accuracy || side->links() > few || side->particles.size() > few) return;
    make_scene(preset);
}

void read_all(const PresetText& source, const std::vector<Override>& overrides) {
    if (is_figure(source)) {
        const auto figure = read_figure(source, overrides);
        read_again(figure.resolved(), [](const auto& text) { return read_figure(text).resolved(); });
    } else {
        const auto preset = read_preset(source, overrides);
        read_again(resolved_toml(preset), [](const auto& text) { return resolved_toml(read_preset(text)); });
        try_scene(preset);
    }
}

/// Reads, and expects that an error is one of bad input and names a place.
template <class Read>
std::string refusal_of(const Read& read) {
    try {
        read();
        return {};
    } catch (const Error& error) {
        const std::string message = error.what();
        if (error.code() != ExitCode::bad_input) throw std::logic_error("not exit 2: " + message);
        if (!names_a_place(message)) throw std::logic_error("names no place: " + message);
        for (const auto& line : error.further())
            if (!names_a_place(line) && !line.starts_with("and ")) throw std::logic_error("names no place: " + line);
        return message;
    }
}

}  // namespace

std::string read_input(std::string_view input) {
    const PresetText source{"input", "input.toml", std::string(input)};
    return refusal_of([&] { read_all(source, overrides_in(source.text)); });
}

std::string read_sets(std::string_view input) {
    std::istringstream lines{std::string(input)};
    PresetText source{"input", "input.toml", ""};
    std::vector<std::string> arguments;
    for (std::string line; std::getline(lines, line);) {
        if (arguments.empty() && line.starts_with('#')) {
            for (const auto& preset : builtin_presets())
                if (preset.name == line.substr(1)) source.text = preset.text;
        } else {
            arguments.push_back(line.substr(0, line.find('\0')));  // a command line cannot contain zero bytes
        }
    }
    return refusal_of([&] {
        std::vector<Override> overrides;
        for (const auto& argument : arguments) overrides.push_back(parse_set(argument));
        read_all(source, overrides);
    });
}

}  // namespace doppel::test
