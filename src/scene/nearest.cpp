#include "scene/nearest.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace doppel {
namespace {

/// Letters to add, drop or change to get from one to the other (Levenshtein 1965).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const auto swap = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({swap, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates) {
    constexpr std::size_t longest = 100;  // more is no slip of the hand
    if (word.size() > longest) return {};
    const auto better = [&](auto a, auto b) { return edit_distance(word, a) < edit_distance(word, b); };
    const auto best = std::min_element(candidates.begin(), candidates.end(), better);
    if (best == candidates.end() || edit_distance(word, *best) > std::max<std::size_t>(2, word.size() / 3)) return {};
    return std::string(*best);
}

}  // namespace doppel
