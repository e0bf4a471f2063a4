#include "film/strips.hpp"

#include "film/layer.hpp"
#include "film/recording.hpp"
#include "numeric/state.hpp"
#include "plot/labels.hpp"
#include "render/stroke.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

/// The quantities of strips, before their values or names of curves.
constexpr std::array<const char*, strip_kinds> titles{"state-space distance",
                                                      "finite-time growth rate, 1/s",
                                                      "energy error, of the potential range",
                                                      "rod length error, m",
                                                      "rod tension, N",
                                                      "energy, J",
                                                      "energy, J",
                                                      "angles, °",
                                                      "angular rates, °/s",
                                                      "energy, J"};

std::string strip_title(StripKind kind, const Scene& scene) {
    const auto &a = scene.preset.a, &b = scene.preset.b;
    std::string title = titles[static_cast<std::size_t>(kind)];
    const bool is_a = kind == StripKind::energies_a;
    if ((is_a || kind == StripKind::energies_b) && !scene.is_single())
        return fmt::format("energy of {}, J", (is_a ? a : b).label.value_or(is_a ? "a" : "b"));
    if (kind == StripKind::total_energy && (drive_period(a) || drive_period(b)))
        return title + ", mean over a drive period";
    if (kind != StripKind::distance) return title;
    if (wording_of(scene) == Wording::plain) title = "their distance";
    if (!scene.members.empty()) return title + ", first to last";
    return differ_in_kind(a, b) ? title + ", of the last masses" : title;
}

/// A curve for each link or rod; for many, the first and the last one. The inner ones are paler.
template <class Value>
void add_links(std::vector<StripCurve>& curves, char side, std::size_t count, const Value& value, Color color,
               Color pale, double width) {
    constexpr std::size_t maximum = 3;
    const float paleness = count < 2 ? 0 : 0.6f;
    for (std::size_t k = 0; k < count; ++k)
        if (count <= maximum || k == 0 || k + 1 == count)
            curves.push_back(
                {value(k), mixed(color, pale, k + 1 == count ? 0 : paleness), width, fmt::format("{}{}", side, k + 1)});
}

/// A part of a caption. With `room` > 0 it is not broken, and has that width in px whatever its text.
struct Piece {
    std::string text;
    Color color;
    float room = 0;
};

std::vector<Piece> pieces_of(StripKind kind, const Scene& scene, const Layout& layout,
                             const std::vector<StripCurve>& curves, bool starts_equal) {
    const auto& theme = layout.style.theme;
    const auto width = [&](const char* text) { return layout.style.type.width(text, px(layout.style.font.strip)); };
    std::vector<Piece> pieces{{strip_title(kind, scene), theme.text}};
    if (kind == StripKind::distance)
        pieces.push_back({scientific(*curves[0].value), curves[0].color, width("8.8 × 10⁻⁸⁸")});
    else if (kind == StripKind::exponent && starts_equal)
        pieces.push_back({"none, d₀ = 0", theme.quiet_text});
    else if (kind == StripKind::exponent)
        pieces.push_back(
            {curves[0].value ? fmt::format("{:.2f}", *curves[0].value) : "", curves[0].color, width("−8.88")});
    else if (kind == StripKind::energy &&
             std::ranges::none_of(curves, [](const auto& one) { return one.value.has_value(); }))
        pieces.push_back({"none: damping removes energy", theme.quiet_text});
    for (const auto& curve : curves)
        if (!curve.name.empty()) pieces.push_back({curve.name, curve.color, width(curve.name.c_str())});
    return pieces;
}

/// The words of a text, each with the following space.
std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t from = 0; from < text.size();) {
        const auto space = std::min(text.find(' ', from), text.size() - 1);
        words.push_back(text.substr(from, space + 1 - from));
        from = space + 1;
    }
    return words;
}

