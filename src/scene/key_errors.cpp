#include "scene/key_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace doppel {
namespace {

constexpr std::size_t max_reported = 20;

bool meet(std::string_view group, std::string_view other) {
    return group == other || group.empty() || other.empty();
}

/// Whether one wrong key may cause both: the same message, or two keys that conflict with the same third key.
bool may_have_one_cause(const KeyError& error, const KeyError& other) {
    if (error.what() == std::string_view(other.what())) return true;
    if (!error.beside || !other.beside || !meet(error.group, other.group)) return false;
    const auto &key = *error.beside, &third = *other.beside;
    return key == third || key.empty() || third.empty();
}

}  // namespace

ErrorPlace KeyErrors::of_option(const std::string& origin) const {
    const auto at = std::ranges::find(overrides_, origin, &Override::origin);
    return {ErrorPlace::no_line + 1 + static_cast<std::size_t>(at - overrides_.begin()), 0};
}

bool KeyErrors::concern(std::string_view group) const {
    return std::ranges::any_of(errors_, [&](const KeyError& error) { return meet(error.group, group); });
}

void KeyErrors::throw_if_any() const {
    const auto may_be_caused = [&](const KeyError& error) {
        return error.beside && std::ranges::any_of(errors_, [&](const KeyError& other) {
                   return !other.beside && meet(other.group, error.group) &&
                          (error.beside->empty() || other.key == *error.beside);
               });
    };
    std::vector<KeyError> counting;
    for (const auto& error : errors_) {
        const auto has_its_cause = [&](const KeyError& other) { return may_have_one_cause(error, other); };
        if (std::ranges::none_of(counting, has_its_cause) && !may_be_caused(error)) counting.push_back(error);
    }
    if (counting.empty()) return;
    std::ranges::stable_sort(counting, {}, &KeyError::place);
    std::vector<std::string> lines;
    for (const auto& error : counting) lines.emplace_back(error.what());
    if (lines.size() > max_reported) {
        const auto left = lines.size() - max_reported;
        lines.resize(max_reported);
        lines.push_back(fmt::format("and {} more", left));
    }
    throw Error(ExitCode::bad_input, lines.front(), {std::next(lines.begin()), lines.end()});
}

}  // namespace doppel
