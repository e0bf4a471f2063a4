#include "film/composer.hpp"
#include "render/font.hpp"
#include "scene/version.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace doppel {
namespace {

/// A line of words on a card.
struct CardLine {
    std::string text;
    double size;  // px
    Weight weight = Weight::regular;
    Color color;
};

/// The lines in the middle of the picture, on the background, all as opaque as the card.
DisplayList card(const std::vector<CardLine>& lines, Size size, Color background, double opacity) {
    const auto alpha = static_cast<float>(opacity);
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    constexpr double leading = 1.55;
    double tall = 0;
    for (const auto& line : lines) tall += leading * line.size;
    DisplayList list;
    list.push_back(Box{0, 0, width, height, 0, background.with_alpha(alpha)});
    double y = (height - tall) / 2;
    for (const auto& line : lines) {
        y += leading * line.size;
        const float fits = fitting_size(line.text, static_cast<float>(line.size), line.weight, 0.88f * width);
        list.push_back(Label{line.text,
                             {width / 2, static_cast<float>(y - 0.35 * line.size)},
                             fits,
                             Align::center,
                             line.weight,
                             line.color.with_alpha(alpha)});
    }
    return list;
}

}  // namespace

DisplayList Composer::title_card(double opacity) const {
    const auto& style = layout_.style;
    const auto& theme = style.theme;
    const auto words = side_captions(scene_);
    return card({{layout_.title, style.font.card, Weight::bold, theme.text},
                 {layout_.subtitle, 1.5 * style.font.subtitle, Weight::regular, theme.quiet_text},
                 {"", style.font.subtitle, Weight::regular, theme.text},
                 {words[0].heading, 1.3 * style.font.heading, Weight::bold, theme.sides[0]},
                 {words[1].heading, 1.3 * style.font.heading, Weight::bold, theme.sides[1]}},
                scene_.preset.video.size, theme.background, opacity);
}

DisplayList Composer::end_card(double opacity) const {
    const auto& style = layout_.style;
    const auto& theme = style.theme;
    const auto size = 1.3 * style.font.heading;
    const auto outcome = !start_as_one() ? "apart from the start"
                         : parted_       ? fmt::format("parted after {:.1f} s", *parted_)
                                         : fmt::format("together to the end, {:g} s", scene_.time(scene_.samples));
    std::vector<CardLine> lines{{layout_.title, 0.7 * style.font.card, Weight::bold, theme.text},
                                {"", style.font.subtitle, Weight::regular, theme.text},
                                {outcome, size, Weight::regular, theme.trace}};
    if (start_distance_ > 0)
        lines.push_back({fmt::format("from a state-space distance of {} to {}", scientific(start_distance_),
                                     scientific(largest_distance_)),
                         size, Weight::regular, theme.text});
    lines.push_back({"", style.font.subtitle, Weight::regular, theme.text});
    lines.push_back({fmt::format("Doppel {} · {}", version(), scene_.preset.name), style.font.subtitle, Weight::regular,
                     theme.quiet_text});
    return card(lines, scene_.preset.video.size, theme.background, opacity);
}

}  // namespace doppel
