#include "physics/row_order.hpp"

#include <algorithm>
#include <numeric>

namespace doppel {
namespace {

/// Breadth-first walks over rows that are tied to each other.
class Walk {
public:
    explicit Walk(const TiedRows& all) : all_(all), things_(all.rows), seen_(all.rows), degree_(all.rows) {
        for (std::size_t thing = 0; thing < all.tied.size(); ++thing)
            for (const auto row : all.tied[thing]) {
                things_[row].push_back(thing);
                degree_[row] += all.tied[thing].size() - 1;
            }
    }

    /// All that hangs together with `start`, nearest first, the less tied first among those that are as near.
    std::vector<std::size_t> from(std::size_t start) {
        ++walks_;
        std::vector<std::size_t> rows{start};
        seen_[start] = walks_;
        for (std::size_t next = 0; next < rows.size(); ++next) {
            const auto known = static_cast<std::ptrdiff_t>(rows.size());
            for (const auto thing : things_[rows[next]])
                for (const auto row : all_.tied[thing])
                    if (seen_[row] != walks_) {
                        seen_[row] = walks_;
                        rows.push_back(row);
                    }
            std::stable_sort(rows.begin() + known, rows.end(), [&](auto a, auto b) { return degree_[a] < degree_[b]; });
        }
        return rows;
    }
    bool is_new(std::size_t row) const { return seen_[row] == 0; }

private:
    const TiedRows& all_;
    std::vector<std::vector<std::size_t>> things_;  // of each row
    std::vector<std::size_t> seen_, degree_;        // in which walk it was met last; about how many rows it is tied to
    std::size_t walks_ = 0;
};

/// The place of every row in reverse Cuthill–McKee, each part walked through from one of its ends.
std::vector<std::size_t> reverse_cuthill_mckee(const TiedRows& all) {
    std::vector<std::size_t> place(all.rows);
    std::size_t left = all.rows;
    Walk walk(all);
    for (std::size_t row = 0; row < all.rows; ++row) {
        if (!walk.is_new(row)) continue;
        const auto end = walk.from(walk.from(row).back()).back();
        for (const auto next : walk.from(end)) place[next] = --left;
    }
    return place;
}

}  // namespace

std::size_t TiedRows::envelope(const std::vector<std::size_t>& place) const {
    std::vector<std::size_t> begin(rows);
    std::iota(begin.begin(), begin.end(), std::size_t(0));
    for (const auto& some : tied) {
        std::size_t first = rows;
        for (const auto row : some) first = std::min(first, place[row]);
        for (const auto row : some) begin[place[row]] = std::min(begin[place[row]], first);
    }
    std::size_t entries = 0;
    for (std::size_t i = 0; i < rows; ++i) entries += i - begin[i];
    return entries;
}

std::vector<std::size_t> narrow_places(const TiedRows& all) {
    std::vector<std::size_t> as_they_are(all.rows);
    std::iota(as_they_are.begin(), as_they_are.end(), std::size_t(0));
    const auto entries = all.envelope(as_they_are);
    if (entries <= 8 * all.rows) return as_they_are;
    auto place = reverse_cuthill_mckee(all);
    return 4 * all.envelope(place) < entries ? place : as_they_are;
}

}  // namespace doppel
