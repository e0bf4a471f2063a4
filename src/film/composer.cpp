#include "film/composer.hpp"

#include "base/embedded.hpp"
#include "render/font.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace doppel {
namespace {

constexpr double parted_at = 1;                  // state-space distance from which the two count as parted
constexpr double together_at = 0.1 * parted_at;  // up to which a pair starts as one, and can part

/// As many decimals as tell one frame from the next.
std::string clock(const Scene& scene, double time) {
    const auto& speed = scene.preset.video.speed;
    double slowest = speed.constant.value();
    if (speed.changes_over_time()) slowest = speed.changes.front().speed.value();
    for (const auto& change : speed.changes) slowest = std::min(slowest, change.speed.value());
    const double frame = 1 / (scene.fps.value() / slowest);
    return fmt::format("{:.{}f} s", time, frame >= 1 ? 0 : frame >= 0.1 ? 1 : 2);
}

std::string speed_text(const Rational& speed) {
    if (speed == Rational{1, 1}) return "real time";
    return fmt::format("{} ×{:g}", speed.value() < 1 ? "slow motion" : "time lapse", speed.value());
}

/// The background, the title, and what is said beside it: the speed and the time.
/// What the clock says where the speed changes: "¼ speed".
std::string changing_speed_text(const Rational& speed) {
    constexpr std::array<std::pair<Rational, std::string_view>, 8> fractions{{{{1, 2}, "½"},
                                                                              {{1, 3}, "⅓"},
                                                                              {{2, 3}, "⅔"},
                                                                              {{1, 4}, "¼"},
                                                                              {{3, 4}, "¾"},
                                                                              {{1, 5}, "⅕"},
                                                                              {{1, 6}, "⅙"},
                                                                              {{1, 8}, "⅛"}}};
    for (const auto& [fraction, sign] : fractions)
        if (speed == fraction) return fmt::format("{} speed", sign);
    return speed_text(speed);
}

class PageLayer final : public Layer {
public:
    using Layer::Layer;

    void backdrop(DisplayList& list) const override {
        const auto& font = style_.font;
        if (const auto& video = state_.scene.preset.video; !video.transparent)
            list.push_back(filled(video.size, theme_.background));
        // long text shrinks until it fits beside the clock
        const auto fitted = [&](const std::string& text, float y, double wanted, Weight weight, Color color,
                                const std::string& beside, double beside_size) {
            const float width = page_.width() - text_width(beside, px(beside_size)) - 30 * layout_.text;
            const float size = fitting_size(text, px(wanted), weight, width);
            list.push_back(label(text, {page_.left, y}, size, color, Align::left, weight));
        };
        const auto speed = changes_ ? std::string("slow motion ×0.25") : speed_text(speed_.constant);
        const auto longest = clock(state_.scene, state_.scene.time(state_.scene.samples));
        const float second = page_.top + 74 * layout_.text;
        fitted(layout_.title, title_, font.title, Weight::bold, theme_.text, longest, font.clock);
        fitted(layout_.subtitle, second, font.subtitle, Weight::regular, theme_.quiet_text, speed, font.subtitle);
        if (!has_clock_ || changes_) return;
        list.push_back(label(speed, {page_.right, second}, px(font.subtitle), theme_.quiet_text, Align::right));
    }

