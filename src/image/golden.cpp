#include "image/golden.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace doppel {
namespace {

// The golden policy: identical pictures pass; otherwise all of these limits must hold.
constexpr int strong_difference = 3;      // /255
constexpr long max_strong = 4;            // pixels
constexpr int largest_allowed = 80;       // /255
constexpr double max_differing = 0.08;    // of all pixels
constexpr int tile = 32;                  // px
constexpr double max_tile_mean = 0.25;    // /255
constexpr double max_signed_mean = 0.03;  // /255
constexpr int colours = 3, channels = 4;  // the fourth channel is opacity

/// Mean absolute difference over the tile with corner (left, top): the larger of that of the colours and that of the
/// opacity.
double tile_mean(const Picture& expected, const Picture& actual, int left, int top) {
    const int right = std::min(left + tile, expected.size.width), bottom = std::min(top + tile, expected.size.height);
    std::array<long, channels> sums{};
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
            for (int c = 0; c < channels; ++c)
                sums[static_cast<std::size_t>(c)] += std::abs(expected.at(x, y)[c] - actual.at(x, y)[c]);
    const double pixels = (right - left) * (bottom - top);
    return std::max(static_cast<double>(sums[0] + sums[1] + sums[2]) / (colours * pixels),
                    static_cast<double>(sums[3]) / pixels);
}

}  // namespace

GoldenVerdict compare_golden(const Picture& expected, const Picture& actual) {
    const auto [width, height] = expected.size;
    if (actual.size != expected.size)
        throw Error(ExitCode::differs, fmt::format("the pictures differ in size: {}×{} expected, {}×{} found", width,
                                                   height, actual.size.width, actual.size.height));
    GoldenVerdict verdict;
    std::array<long, channels> sums{};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            int maximum = 0;
            for (int c = 0; c < channels; ++c) {
                const int difference = actual.at(x, y)[c] - expected.at(x, y)[c];
                sums[static_cast<std::size_t>(c)] += difference;
                maximum = std::max(maximum, std::abs(difference));
            }
            verdict.differing += maximum > 0;
            verdict.strong += maximum > strong_difference;
            verdict.largest = std::max(verdict.largest, maximum);
        }
    for (int top = 0; top < height; top += tile)
        for (int left = 0; left < width; left += tile)
            verdict.worst_tile = std::max(verdict.worst_tile, tile_mean(expected, actual, left, top));
    const double pixels = static_cast<double>(width) * height;
    for (std::size_t c = 0; c < channels; ++c) verdict.mean[c] = static_cast<double>(sums[c]) / pixels;

    const auto rule = [&](bool passes, const std::string& broken) {
        if (passes) return;
        verdict.passes = false;
        verdict.why += (verdict.why.empty() ? "" : "; ") + broken;
    };
    rule(verdict.strong <= max_strong, fmt::format("{} pixels differ by more than {}/255; at most {} may",
                                                   verdict.strong, strong_difference, max_strong));
    rule(verdict.largest <= largest_allowed,
         fmt::format("a pixel differs by {}/255; at most {} is allowed", verdict.largest, largest_allowed));
    rule(static_cast<double>(verdict.differing) <= max_differing * pixels,
         fmt::format("{:.1f} % of the pixels differ; at most {:.0f} % may",
                     100.0 * static_cast<double>(verdict.differing) / pixels, 100 * max_differing));
    rule(verdict.worst_tile <= max_tile_mean,
         fmt::format("a {0}×{0} tile differs by {1:.2f}/255 on average; at most {2} is allowed", tile,
                     verdict.worst_tile, max_tile_mean));
    for (std::size_t c = 0; c < channels; ++c)
        rule(std::abs(verdict.mean[c]) <= max_signed_mean,
             fmt::format("{} is off by {:+.3f}/255 on average; at most {} is allowed",
                         std::array{"red", "green", "blue", "opacity"}[c], verdict.mean[c], max_signed_mean));
    return verdict;
}

Picture amplified_difference(const Picture& expected, const Picture& actual) {
    constexpr int gain = 16;
    Picture difference(expected.size);
    for (std::size_t i = 0; i < difference.rgba.size(); ++i) {
        const auto distance = [&](std::size_t at) { return std::abs(actual.rgba[at] - expected.rgba[at]); };
        const std::size_t opacity = i | 3;
        const int maximum = i == opacity ? 255 : gain * std::max(distance(i), distance(opacity));
        difference.rgba[i] = static_cast<std::uint8_t>(std::min(255, maximum));
    }
    return difference;
}

Picture difference_picture(const Picture& expected, const Picture& actual) {
    const Picture difference = amplified_difference(expected, actual);
    const int width = expected.size.width;
    Picture all({3 * width, expected.size.height});
    const auto place = [&](const Picture& part, int left) {
        for (int y = 0; y < all.size.height; ++y) std::copy_n(part.at(0, y), std::size_t{4} * width, all.at(left, y));
    };
    place(expected, 0), place(actual, width), place(difference, 2 * width);
    for (std::size_t i = 3; i < all.rgba.size(); i += 4) all.rgba[i] = 255;
    return all;
}

}  // namespace doppel
