#include "image/golden.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace doppel {
namespace {

// The golden policy: identical pictures pass; otherwise all of these limits must hold.
constexpr int strong_difference = 3;              // /255
constexpr long max_strong = 4;                    // pixels
constexpr int largest_allowed = 80;               // /255
constexpr double max_differing = 0.08;            // of all pixels
constexpr int tile = 32;                          // px
constexpr double max_tile_mean = 0.25;            // /255
constexpr double max_signed_mean = 0.03;          // /255
constexpr std::size_t colours = 3, channels = 4;  // the fourth channel is opacity

/// Adds the differences of the pixels in a tile to the verdict; `mean` receives their sums.
void add_tile(const Picture& expected, const Picture& actual, const Rect& area, GoldenVerdict& verdict) {
    std::array<double, channels> distances{};
    for (int y = area.top; y < area.bottom; ++y)
        for (int x = area.left; x < area.right; ++x) {
            int maximum = 0;
            for (std::size_t c = 0; c < channels; ++c) {
                const int difference = actual.at(x, y)[c] - expected.at(x, y)[c];
                verdict.mean[c] += difference;
                distances[c] += std::abs(difference);
                maximum = std::max(maximum, std::abs(difference));
            }
            verdict.differing += maximum > 0;
            verdict.strong += maximum > strong_difference;
            verdict.largest = std::max(verdict.largest, maximum);
        }
    const double pixels = (area.right - area.left) * (area.bottom - area.top);
    verdict.worst_tile = std::max(
        {verdict.worst_tile, distances[3] / pixels, (distances[0] + distances[1] + distances[2]) / (colours * pixels)});
}

}  // namespace

GoldenVerdict compare_golden(const Picture& expected, const Picture& actual) {
    const auto [width, height] = expected.size;
    if (actual.size != expected.size)
        throw Error(ExitCode::differs, fmt::format("the pictures differ in size: {}×{} expected, {}×{} found", width,
                                                   height, actual.size.width, actual.size.height));
    GoldenVerdict verdict;
    for (int top = 0; top < height; top += tile)
        for (int left = 0; left < width; left += tile)
            add_tile(expected, actual, intersection({left, top, left + tile, top + tile}, all_of(expected.size)),
                     verdict);
    const double pixels = static_cast<double>(width) * height;
    for (double& mean : verdict.mean) mean /= pixels;

    const auto rule = [&](bool passes, const std::string& broken) {
        if (passes) return;
        verdict.passes = false;
        verdict.why += (verdict.why.empty() ? "" : "; ") + broken;
    };
    rule(verdict.strong <= max_strong, fmt::format("{} pixels differ by more than {}/255, and at most {} may",
                                                   verdict.strong, strong_difference, max_strong));
    rule(verdict.largest <= largest_allowed,
         fmt::format("a pixel differs by {}/255, and at most {} is allowed", verdict.largest, largest_allowed));
    rule(static_cast<double>(verdict.differing) <= max_differing * pixels,
         fmt::format("{:.1f} % of the pixels differ, and at most {:.0f} % may",
                     100.0 * static_cast<double>(verdict.differing) / pixels, 100 * max_differing));
    rule(verdict.worst_tile <= max_tile_mean,
         fmt::format("a {0}×{0} tile differs by {1:.2f}/255 on average, and at most {2} is allowed", tile,
                     verdict.worst_tile, max_tile_mean));
    for (std::size_t c = 0; c < channels; ++c)
        rule(std::abs(verdict.mean[c]) <= max_signed_mean,
             fmt::format("{} is off by {:+.3f}/255 on average, and at most {} is allowed",
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
    const std::array parts{expected, actual, amplified_difference(expected, actual)};
    auto all = contact_sheet(parts, 3, 0, {});
    for (std::size_t i = 3; i < all.rgba.size(); i += 4) all.rgba[i] = 255;
    return all;
}

}  // namespace doppel