    void frame(DisplayList& list) const override {
        if (!has_clock_) return;
        list.push_back(label(clock(state_.scene, state_.time()), {page_.right, title_}, px(style_.font.clock),
                             theme_.text, Align::right));
        if (changes_)
            list.push_back(label(changing_speed_text(speed_at(state_.scene.preset.video, state_.time())),
                                 {page_.right, page_.top + 74 * layout_.text}, px(style_.font.subtitle),
                                 theme_.quiet_text, Align::right));
    }

private:
    const Speed& speed_ = state_.scene.preset.video.speed;
    const bool changes_ = speed_.changes_over_time();
    const bool has_clock_ = state_.scene.preset.video.shows("clock");
    const Area& page_ = layout_.page;
    const float title_ = page_.top + 38 * layout_.text;  // baseline
};

/// A line of text on a card.
struct CardLine {
    std::string text;
    double size;  // px
    Weight weight = Weight::regular;
    Color color;
};

/// The lines in the middle of the picture, on the background, all as opaque as the card.
DisplayList card(const std::vector<CardLine>& lines, Size size, Color background, double opacity) {
    const auto alpha = static_cast<float>(opacity);
    constexpr double leading = 1.55;
    double tall = 0;
    for (const auto& line : lines) tall += leading * line.size;
    DisplayList list{filled(size, background.with_alpha(alpha))};
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    double y = (height - tall) / 2;
    for (const auto& line : lines) {
        y += leading * line.size;
        const float fits = fitting_size(line.text, px(line.size), line.weight, 0.88f * width);
        list.push_back(label(line.text, {width / 2, static_cast<float>(y - 0.35 * line.size)}, fits,
                             line.color.with_alpha(alpha), Align::center, line.weight));
    }
    return list;
}

}  // namespace

bool FilmState::start_as_one() const {
    return start_distance <= together_at;
}

Composer::Composer(const Scene& scene, const std::atomic<bool>& stop) : state_{scene, make_layout(scene, stop)} {
    const auto& layout = state_.layout;
    layers_.push_back(std::make_unique<PageLayer>(state_));
    for (const auto& panel : layout.panels) layers_.push_back(make_pendulum_layer(state_, panel));
    if (layout.phase) layers_.push_back(make_phase_layer(state_, *layout.phase));
    for (std::size_t i = 0; i < layout.strips.size(); ++i) layers_.push_back(make_strip_layer(state_, i));
}

DisplayList Composer::backdrop() const {
    DisplayList list;
    for (const auto& layer : layers_) layer->backdrop(list);
    return list;
}

void Composer::add(const Snapshot& snapshot) {
    state_.snapshot = snapshot;
    const auto& state = snapshot.pair;
    if (state.tick == 0) state_.start_distance = state.distance;
    state_.largest_distance = std::max(state_.largest_distance, state.distance);
    if (state_.start_as_one() && !state_.parted && state.distance >= parted_at) state_.parted = state_.time();
    for (const auto& layer : layers_) layer->add();
}

DisplayList Composer::frame() const {
    DisplayList list;
    for (const auto& layer : layers_) layer->frame(list);
    return list;
}

DisplayList Composer::title_card(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const auto captions = side_captions(state_.scene);
    return card({{state_.scene.preset.title, font.card, Weight::bold, theme.text},
                 {scene_caption(state_.scene), 1.5 * font.subtitle, Weight::regular, theme.quiet_text},
                 {"", font.subtitle, Weight::regular, theme.text},
                 {captions[0].heading, 1.3 * font.heading, Weight::bold, theme.sides[0]},
                 {captions[1].heading, 1.3 * font.heading, Weight::bold, theme.sides[1]}},
                state_.scene.preset.video.size, theme.background, opacity);
}

DisplayList Composer::end_card(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const auto size = 1.3 * font.heading;
    const auto outcome = !state_.start_as_one() ? "apart from the start"
                         : state_.parted
                             ? fmt::format("parted after {:.1f} s", *state_.parted)
                             : fmt::format("together to the end, {:g} s", state_.scene.time(state_.scene.samples));
    std::vector<CardLine> lines{{state_.scene.preset.title, 0.7 * font.card, Weight::bold, theme.text},
                                {"", font.subtitle, Weight::regular, theme.text},
                                {outcome, size, Weight::regular, theme.trace}};
    if (state_.start_distance > 0)
        lines.push_back({fmt::format("from a state-space distance of {} to {}", scientific(state_.start_distance),
                                     scientific(state_.largest_distance)),
                         size, Weight::regular, theme.text});
    if (state_.scene.preset.video.shows("credit")) {
        lines.push_back({"", font.subtitle, Weight::regular, theme.text});
        lines.push_back({fmt::format("Doppel {} · {}", version(), state_.scene.preset.name), font.subtitle,
                         Weight::regular, theme.quiet_text});
    }
    return card(lines, state_.scene.preset.video.size, theme.background, opacity);
}

}  // namespace doppel
