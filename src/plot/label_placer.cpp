#include "plot/labels.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr float square = 3;  // px

std::uint64_t bit(std::size_t owner) {
    return std::uint64_t{1} << (owner % LabelPlacer::no_owner);
}

}  // namespace

LabelPlacer::LabelPlacer(const Area& area)
    : area_(area),
      columns_(std::max(1, static_cast<int>(std::ceil(area.width() / square)))),
      rows_(std::max(1, static_cast<int>(std::ceil(area.height() / square)))),
      drawn_(static_cast<std::size_t>(columns_) * rows_) {}

void LabelPlacer::add_line(Point from, Point to, std::size_t owner) {
    const float length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
    const int steps = 1 + static_cast<int>(length / square * 1.5f);
    for (int i = 0; i <= steps; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(steps);
        const int column = static_cast<int>((std::lerp(from.x, to.x, part) - area_.left) / square);
        const int row = static_cast<int>((std::lerp(from.y, to.y, part) - area_.top) / square);
        if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
        drawn_[static_cast<std::size_t>(row) * columns_ + column] |= bit(owner);
    }
}

int LabelPlacer::ink(const Area& box, std::size_t except) const {
    const std::uint64_t others = except == no_owner ? ~std::uint64_t{0} : ~bit(except);
    const auto within = [](float v, int maximum) {
        return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(maximum)));
    };
    const int left = within(std::floor((box.left - area_.left) / square), columns_);
    const int right = within(std::ceil((box.right - area_.left) / square), columns_);
    const int bottom = within(std::ceil((box.bottom - area_.top) / square), rows_);
    int count = 0;
    for (int row = within(std::floor((box.top - area_.top) / square), rows_); row < bottom; ++row)
        for (int column = left; column < right; ++column)
            count += (drawn_[static_cast<std::size_t>(row) * columns_ + column] & others) != 0;
    return count;
}

bool LabelPlacer::is_free(const Area& box) const {
    return area_.contains(box) && std::ranges::none_of(texts_, [&](const Area& text) { return text.overlaps(box); });
}

}  // namespace doppel
