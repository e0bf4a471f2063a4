#include "film/layer.hpp"
#include "film/strips.hpp"
#include "plot/labels.hpp"
#include "render/stroke.hpp"
#include "scene/certificate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace doppel {
namespace {

/// A time on the axis, with its text.
struct TimeMark {
    double time_s;
    std::string text;
};

/// The predictability limits, and the time until which the run is proved.
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

/// ", the true motions at 15.4 s", if that is proved.
std::string true_divergence_words(const Scene& scene) {
    const auto& proof = scene.certificate;
    if (!proof || !proof->diverged_s) return {};
    const auto from = fmt::format("{:.1f}", proof->diverged_s->low),
               to = fmt::format("{:.1f}", proof->diverged_s->high);
    return fmt::format(", the true motions at {}{} s", from, from == to ? "" : " to " + to);
}

class StripLayer final : public Layer {
public:
    StripLayer(const FilmState& state, const StripLayout& strip) : Layer(state), strip_(strip) {}

    void marks(DisplayList& list) const override {
        const auto& area = strip_.area;
        // times after the predictability limit are dimmed
        if (const auto limit = state_.scene.horizon())
            list.push_back(Box{strip_.time.at(*limit), area.top, area.right, area.bottom, 0, theme_.panel});
        if (const auto& proof = state_.scene.certificate)  // a band along the axis
            list.push_back(Box{area.left, area.bottom - band * px(style_.font.axis),
                               strip_.time.at(proof->run_until_s()), area.bottom, 0, theme_.trace.with_alpha(0.5f)});
        for (const auto& mark : limits_) draw_line(mark, list);
    }
    void backdrop(DisplayList& list) const override {
        const auto& area = strip_.area;
        const float em = px(style_.font.axis), line = px(style_.width.grid);
        const bool has_times = strip_.cell.bottom > area.bottom + em;
        add_axis(strip_.time, area, strip_.cell, {.edge = Edge::bottom, .has_numbers = has_times, .unit = " s"}, list);
        add_axis(strip_.value, area, strip_.cell, {.edge = Edge::left, .has_numbers = strip_.lines > 0}, list);
        if (line > 0) {
            list.push_back(vertical_line(area.left, area.top, area.bottom, line, theme_.frame));
            list.push_back(horizontal_line(area.bottom, area.left, area.right, line, theme_.frame));
        }
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
        const auto marks = texts(state_.outcome);
        if (marks.size() > limits_.size()) draw_line(marks.back(), list);
        const float x = strip_.time.at(state_.time());
        if (style_.width.mark > 0)
            list.push_back(vertical_line(x, area.top, area.bottom, px(style_.width.mark), theme_.cursor));
        const auto rows = rows_of(marks).first;
        for (const auto& row : video_.transparent ? std::vector<Label>() : rows) {
            // no grid line crosses the text; curves lie between it and its background
            const auto [left, top, right, bottom] = box_of(row);
            list.push_back(Box{left, top, right, bottom, 0, theme_.background.with_alpha(0.85f)});
        }
        for (std::size_t k = 0; style_.width.trace > 0 && k < now.size(); ++k) {
            auto curve = traces_[k];
            if (state_.is_between()) extend(curve, now[k]);
            for (const auto& trace : curve.pieces)
                list.push_back(Stroke{.vertices = trace.vertices(), .width = px(now[k].width), .color = now[k].color});
        }
        list.insert(list.end(), rows.begin(), rows.end());
        if (now.size() != 1 || !now[0].value || !is_inside(*now[0].value) || !(style_.width.trace > 0)) return;
        const Point head{x, strip_.value.at(*now[0].value)};
        list.push_back(Capsule{head, head, std::max(2.3f * px(style_.width.trace), 2.0f), now[0].color});
    }

    std::vector<std::string> left_out() const override {
        auto words = rows_of(texts(state_.outcome)).second;
        if (strip_.lines == 0) words.push_back(fmt::format("\"{}\"", title_of(strip_.kind, state_.scene)));
        return words;
    }

    std::vector<Label> rows(const Outcome& outcome) const { return rows_of(texts(outcome)).first; }

private:
    /// The marks with texts: limits and the divergence.
    std::vector<TimeMark> texts(const Outcome& outcome) const {
        if (!is_of_pair()) return {};
        auto marks = limits_;
        if (const auto since = outcome.divergence.since())
            marks.push_back(
                {*since, fmt::format("diverged at {:.1f} s{}", *since, true_divergence_words(state_.scene))});
        return marks;
    }
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