/// A caption in lines no wider than `width` px. The first line begins at (0, 0).
std::vector<Label> strip_caption(StripKind kind, const Scene& scene, const Layout& layout,
                                 const std::vector<StripCurve>& curves, bool starts_equal, float width) {
    const float size = px(layout.style.font.strip), line = caption_line(layout), gap = 0.66f * size;
    const auto width_of = [&](const std::string& text) { return layout.style.type.width(text, size); };
    std::vector<Label> labels;
    Point pen;
    for (const auto& piece : pieces_of(kind, scene, layout, curves, starts_equal)) {
        if (pen.x > 0) pen.x += gap;
        const auto parts = piece.room > 0 ? std::vector{piece.text} : words_of(piece.text);
        bool continues = false;  // continues the previous label
        for (const auto& part : parts) {
            const float room = std::max(piece.room, width_of(part.substr(0, part.find_last_not_of(' ') + 1)));
            if (pen.x > 0 && pen.x + room > width) pen = {0, pen.y + line}, continues = false;
            if (continues)
                labels.back().text += part;
            else
                labels.push_back(label(part, pen, size, piece.color));
            continues = true;
            pen.x += std::max(piece.room, width_of(part));
        }
    }
    for (auto& words : labels) words.text.erase(words.text.find_last_not_of(' ') + 1);
    return labels;
}

class StripLayer final : public Layer {
public:
    StripLayer(const FilmState& state, std::size_t index) : Layer(state), index_(index) {}

    void backdrop(DisplayList& list) const override {
        const auto& area = strip_.area;
        const float em = px(style_.font.axis), line = px(style_.width.grid);
        // times after the predictability limit are dimmed
        if (const auto limit = state_.scene.horizon())
            list.push_back(Box{strip_.time.at(*limit), area.top, area.right, area.bottom, 0, theme_.panel});
        auto style = axis_style();
        style.has_numbers = strip_.cell.bottom > area.bottom + em;
        style.unit = " s";
        add_axis(strip_.time, area, strip_.cell, style, list);
        style.edge = AxisStyle::Edge::left;
        style.has_numbers = true;
        add_axis(strip_.value, area, strip_.cell, style, list);
        if (line > 0) {
            list.push_back(vertical_line(area.left, area.top, area.bottom, line, theme_.frame));
            list.push_back(horizontal_line(area.bottom, area.left, area.right, line, theme_.frame));
        }
        if (const auto& proof = state_.scene.certificate)  // a band along the axis
            list.push_back(Box{area.left, area.bottom - 0.25f * em, strip_.time.at(proof->run_until_s()), area.bottom,
                               0, theme_.trace.with_alpha(0.5f)});
        for (const auto& mark : limits_of(state_.scene)) draw_line(mark, list);
    }

    void add() override {
        const auto now = curves();
        traces_.resize(now.size());
        for (std::size_t k = 0; k < now.size(); ++k) extend(traces_[k], now[k]);
    }
    void frame(DisplayList& list) const override {
        const auto now = curves();
        const auto& area = strip_.area;
        for (auto& words : placed_caption(strip_, state_.scene, layout_, now, state_.outcome.start_distance == 0))
            list.push_back(std::move(words));
        auto marks = is_of_pair() ? limits_of(state_.scene) : std::vector<TimeMark>();
        if (const auto since = state_.outcome.divergence.since(); since && is_of_pair()) {
            marks.push_back(
                {*since, fmt::format("diverged at {:.1f} s{}", *since, true_divergence_words(state_.scene))});
            draw_line(marks.back(), list);
        }
        const float x = strip_.time.at(state_.time());
        if (style_.width.mark > 0)
            list.push_back(vertical_line(x, area.top, area.bottom, px(style_.width.mark), theme_.cursor));
        for (std::size_t k = 0; style_.width.trace > 0 && k < now.size(); ++k) {
            auto trace = traces_[k];
            if (state_.is_between()) extend(trace, now[k]);
            list.push_back(Stroke{.vertices = trace.vertices(), .width = px(now[k].width), .color = now[k].color});
        }
        float foot = area.bottom - 0.45f * px(style_.font.strip);
        for (const auto& mark : marks) draw_text(mark, foot, list);  // above all lines
        if (now.size() != 1 || traces_[0].is_empty() || !(style_.width.trace > 0)) return;
        const Point head{x, strip_.value.at(*now[0].value)};
        list.push_back(Capsule{head, head, std::max(2.3f * px(style_.width.trace), 2.0f), now[0].color});
    }

private:
    std::vector<StripCurve> curves() const {
        return strip_curves(strip_.kind, state_.scene, state_.snapshot.pair, state_.outcome.start_distance, style_);
    }
    /// A curve begins where it enters its axis.
    void extend(Trace& trace, const StripCurve& now) const {
        if (now.value && !(trace.is_empty() && *now.value < strip_.value.low))
            trace.add({strip_.time.at(state_.time()), strip_.value.at(*now.value)});
    }
    /// Whether this strip shows the marks of the pair: that of the distance, otherwise the first.
    bool is_of_pair() const {
        const auto of_distance = std::ranges::find(layout_.strips, StripKind::distance, &StripLayout::kind);
        return of_distance == layout_.strips.end() ? index_ == 0 : strip_.kind == StripKind::distance;
    }
    /// A dashed vertical line.
    void draw_line(const TimeMark& mark, DisplayList& list) const {
        const float bottom = strip_.area.bottom, dash = 5 * layout_.text;
        for (float top = strip_.area.top; style_.width.mark > 0 && top < bottom; top += 2 * dash)
            list.push_back(vertical_line(strip_.time.at(mark.time_s), top, std::min(top + dash, bottom),
                                         px(style_.width.mark), theme_.quiet_text));
    }

