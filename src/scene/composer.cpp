#include "scene/composer.hpp"

#include "picture/font.hpp"
#include "scene/wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double parted_at = 1;  // state-space distance from which the two count as strangers

Theme themed(const VideoSpec& video) {
    auto theme = *std::find_if(themes.begin(), themes.end(), [&](const auto& t) { return t.name == video.theme; });
    if (video.side_colors) theme.sides = *video.side_colors;
    return theme;
}

/// As many decimals as tell one frame from the next.
std::string clock(const Scene& scene, double time) {
    const double frame = 1 / (scene.fps.value() / scene.preset.video.speed.value());
    return fmt::format("{:.{}f} s", time, frame >= 1 ? 0 : frame >= 0.1 ? 1 : 2);
}

std::string speed_words(const Rational& speed) {
    if (speed == Rational{1, 1}) return "real time";
    return fmt::format("{} ×{:g}", speed.value() < 1 ? "slow motion" : "time lapse", speed.value());
}

}  // namespace

Composer::Composer(const Scene& scene)
    : scene_(scene),
      layout_(make_layout(scene)),
      theme_(themed(scene.preset.video)),
      heaviest_(std::max(*std::max_element(scene.a.mass.begin(), scene.a.mass.end()),
                         *std::max_element(scene.b.mass.begin(), scene.b.mass.end()))),
      energy_unit_(std::max(scene.a.energy_unit, scene.b.energy_unit)) {}

DisplayList Composer::backdrop() const {
    const float t = layout_.text, u = layout_.unit;
    const auto& page = layout_.page;
    const auto& size = scene_.preset.video.size;
    DisplayList list;
    list.push_back(Box{0, 0, static_cast<float>(size.width), static_cast<float>(size.height), 0, theme_.background});
    // long words shrink until they fit beside the clock, or into their panel
    const auto fitted = [&](const std::string& text, Point anchor, float px, Weight weight, Color color, float width) {
        list.push_back(Label{text, anchor, fitting_size(text, px, weight, width), Align::left, weight, color});
    };
    const auto speed = speed_words(scene_.preset.video.speed);
    const auto last_clock = clock(scene_, scene_.time(scene_.samples));
    fitted(layout_.title, {page.left, page.top + 38 * t}, 40 * t, Weight::bold, theme_.text,
           page.width() - text_width(last_clock, 40 * t) - 30 * t);
    fitted(layout_.subtitle, {page.left, page.top + 74 * t}, 22 * t, Weight::regular, theme_.quiet_text,
           page.width() - text_width(speed, 22 * t) - 30 * t);
    list.push_back(
        Label{speed, {page.right, page.top + 74 * t}, 22 * t, Align::right, Weight::regular, theme_.quiet_text});

    for (std::size_t side = 0; layout_.panels && side < 2; ++side) {
        const auto& panel = (*layout_.panels)[side];
        const auto& area = panel.area;
        list.push_back(Box{area.left, area.top, area.right, area.bottom, 14 * u, theme_.panel});
        if (layout_.reach > 0) list.push_back(Ring{panel.center, layout_.reach, std::max(1.5f * u, 1.0f), theme_.grid});
        compose_tracks(side, list);
        const float left = area.left + 28 * u;
        const float width = area.right - left - 28 * u;
        fitted(panel.heading, {left, area.top + 50 * t}, 31 * t, Weight::bold, theme_.sides[side], width);
        fitted(panel.note, {left, area.top + 82 * t}, 21 * t, Weight::regular, theme_.quiet_text, width);
    }
    compose_horizon(list);
    if (layout_.distance) compose_strip_backdrop(*layout_.distance, distance_heading, 34 * t, list);
    if (layout_.energy) compose_strip_backdrop(*layout_.energy, "energy error, of the potential range", 30 * t, list);
    if (layout_.distance || layout_.energy)
        compose_time_labels(layout_.energy ? *layout_.energy : *layout_.distance, list);
    return list;
}

void Composer::add(const Moment& moment) {
    now_ = moment;
    const double time = scene_.time(moment.sample);
    if (layout_.panels) {
        extend_trail(0, moment.a.bobs.back(), time);
        extend_trail(1, moment.b.bobs.back(), time);
    }
    if (layout_.distance) {
        const auto& strip = *layout_.distance;
        distance_.add({strip.time.at(time), strip.value.at(moment.distance)});
    }
    if (layout_.energy) {
        const auto& strip = *layout_.energy;
        const std::array change{moment.a.energy_change, moment.b.energy_change};
        for (std::size_t side = 0; side < 2; ++side)
            energy_[side].add({strip.time.at(time), strip.value.at(std::abs(change[side]) / energy_unit_)});
    }
    if (!parted_ && moment.distance >= parted_at && moment.sample > 0) parted_ = time;
}

DisplayList Composer::frame() const {
    const float t = layout_.text;
    DisplayList list;
    list.push_back(Label{clock(scene_, scene_.time(now_.sample)),
                         {layout_.page.right, layout_.page.top + 38 * t},
                         40 * t,
                         Align::right,
                         Weight::regular,
                         theme_.text});
    for (std::size_t side = 0; layout_.panels && side < 2; ++side) compose_panel(side, list);
    if (layout_.distance) compose_distance(list);
    if (layout_.energy) compose_energy(list);
    return list;
}

}  // namespace doppel
