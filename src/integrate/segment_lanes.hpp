#pragma once

#include "numeric/lanes.hpp"

namespace doppel {

// What SegmentSeries does from lane to lane. Only for packs of the file that includes this
// (integrate/segment_series_width.cpp): no other processor's code is to share it.

/// Lanes 1 … of a, then lane 0 of b; or the last lane of a, then lanes 0 … of b.
template <bool up, class Doubles>
[[gnu::always_inline]] inline Doubles shifted(Doubles a, Doubles b) {
    constexpr int last = sizeof(Doubles) / sizeof(double) - 1, first = up ? 1 : last;
    if constexpr (last == 7)
        return __builtin_shufflevector(a, b, first, first + 1, first + 2, first + 3, first + 4, first + 5, first + 6,
                                       first + 7);
    else if constexpr (last == 3)
        return __builtin_shufflevector(a, b, first, first + 1, first + 2, first + 3);
    else
        return __builtin_shufflevector(a, b, first, first + 1);
}

/// Lane l of lane l + 1, where the segment goes on; 0 in the last.
template <class Pack>
[[gnu::always_inline]] inline Pack from_next(const Pack& a) {
    Pack r;
    for (int k = 0; k + 1 < Pack::parts; ++k) r.v[k] = shifted<true>(a.v[k], a.v[k + 1]);
    r.v[Pack::parts - 1] = shifted<true>(a.v[Pack::parts - 1], typename Pack::Doubles{});
    return r;
}

/// Lane l of lane l − 1, where the segment comes from; 0 in the first.
template <class Pack>
[[gnu::always_inline]] inline Pack from_last(const Pack& a) {
    Pack r;
    r.v[0] = shifted<false>(typename Pack::Doubles{}, a.v[0]);
    for (int k = 1; k < Pack::parts; ++k) r.v[k] = shifted<false>(a.v[k - 1], a.v[k]);
    return r;
}

/// The inverse of the matrix of the segments' last links: symmetric, a row a pack.
template <class Pack>
struct LastLinks {
    static constexpr int lanes = Pack::width;
    Pack inverse[lanes];

    /// Of the diagonal, and of what is beside it in row l, column l − 1, its sign turned.
    [[gnu::always_inline]] LastLinks(const Pack& diagonal, const Pack& beside) {
        static constexpr double unit[2 * lanes - 1] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
        double pivot[lanes], share[lanes];
        pivot[0] = diagonal[0];
        share[0] = 0;
        inverse[0] = Pack::load(unit + lanes - 1);
        for (int i = 1; i < lanes; ++i) {
            share[i] = beside[i] / pivot[i - 1];
            pivot[i] = diagonal[i] - share[i] * beside[i];
            inverse[i] = Pack::load(unit + lanes - 1 - i) + Pack(share[i]) * inverse[i - 1];
        }
        for (int i = lanes - 1; i >= 0; --i) {
            inverse[i] /= Pack(pivot[i]);
            if (i + 1 < lanes) inverse[i] += Pack(share[i + 1]) * inverse[i + 1];
        }
    }

    [[gnu::always_inline]] Pack solve(const Pack& right) const {
        alignas(64) double all[lanes];
        right.store(all);
        Pack sum[4];
        for (int i = 0; i < 4; ++i) sum[i] = inverse[i] * Pack(all[i]) + inverse[i + 4] * Pack(all[i + 4]);
        return (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
};

}  // namespace doppel
