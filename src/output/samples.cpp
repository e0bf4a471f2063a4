#include "output/samples.hpp"

#include "output/yuv.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace doppel {
namespace {

/// What there is of a plane for a pixel: `bytes` in a row, one row; or, where `halved`, for 2×2 pixels.
struct Shape {
    int bytes;
    bool halved = false;
};

struct Layout {
    int planes;
    std::array<Shape, 4> shapes;
};

constexpr Layout layout(Samples samples) {
    switch (samples) {
        case Samples::yuv420:
            return {3, {{{1}, {1, true}, {1, true}}}};
        case Samples::yuv444:
            return {3, {{{1}, {1}, {1}}}};
        case Samples::yuv420_10:
            return {3, {{{2}, {2, true}, {2, true}}}};
        case Samples::yuva420:
            return {4, {{{1}, {1, true}, {1, true}, {1}}}};
        case Samples::rgb:
            return {1, {{{3}}}};
        case Samples::rgba:
            return {1, {{{4}}}};
    }
    return {};
}

constexpr bool has_halved_chroma(Samples samples) {
    return layout(samples).shapes[1].halved;
}

/// Planes to be filled row by row, in bytes.
struct Target {
    std::array<std::uint8_t*, 4> plane{};
    std::array<std::size_t, 4> stride{};
    std::uint8_t* row(int k, int number) const {
        return plane[std::size_t(k)] + stride[std::size_t(k)] * std::size_t(number);
    }
};

Target target(const Rect& area, Samples samples, std::uint8_t* to) {
    Target result;
    for (int k = 0; k < plane_count(samples); ++k) {
        const PlaneArea p = plane_area(samples, k, area);
        result.plane[std::size_t(k)] = to;
        result.stride[std::size_t(k)] = std::size_t(p.row_bytes);
        to += std::size_t(p.row_bytes) * p.rows;
    }
    return result;
}

/// Sample = std::uint8_t, or std::uint16_t for 10 bits.
template <class Sample>
void convert_420(const Picture& picture, const Rect& area, const Target& to) {
    const auto row = [&](int k, int number) { return reinterpret_cast<Sample*>(to.row(k, number)); };
    const int width = area.right - area.left, height = area.bottom - area.top;
    for (int i = 0; i < height; i += 2) {
        const std::uint8_t* upper = picture.at(area.left, area.top + i);
        const std::uint8_t* lower = picture.at(area.left, area.top + i + 1);
        luma_row(upper, width, row(0, i));
        luma_row(lower, width, row(0, i + 1));
        chroma_row(upper, lower, width, row(1, i / 2), row(2, i / 2));
    }
}

}  // namespace

int plane_count(Samples samples) {
    return layout(samples).planes;
}

PlaneArea plane_area(Samples samples, int plane, const Rect& area) {
    const auto [bytes, halved] = layout(samples).shapes[std::size_t(plane)];
    const int by = halved ? 2 : 1;
    return {bytes * area.left / by, bytes * (area.right - area.left) / by, area.top / by,
            (area.bottom - area.top) / by};
}

std::size_t byte_count(Samples samples, const Rect& area) {
    std::size_t count = 0;
    for (int k = 0; k < plane_count(samples); ++k) {
        const PlaneArea p = plane_area(samples, k, area);
        count += std::size_t(p.row_bytes) * p.rows;
    }
    return count;
}

Rect aligned(Samples samples, const Rect& area, Size picture) {
    const Rect inside = common(area, {0, 0, picture.width, picture.height});
    if (!has_halved_chroma(samples) || inside.empty()) return inside;
    return {inside.left & ~1, inside.top & ~1, (inside.right + 1) & ~1, (inside.bottom + 1) & ~1};
}

void convert(const Picture& picture, const Rect& area, Samples samples, std::uint8_t* to) {
    const Target out = target(area, samples, to);
    const int width = area.right - area.left, height = area.bottom - area.top;
    const auto each_row = [&](auto&& action) {
        for (int i = 0; i < height; ++i) action(picture.at(area.left, area.top + i), i);
    };
    switch (samples) {
        case Samples::yuv420_10:
            convert_420<std::uint16_t>(picture, area, out);
            break;
        case Samples::yuva420:
            each_row([&](const std::uint8_t* rgba, int i) { alpha_row(rgba, width, out.row(3, i)); });
            [[fallthrough]];
        case Samples::yuv420:
            convert_420<std::uint8_t>(picture, area, out);
            break;
        case Samples::yuv444:
            each_row([&](const std::uint8_t* rgba, int i) {
                luma_row(rgba, width, out.row(0, i));
                chroma_row(rgba, width, out.row(1, i), out.row(2, i));
            });
            break;
        case Samples::rgb:
            each_row([&](const std::uint8_t* rgba, int i) { rgb_row(rgba, width, out.row(0, i)); });
            break;
        case Samples::rgba:
            each_row(
                [&](const std::uint8_t* rgba, int i) { std::memcpy(out.row(0, i), rgba, std::size_t{4} * width); });
            break;
    }
}

void convert(const Picture& picture, const std::vector<Rect>& changed, Samples samples, SampledAreas& to) {
    to.areas.clear();
    std::size_t bytes = 0;
    for (const Rect& area : changed)
        if (const Rect grown = aligned(samples, area, picture.size); !grown.empty()) {
            to.areas.push_back(grown);
            bytes += byte_count(samples, grown);
        }
    std::uint8_t* next = to.bytes.make_room(bytes);
    for (const Rect& area : to.areas) {
        convert(picture, area, samples, next);
        next += byte_count(samples, area);
    }
}

}  // namespace doppel
