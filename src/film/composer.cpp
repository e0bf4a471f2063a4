#include "film/composer.hpp"

#include "film/survey.hpp"
#include "render/font.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double parted_at = 1;                  // state-space distance from which the two count as strangers
constexpr double together_at = 0.1 * parted_at;  // up to which a pair starts as one, and can part

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

Composer::Composer(const Scene& scene, const std::atomic<bool>& stop)
    : scene_(scene),
      layout_(make_layout(scene, stop)),
      heaviest_(std::max(*std::max_element(scene.a.mass.begin(), scene.a.mass.end()),
                         *std::max_element(scene.b.mass.begin(), scene.b.mass.end()))),
      energy_unit_(std::max(scene.a.energy_unit, scene.b.energy_unit)),
      traces_(layout_.strips.size()) {}

const PendulumPanel& Composer::panel_of(std::size_t side) const {
    const auto shows = [&](const PendulumPanel& panel) {
        return std::find(panel.sides.begin(), panel.sides.end(), side) != panel.sides.end();
    };
    return *std::find_if(layout_.panels.begin(), layout_.panels.end(), shows);
}

/// The background, the title, and what is said beside it.
void Composer::compose_page(DisplayList& list) const {
    const float t = layout_.text;
    const auto& page = layout_.page;
    const auto& style = layout_.style;
    const auto& size = scene_.preset.video.size;
    if (!scene_.preset.video.transparent)
        list.push_back(
            Box{0, 0, static_cast<float>(size.width), static_cast<float>(size.height), 0, style.theme.background});
    // long words shrink until they fit beside the clock
    const auto fitted = [&](const std::string& text, float y, double px, Weight weight, Color color,
                            const std::string& beside, double beside_px) {
        const float width = page.width() - text_width(beside, static_cast<float>(beside_px)) - 30 * t;
        list.push_back(Label{text,
                             {page.left, y},
                             fitting_size(text, static_cast<float>(px), weight, width),
                             Align::left,
                             weight,
                             color});
    };
    const auto speed = speed_words(scene_.preset.video.speed);
    fitted(layout_.title, page.top + 38 * t, style.font.title, Weight::bold, style.theme.text,
           clock(scene_, scene_.time(scene_.samples)), style.font.clock);
    fitted(layout_.subtitle, page.top + 74 * t, style.font.subtitle, Weight::regular, style.theme.quiet_text, speed,
           style.font.subtitle);
    list.push_back(Label{speed,
                         {page.right, page.top + 74 * t},
                         static_cast<float>(style.font.subtitle),
                         Align::right,
                         Weight::regular,
                         style.theme.quiet_text});
}

DisplayList Composer::backdrop() const {
    DisplayList list;
    compose_page(list);
    for (const auto& panel : layout_.panels) compose_panel_backdrop(panel, list);
    if (layout_.phase) compose_phase_backdrop(list);
    compose_horizon(list);
    for (const auto& strip : layout_.strips) compose_strip_backdrop(strip, list);
    if (!layout_.strips.empty()) compose_time_labels(layout_.strips.back(), list);
    return list;
}

bool Composer::start_as_one() const {
    return start_distance_ <= together_at;
}

void Composer::add(const Shot& shot) {
    now_ = shot;
    const auto& moment = now_.moment;
    const double time = now();
    if (moment.sample == 0) start_distance_ = moment.distance;
    largest_distance_ = std::max(largest_distance_, moment.distance);
    for (std::size_t side = 0; side < 2; ++side) {
        if (!layout_.panels.empty() && scene_.preset.video.trail_s > 0)
            extend_trail(side, seen(side).bobs.back(), time);
        if (layout_.phase) extend_phase(side, seen(side).bobs, time);
    }
    for (std::size_t i = 0; i < layout_.strips.size(); ++i) {
        const auto& strip = layout_.strips[i];
        const auto values = strip_values(strip.kind);
        traces_[i].resize(values.size());
        for (std::size_t k = 0; k < values.size(); ++k)
            if (values[k].value) traces_[i][k].add({strip.time.at(time), strip.value.at(*values[k].value)});
    }
    if (start_as_one() && !parted_ && moment.distance >= parted_at) parted_ = time;
}

DisplayList Composer::frame() const {
    DisplayList list;
    list.push_back(Label{clock(scene_, now()),
                         {layout_.page.right, layout_.page.top + 38 * layout_.text},
                         static_cast<float>(layout_.style.font.clock),
                         Align::right,
                         Weight::regular,
                         layout_.style.theme.text});
    for (const auto& panel : layout_.panels) compose_panel(panel, list);
    if (layout_.phase) compose_phase(list);
    for (std::size_t i = 0; i < layout_.strips.size(); ++i) compose_strip(i, list);
    return list;
}

}  // namespace doppel
