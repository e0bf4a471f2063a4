#include "scene/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace doppel {
namespace {

constexpr std::size_t most_reported = 20;

bool meet(std::string_view group, std::string_view other) {
    return group == other || group.empty() || other.empty();
}

}  // namespace

Faults::Faults(const std::vector<Override>& overrides) {
    for (const auto& change : overrides) options_.push_back(change.origin);
}

FaultPlace Faults::of_option(const std::string& origin) const {
    const auto at = std::find(options_.begin(), options_.end(), origin);
    return {FaultPlace::no_line + 1 + static_cast<std::size_t>(at - options_.begin()), 0};
}

bool Faults::concern(std::string_view group) const {
    return std::any_of(faults_.begin(), faults_.end(), [&](const Entry& fault) { return meet(fault.group, group); });
}

bool Faults::may_follow(const Entry& fault) const {
    if (!fault.beside) return false;
    const auto& key = *fault.beside;
    return std::any_of(faults_.begin(), faults_.end(), [&](const Entry& other) {
        return !other.beside && meet(other.group, fault.group) && (key.empty() || other.key == key);
    });
}

/// Whether one wrong key may cause both: the same message, or two keys that conflict with the same third key.
bool Faults::may_be_one(const Entry& fault, const Entry& other) {
    if (fault.message == other.message) return true;
    if (!fault.beside || !other.beside || !meet(fault.group, other.group)) return false;
    const auto &key = *fault.beside, &third = *other.beside;
    return key == third || key.empty() || third.empty();
}

void Faults::throw_if_any() const {
    std::vector<Entry> counting;
    for (const auto& fault : faults_) {
        const bool is_there =
            std::any_of(counting.begin(), counting.end(), [&](const Entry& other) { return may_be_one(fault, other); });
        if (!is_there && !may_follow(fault)) counting.push_back(fault);
    }
    if (counting.empty()) return;
    std::stable_sort(counting.begin(), counting.end(),
                     [](const Entry& one, const Entry& other) { return one.place < other.place; });
    std::vector<std::string> lines;
    for (const auto& fault : counting) lines.push_back(fault.message);
    if (lines.size() > most_reported) {
        const auto left = lines.size() - most_reported;
        lines.resize(most_reported);
        lines.push_back(fmt::format("and {} more", left));
    }
    throw Error(ExitCode::bad_input, lines.front(), {std::next(lines.begin()), lines.end()});
}

}  // namespace doppel