    /// The area of a text and around it, px.
    Area box_of(const Label& row) const {
        const float room = 4 * layout_.text, right = row.anchor.x + style_.type.width(row.text, row.size) + room;
        return {row.anchor.x - room, row.anchor.y - 0.9f * row.size, right, row.anchor.y + 0.28f * row.size};
    }
    /// The text of a mark beside its line, in rows if there is little space; none if a word is too wide for the space
    /// between the lines of other marks.
    std::vector<Label> words_at(const TimeMark& mark, const std::vector<TimeMark>& marks, float size) const {
        const float t = layout_.text, x = strip_.time.at(mark.time_s), gap = 10 * t;
        float from = strip_.area.left, to = strip_.area.right;
        for (const auto& other : marks) {
            const float at = strip_.time.at(other.time_s);
            if (at < x) from = std::max(from, at);
            if (at > x) to = std::min(to, at);
        }
        const float right = to - x - 2 * gap, left = x - from - 2 * gap, first = from + 2 * t;
        const auto& type = style_.type;
        const bool is_right = right >= std::min(type.width(mark.text, size), left);
        const float width = std::clamp(is_right ? right : left, 5 * size, std::max(5 * size, to - from));
        const auto rows = wrapped(mark.text, size, Weight::regular, width, type);
        std::vector<Label> words;
        if (fmt::format("{}", fmt::join(rows, " ")) != mark.text) return words;
        for (const auto& row : rows) {
            const float length = type.width(row, size), last = to - length - 2 * t;
            if (last < first) return {};
            const float start = std::clamp(is_right ? x + gap : x - gap - length, first, last);
            words.push_back(label(row, {start, 0}, size, theme_.text));
        }
        return words;
    }
    /// Their texts, each as low as it covers least of the film's curve, and smaller if need be; and the texts for which
    /// there is no space. The last, that of the divergence, has the first choice.
    std::pair<std::vector<Label>, std::vector<std::string>> rows_of(const std::vector<TimeMark>& marks) const {
        std::vector<Label> rows;
        std::vector<std::string> left_out;
        const float size = px(style_.font.strip);
        for (auto mark = marks.rbegin(); mark != marks.rend(); ++mark) {
            std::vector<Label> words;
            for (const float share : {1.0f, 0.85f, 0.7f, 0.6f})
                if (words.empty() && strip_.lines > 0)
                    words =
                        placed(words_at(*mark, marks, std::max(share * size, std::min(layout_.min_text, size))), rows);
            if (words.empty()) left_out.push_back(fmt::format("\"{}\"", mark->text));
            rows.insert(rows.end(), words.begin(), words.end());
        }
        return {rows, left_out};
    }
    /// The rows of a text where they cover least of the curve, and no other text; none if there is no such place.
    std::vector<Label> placed(std::vector<Label> words, const std::vector<Label>& others) const {
        if (words.empty()) return words;
        const float size = words[0].size, line = 1.2f * size;
        const float above = state_.scene.certificate ? band * px(style_.font.axis) : 0;
        const float top = strip_.area.top + size, high = line * (static_cast<float>(words.size()) - 1);
        const float foot = strip_.area.bottom - 0.45f * size - above - high, slack = 0.25f * line;
        std::optional<float> best;
        float least = 0;
        const auto place = [&](float first) {
            for (auto& row : words) row.anchor.y = std::exchange(first, first + line);
        };
        for (float first = foot; foot >= top - slack; first = std::max(first - line / 2, top)) {
            place(first);
            float covered = 0;  // px²
            bool is_free = true;
            for (const auto& row : words) {
                const auto box = box_of(row);
                for (const auto& other : others) is_free = is_free && !box.overlaps(box_of(other));
                for (const auto& curve : strip_.covered)
                    if (curve.overlaps(box))
                        covered += (std::min(curve.right, box.right) - std::max(curve.left, box.left)) *
                                   (std::min(curve.bottom, box.bottom) - std::max(curve.top, box.top));
            }
            if (is_free && (!best || covered < least)) best = first, least = covered;
            if (first <= top || (best && least == 0)) break;
        }
        if (!best) return {};
        place(*best);
        return words;
    }

    static constexpr float band = 0.25f;  // height of the band of a proof, em
    const StripLayout& strip_;
    const std::vector<TimeMark> limits_ = limits_of(state_.scene);
    std::vector<CutCurve> traces_;  // one for each curve
};

}  // namespace

DisplayList placed_marks(const FilmState& state, const Outcome& outcome, const StripLayout& strip) {
    const auto rows = StripLayer(state, strip).rows(outcome);
    return {rows.begin(), rows.end()};
}

std::unique_ptr<Layer> make_strip_layer(const FilmState& state, const StripLayout& strip) {
    return std::make_unique<StripLayer>(state, strip);
}

}  // namespace doppel
