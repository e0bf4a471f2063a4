#pragma once

#include <cstddef>
#include <vector>

namespace doppel {

/// Rows of a symmetric matrix that has entries where two of them have something in common: `tied` lists, for each such
/// thing, the rows that have it.
struct TiedRows {
    std::size_t rows;
    std::vector<std::vector<std::size_t>> tied;

    /// How many entries an envelope holds below the diagonal, with row r in place `place[r]`.
    std::size_t envelope(const std::vector<std::size_t>& place) const;
};

/// A place for every row, so that an envelope holds few zeros: as they are, unless reverse Cuthill–McKee takes less than
/// a quarter of the memory, for a chain whose links are listed in a bad order.
/// Source  George & Liu 1981, Computer Solution of Large Sparse Positive Definite Systems, §4.
std::vector<std::size_t> narrow_places(const TiedRows& all);

}  // namespace doppel
