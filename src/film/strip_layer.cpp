#include "film/strip_layer.hpp"

#include "film/strips.hpp"
#include "plot/labels.hpp"
#include "render/stroke.hpp"
#include "scene/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace doppel {
namespace {

class StripLayer final : public Layer {
public:
    StripLayer(const FilmState& state, const StripLayout& strip) : Layer(state), strip_(strip) {}

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
        const float row = 1.2f * px(style_.font.strip);
        float foot = area.bottom - 0.45f * px(style_.font.strip);
        std::vector<MarkWords> words;
        for (const auto& mark : marks) words.push_back(words_at(mark));
        const auto are_too_high = [&] {
            std::size_t rows = 0;
            for (const auto& one : words) rows += one.rows.size();
            return static_cast<float>(rows) * row > foot - area.top + 0.25f * row;
        };
        while (!words.empty() && are_too_high()) words.erase(words.begin());  // limits come first
        DisplayList texts;
        for (const auto& one : words) place_text(one, foot, list, texts);
        for (std::size_t k = 0; style_.width.trace > 0 && k < now.size(); ++k) {
            auto curve = traces_[k];
            if (state_.is_between()) extend(curve, now[k]);
            for (const auto& trace : curve.pieces)
                list.push_back(Stroke{.vertices = trace.vertices(), .width = px(now[k].width), .color = now[k].color});
        }
        std::ranges::move(texts, std::back_inserter(list));
        if (now.size() != 1 || !now[0].value || !is_inside(*now[0].value) || !(style_.width.trace > 0)) return;
        const Point head{x, strip_.value.at(*now[0].value)};
        list.push_back(Capsule{head, head, std::max(2.3f * px(style_.width.trace), 2.0f), now[0].color});
    }

private:
    std::vector<StripCurve> curves() const {
        return strip_curves(strip_.kind, state_.scene, state_.snapshot.pair, state_.outcome.start_distance, style_);
    }
    /// A curve, cut where it leaves its axis.
    struct CutCurve {
        std::vector<Trace> pieces;
        Point last{};
        bool was_inside = false;
    };

    bool is_inside(double value) const {
        constexpr double rounding = 1e-6;
        const double share = strip_.value.share(value);
        return share >= -rounding && share <= 1 + rounding;
    }
    /// Pieces end and begin at the ends of the axis; the first one begins in it.
    void extend(CutCurve& curve, const StripCurve& now) const {
        if (!now.value) return;
        const Point at{strip_.time.at(state_.time()), strip_.value.at(*now.value)};
        const bool inside = is_inside(*now.value);
        if (inside && !curve.was_inside) {
            const bool is_first = curve.pieces.empty();
            curve.pieces.emplace_back();
            if (!is_first) curve.pieces.back().add(curve.last);
        }
        if (inside || curve.was_inside) curve.pieces.back().add(at);
        curve.last = at;
        curve.was_inside = inside;
    }
    /// Whether this strip shows the marks of the pair: that of the distance, otherwise the first.
    bool is_of_pair() const {
        const auto of_distance = std::ranges::find(layout_.strips, StripKind::distance, &StripLayout::kind);
        return &strip_ == &(of_distance == layout_.strips.end() ? layout_.strips.front() : *of_distance);
    }
    /// A dashed vertical line.
    void draw_line(const TimeMark& mark, DisplayList& list) const {
        const float bottom = strip_.area.bottom, dash = 5 * layout_.text;
        for (float top = strip_.area.top; style_.width.mark > 0 && top < bottom; top += 2 * dash)
            list.push_back(vertical_line(strip_.time.at(mark.time_s), top, std::min(top + dash, bottom),
                                         px(style_.width.mark), theme_.quiet_text));
    }

    /// The text of a mark beside its line, in several rows if there is little space.
    struct MarkWords {
        float x, gap;
        bool is_right;
        std::vector<std::string> rows;
    };
    MarkWords words_at(const TimeMark& mark) const {
        const auto& area = strip_.area;
        const float size = px(style_.font.strip), x = strip_.time.at(mark.time_s), gap = 10 * layout_.text;
        const float right = area.right - x - 2 * gap, left = x - area.left - 2 * gap;
        const bool is_right = right >= std::min(text_width(mark.text, size), left);
        const float width = std::clamp(is_right ? right : left, 5 * size, area.width());
        return {x, gap, is_right, wrapped(mark.text, size, Weight::regular, width)};
    }
    /// At the foot of the line, above the texts before. Curves lie between the text and its background.
    void place_text(const MarkWords& mark, float& foot, DisplayList& list, DisplayList& texts) const {
        const auto& area = strip_.area;
        const auto& [x, gap, is_right, rows] = mark;
        const float t = layout_.text, size = px(style_.font.strip);
        for (auto words = rows.rbegin(); words != rows.rend(); ++words, foot -= 1.2f * size) {
            const float row = text_width(*words, size), first = area.left + 2 * t;
            const float from =
                std::clamp(is_right ? x + gap : x - gap - row, first, std::max(first, area.right - row - 2 * t));
            // no grid line crosses the text
            if (!video_.transparent)
                list.push_back(Box{from - 4 * t, foot - 0.9f * size, from + row + 4 * t, foot + 0.28f * size, 0,
                                   theme_.background.with_alpha(0.85f)});
            texts.push_back(label(*words, {from, foot}, size, theme_.text));
        }
    }

    const StripLayout& strip_;
    std::vector<CutCurve> traces_;  // one for each curve
};

}  // namespace

std::unique_ptr<Layer> make_strip_layer(const FilmState& state, const StripLayout& strip) {
    return std::make_unique<StripLayer>(state, strip);
}

}  // namespace doppel
