#include "scene/wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace doppel {
namespace {

constexpr std::array<std::string_view, link_count> subscripts{"₁", "₂"};

/// One thing that can be said of a side; the same place in both sides' lists is about the same thing.
struct Statement {
    std::string text;
    bool is_start_angle = false;
};

std::string step_words(const Rational& step) {
    return step.numerator == 1 ? fmt::format("1/{} s", grouped(step.denominator)) : fmt::format("{} s", step.value());
}

std::string model_words(const Side& side) {
    return std::string(name_of(side.model));
}

std::vector<Statement> statements(const SideSpec& spec, const Side& side) {
    std::vector<Statement> all;
    const auto each_link = [&](std::string_view symbol, const auto& values, std::string_view unit, bool angle = false) {
        for (std::size_t i = 0; i < link_count; ++i)
            all.push_back({fmt::format("{}{} = {}{}", symbol, subscripts[i], values[i], unit), angle});
    };
    each_link("θ", spec.angle_deg, "°", true);
    each_link("ω", spec.omega_deg_per_s, "°/s");
    each_link("m", spec.mass_kg, " kg");
    each_link("l", spec.length_m, " m");
    all.push_back({fmt::format("g = {} m/s²", spec.gravity_m_per_s2)});
    all.push_back({model_words(side)});
    all.push_back({std::string(side.method.title)});
    all.push_back({step_words(side.step)});
    return all;
}

std::string joined(const std::vector<std::string>& parts) {
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::string grouped(long number) {
    auto digits = fmt::format("{}", number);
    for (auto at = static_cast<long>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), " ");
    return digits;
}

std::array<SideWords, 2> side_words(const Scene& scene) {
    const std::array all{statements(scene.preset.a, scene.a), statements(scene.preset.b, scene.b)};
    std::array<SideWords, 2> words;
    for (std::size_t side = 0; side < 2; ++side) {
        std::vector<std::string> differs, start;
        for (std::size_t i = 0; i < all[side].size(); ++i) {
            const auto& statement = all[side][i];
            if (all[0][i].text != all[1][i].text)
                differs.push_back(statement.text);
            else if (statement.is_start_angle)
                start.push_back(statement.text);
        }
        if (differs.empty()) differs.push_back(side == 0 ? "a" : "b, the same");
        // a heading holds two statements; more go to the note
        constexpr std::size_t most = 2;
        start.insert(start.begin(), differs.begin() + static_cast<long>(std::min(most, differs.size())), differs.end());
        differs.resize(std::min(most, differs.size()));
        words[side] = {joined(differs), joined(start)};
    }
    return words;
}

std::string scene_words(const Scene& scene) {
    const auto at_rest = [](const SideSpec& side) {
        return std::all_of(side.omega_deg_per_s.begin(), side.omega_deg_per_s.end(),
                           [](double rate) { return rate == 0; });
    };
    std::vector<std::string> common;
    if (scene.a.model == scene.b.model) common.push_back(model_words(scene.a));
    if (scene.a.method.name == scene.b.method.name) common.emplace_back(scene.a.method.title);
    if (scene.a.step == scene.b.step) common.push_back(step_words(scene.a.step));
    return fmt::format("two double pendulums{}{}{}",
                       at_rest(scene.preset.a) && at_rest(scene.preset.b) ? ", released at rest" : "",
                       common.empty() ? "" : " · ", joined(common));
}

}  // namespace doppel
