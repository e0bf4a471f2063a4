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
bool may_have_one_cause(const KeyErrors::Entry& error, const KeyErrors::Entry& other) {
    if (error.message == other.message) return true;
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
    return std::any_of(errors_.begin(), errors_.end(), [&](const Entry& error) { return meet(error.group, group); });
}

void KeyErrors::throw_if_any() const {
    const auto may_be_caused = [&](const Entry& error) {
        return error.beside && std::any_of(errors_.begin(), errors_.end(), [&](const Entry& other) {
                   return !other.beside && meet(other.group, error.group) &&
                          (error.beside->empty() || other.key == *error.beside);
               });
    };
    std::vector<Entry> counting;
    for (const auto& error : errors_) {
        const bool exists = std::any_of(counting.begin(), counting.end(),
                                        [&](const Entry& other) { return may_have_one_cause(error, other); });
        if (!exists && !may_be_caused(error)) counting.push_back(error);
    }
    if (counting.empty()) return;
    std::stable_sort(counting.begin(), counting.end(),
                     [](const Entry& one, const Entry& other) { return one.place < other.place; });
    std::vector<std::string> lines;
    for (const auto& error : counting) lines.push_back(error.message);
    if (lines.size() > max_reported) {
        const auto left = lines.size() - max_reported;
        lines.resize(max_reported);
        lines.push_back(fmt::format("and {} more", left));
    }
    throw Error(ExitCode::bad_input, lines.front(), {std::next(lines.begin()), lines.end()});
}

}  // namespace doppel
