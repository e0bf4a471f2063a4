#include "figure/system_words.hpp"

#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace doppel {
namespace {

constexpr std::size_t most_named = 4;  // links of which each is named

/// "1", or "1, 2, 0.5" where they differ; of many the least and the greatest.
std::string numbers_words(const std::vector<double>& numbers) {
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    if (*least == *most) return fmt::format("{}", *least);
    return numbers.size() > most_named ? fmt::format("{} to {}", *least, *most)
                                       : fmt::format("{}", fmt::join(numbers, ", "));
}

std::vector<double> doubles(const std::vector<Quad>& numbers) {
    std::vector<double> all;
    for (const auto& number : numbers) all.push_back(static_cast<double>(number));
    return all;
}

}  // namespace

std::string pendulum_words(std::size_t links) {
    return "a " + chain_words(links);
}

std::string released_words(const SideSpec& side, std::optional<std::size_t> swept) {
    std::vector<std::string> angles, rates;
    for (std::size_t i = 0; i < side.links(); ++i) {
        angles.push_back(i == swept ? "θ" + subscript(i + 1) : text_of(side.angle_deg[i]) + "°");
        rates.push_back(text_of(side.omega_deg_per_s[i]));
    }
    const auto named = [](std::vector<std::string>& texts) {
        if (std::count(texts.begin(), texts.end(), texts.front()) == static_cast<long>(texts.size()) &&
            texts.size() > most_named)
            texts.resize(1);
        return texts.size() <= most_named;
    };
    std::string words = "released";
    const bool rests = is_zero(side.omega_deg_per_s);
    if (rests) words += " at rest";
    if (named(angles)) words += fmt::format(" from {}", fmt::join(angles, "/"));
    if (!rests && named(rates)) words += fmt::format(" at {} °/s", fmt::join(rates, "/"));
    return words;
}

std::string links_words(const std::vector<double>& length_m, const std::vector<double>& mass_kg,
                        double gravity_m_per_s2) {
    auto words = fmt::format("links of {} m", numbers_words(length_m));
    if (!mass_kg.empty()) words += fmt::format(" and {} kg", numbers_words(mass_kg));
    return fmt::format("{}, g = {} m/s²", words, gravity_m_per_s2);
}

std::string links_words(const SideSpec& side) {
    return links_words(doubles(side.length_m), doubles(side.mass_kg), static_cast<double>(side.gravity_m_per_s2));
}

std::string swept_words(const SideSpec& side, bool mass_ratio) {
    const auto pendulum = pendulum_words(side.links());
    if (!mass_ratio) return fmt::format("{} {}; {}", pendulum, released_words(side, 0), links_words(side));
    return fmt::format("{} {}; links of {} m, m₂ = {} kg, g = {} m/s²", pendulum, released_words(side),
                       numbers_words(doubles(side.length_m)), text_of(side.mass_kg[1]), text_of(side.gravity_m_per_s2));
}

}  // namespace doppel
