#include "image/matte.hpp"

#include <algorithm>

namespace doppel {

void matte(const Picture& black, const Picture& white, const Rect& within, Picture& into) {
    for (int y = within.top; y < within.bottom; ++y)
        for (int x = within.left; x < within.right; ++x) {
            const auto *on_black = black.at(x, y), *on_white = white.at(x, y);
            auto* pixel = into.at(x, y);
            // on black: a·c, on white: a·c + (1 − a)·255
            int lost = 255;
            for (int k = 0; k < 3; ++k) lost = std::min(lost, std::max(on_white[k] - on_black[k], 0));
            const int opacity = 255 - lost;
            pixel[3] = static_cast<std::uint8_t>(opacity);
            for (int k = 0; k < 3; ++k)
                pixel[k] =
                    opacity == 0
                        ? 0
                        : static_cast<std::uint8_t>(std::min(255, (2 * 255 * on_black[k] + opacity) / (2 * opacity)));
        }
}

}  // namespace doppel