    /// The text at the foot of a line, where curves are high up, above the texts before: beside the line, or on
    /// separate lines if there is little space.
    void draw_text(const TimeMark& mark, float& foot, DisplayList& list) const {
        const auto& [time, text] = mark;
        const auto& area = strip_.area;
        const float t = layout_.text, size = px(style_.font.strip), x = strip_.time.at(time), gap = 10 * t;
        const float width = text_width(text, size), right = area.right - x - 2 * gap, left = x - area.left - 2 * gap;
        const bool is_right = right >= std::min(width, left);
        const auto rows =
            wrapped(text, size, Weight::regular, std::clamp(is_right ? right : left, 5 * size, area.width()));
        for (auto words = rows.rbegin(); words != rows.rend(); ++words, foot -= 1.2f * size) {
            const float row = text_width(*words, size), first = area.left + 2 * t;
            const float from =
                std::clamp(is_right ? x + gap : x - gap - row, first, std::max(first, area.right - row - 2 * t));
            // no grid line crosses the text
            if (!state_.scene.preset.video.transparent)
                list.push_back(Box{from - 4 * t, foot - 0.9f * size, from + row + 4 * t, foot + 0.28f * size, 0,
                                   theme_.background.with_alpha(0.85f)});
            list.push_back(label(*words, {from, foot}, size, theme_.text));
        }
    }

    const std::size_t index_;
    const StripLayout& strip_ = layout_.strips[index_];
    std::vector<Trace> traces_;  // one for each curve
};

}  // namespace

std::vector<StripCurve> strip_curves(StripKind kind, const Scene& scene, const PairState& state, double start_distance,
                                     const Style& style) {
    const auto& theme = style.theme;
    const double width = style.width.trace;  // of single curves
    if (kind == StripKind::distance) return {{state.distance, theme.trace, width}};
    if (kind == StripKind::exponent) return {{growth_rate(scene, state, start_distance), theme.trace, width}};
    std::vector<StripCurve> curves;
    constexpr double degree = pi / 180;
    for (const char letter : scene.letters()) {
        const bool is_a = letter == 'a';
        const auto& side = scene.side(letter);
        const auto& seen = is_a ? state.a : state.b;
        const auto color = theme.sides[is_a ? 0 : 1];
        // the first is drawn first and is wider, so that both are visible where they coincide
        const double of_side = (scene.is_single() ? 1 : is_a ? 1.5 : 0.6) * width;
        const auto add_all = [&](std::size_t count, const auto& value) {
            add_links(curves, letter, count, value, color, theme.text, of_side);
        };
        switch (kind) {
            case StripKind::rod_error:
                curves.push_back({seen.length_error, color, of_side});
                break;
            case StripKind::energy:  // damping reduces the energy, so its change is no error
                curves.push_back({std::abs(seen.energy_change) / scene.energy_range(), color, of_side});
                if (!side.has_energy_error) curves.back().value.reset();
                break;
            case StripKind::total_energy:
                curves.push_back({is_a ? state.mean_energy_a : state.mean_energy_b, color, of_side});
                if (auto& mean = curves.back().value) *mean -= side.lowest_potential;
                break;
            case StripKind::rod_force:
                add_all(seen.tension.size(), [&](std::size_t k) { return seen.tension[k]; });
                break;
            case StripKind::angles:
                add_all(seen.bobs.size(), [&](std::size_t k) { return seen.bobs[k].theta / degree; });
                break;
            case StripKind::rates:
                add_all(seen.bobs.size(), [&](std::size_t k) { return seen.bobs[k].omega / degree; });
                break;
            default:
                if (is_a != (kind == StripKind::energies_a)) break;
                curves.push_back({seen.kinetic_energy, color, 0.8 * width, "kinetic"});
                curves.push_back({seen.energy - side.lowest_potential - seen.kinetic_energy,
                                  mixed(color, theme.background, 0.35f), 0.8 * width, "potential"});
                curves.push_back({seen.energy - side.lowest_potential, theme.text, 0.6 * width, "total"});
        }
    }
    return curves;
}

std::optional<double> growth_rate(const Scene& scene, const PairState& state, double start_distance) {
    if (state.sample == 0 || 20 * state.sample < scene.samples) return std::nullopt;
    if (!(state.distance > 0 && start_distance > 0)) return std::nullopt;
    return std::log(state.distance / start_distance) / scene.time(state.moment());
}

std::vector<TimeMark> limits_of(const Scene& scene) {
    std::vector<TimeMark> marks;
    if (const auto limit = scene.horizon())
        marks.push_back({*limit, fmt::format("numerical predictability limit {:.1f} s", *limit)});
    if (const auto& proof = scene.certificate) {
        const double until = proof->run_until_s();
        marks.push_back({until, fmt::format("proved until {:.1f} s", std::floor(10 * until) / 10)});  // not later
    }
    if (const auto limit = scene.preset.video.model_limit_s)
        marks.push_back({*limit, fmt::format("predictability limit of the model {:.1f} s", *limit)});
    std::erase_if(marks, [&](const TimeMark& mark) { return mark.time_s > scene.time(scene.samples); });
    return marks;
}

std::string true_divergence_words(const Scene& scene) {
    const auto& proof = scene.certificate;
    if (!proof || !proof->diverged_s) return {};
    const auto from = fmt::format("{:.1f}", proof->diverged_s->low),
               to = fmt::format("{:.1f}", proof->diverged_s->high);
    return fmt::format(", the true motions at {}{} s", from, from == to ? "" : " to " + to);
}

float caption_line(const Layout& layout) {
    return 1.24f * px(layout.style.font.strip);
}

float above_curves(const Layout& layout) {
    return 0.9f * px(layout.style.font.strip);
}

std::vector<Label> placed_caption(const StripLayout& strip, const Scene& scene, const Layout& layout,
                                  const std::vector<StripCurve>& curves, bool starts_equal) {
    auto words = strip_caption(strip.kind, scene, layout, curves, starts_equal, strip.cell.width());
    const float room = caption_line(layout) * (static_cast<float>(strip.lines) - 0.5f);
    std::erase_if(words, [&](const Label& label) { return label.anchor.y > room; });
    for (auto& label : words) label.anchor = {strip.cell.left + label.anchor.x, strip.baseline + label.anchor.y};
    return words;
}

int caption_lines(StripKind kind, const Scene& scene, const Layout& layout, float width) {
    const auto curves = strip_curves(kind, scene, blank_snapshot(scene).pair, 0, layout.style);
    const auto labels = strip_caption(kind, scene, layout, curves, false, width);
    return 1 + static_cast<int>(std::lround(labels.back().anchor.y / caption_line(layout)));
}

std::unique_ptr<Layer> make_strip_layer(const FilmState& state, std::size_t index) {
    return std::make_unique<StripLayer>(state, index);
}

}  // namespace doppel
