#include "plot/labels.hpp"

#include "base/text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace doppel {
namespace {

using Measure = std::function<float(std::string_view)>;  // the width of a text, px

/// The number of bytes of `text` whose whole characters are at most `width` px wide; at least one character.
std::size_t bytes_within(std::string_view text, const Measure& width_of, float width) {
    std::size_t taken = 0;
    for (std::string_view rest = text; !rest.empty();) {
        next_character(rest);
        const std::size_t next = text.size() - rest.size();
        if (taken > 0 && width_of(text.substr(0, next)) > width) break;
        taken = next;
    }
    return taken;
}

/// Whether a line must not break between the words: "2 464", "1 kg", "θ₁ = 45°".
bool stay_together(std::string_view word, std::string_view next) {
    const auto is_sign = [](std::string_view text) { return text == "=" || text == "×" || text == "±"; };
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (is_sign(word) || is_sign(next)) return true;
    if (!is_digit(word.back())) return false;
    constexpr std::size_t unit = 4;  // letters, with punctuation
    std::size_t letters = 0;
    for (std::string_view rest = next; !rest.empty(); ++letters) next_character(rest);
    return is_digit(next.front()) || letters <= unit;
}

void wrap_paragraph(std::string_view text, const Measure& width_of, float width, std::vector<std::string>& lines) {
    std::string line;
    std::size_t last_break = 0;  // where the line may end; 0 = nowhere
    for (std::string_view before, word; !text.empty(); text.remove_prefix(std::min(word.size() + 1, text.size()))) {
        word = text.substr(0, text.find(' '));
        if (word.empty()) continue;
        if (!line.empty()) {
            if (!stay_together(before, word)) last_break = line.size();
            line += ' ';
        }
        line += before = word;
        while (width_of(line) > width) {
            std::size_t end = last_break;
            if (end == 0) {  // rather after a word or a hyphen
                end = bytes_within(line, width_of, width);
                if (end == line.size()) break;
                const auto part = std::string_view(line).substr(0, line[end] == ' ' ? end + 1 : end);
                if (const auto space = part.rfind(' '); space != std::string::npos)
                    end = space;
                else if (const auto hyphen = part.rfind('-'); hyphen != std::string::npos)
                    end = hyphen + 1;
            }
            lines.push_back(line.substr(0, end));
            line.erase(0, end + (line[end] == ' ' ? 1 : 0));
            last_break = 0;
        }
    }
    lines.push_back(std::move(line));
}

constexpr float square = 3;  // px

std::uint64_t bit(std::size_t owner) {
    return std::uint64_t{1} << (owner % LabelPlacer::no_owner);
}

/// A box with the names of curves, each beside a sample of the curve.
struct Legend {
    std::vector<std::size_t> which;  // numbers of the curves
    Area box;
    float size;  // of text, px per em
};

/// A position for a box of this size where nothing is drawn, preferably a corner.
std::optional<Point> empty_place(float width, float height, float margin, const LabelPlacer& placer) {
    constexpr int steps = 20;
    const Area& area = placer.area();
    const float across = area.width() - width - 2 * margin, down = area.height() - height - 2 * margin;
    if (across < 0 || down < 0) return {};
    std::optional<Point> best;
    float minimum = 0;
    for (int row = 0; row <= steps; ++row) {
        for (int column = steps; column >= 0; --column) {
            const float left = area.left + margin + across * static_cast<float>(column) / steps;
            const float top = area.top + margin + down * static_cast<float>(row) / steps;
            const Area box{left, top, left + width, top + height};
            if (!placer.is_free(box) || placer.ink(box) > 0) continue;
            const bool side = column == 0 || column == steps, end = row == 0 || row == steps;
            const float cost = side && end ? 0 : side || end ? 6.0f : 15.0f;
            if (!best || cost < minimum) best = Point{left, top}, minimum = cost;
        }
    }
    return best;
}

void draw_sample(const Curve& curve, float left, float right, float y, const Panel& panel) {
    DrawnCurve sample;
    const float middle = (left + right) / 2;
    if (curve.mark != Mark::points) sample.lines.push_back({{left, y}, {right, y}});
    if (curve.mark != Mark::line) sample.points.push_back({middle, y});
    draw_curve(curve, sample, panel);
}

// dimensions of a legend, em
constexpr float row_em = 1.4f, pad_em = 0.5f, sample_em = 1.7f, gap_em = 0.5f;

/// Its width for these curves, or for all, px.
float legend_width(const std::vector<Curve>& curves, const std::vector<std::size_t>* which, float size) {
    float widest = 0;
    for (std::size_t i = 0; i < curves.size(); ++i)
        if (!which || std::ranges::count(*which, i) > 0) widest = std::max(widest, text_width(curves[i].label, size));
    return (2 * pad_em + sample_em + gap_em) * size + widest;
}
/// Its height, em.
float legend_rows(std::size_t count) {
    return 2 * pad_em - 0.35f + row_em * static_cast<float>(count);
}

/// Placed where nothing is drawn, away from all labels, preferably in a corner; nothing if there is no such place.
std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which, float size,
                                    const LabelPlacer& placer) {
    const float width = legend_width(curves, &which, size), height = legend_rows(which.size()) * size;
    const auto at = empty_place(width, height, 0.5f * size, placer);
    if (!at) return {};
    return Legend{std::move(which), {at->x, at->y, at->x + width, at->y + height}, size};
}

/// In the upper left corner of `area`, with text of at most `size` px per em.
Legend legend_in(const Area& area, const std::vector<Curve>& curves, std::vector<std::size_t> which, float maximum) {
    const float width = legend_width(curves, &which, 1), height = legend_rows(which.size());
    const float size = std::min({maximum, area.width() / width, area.height() / height});
    return {std::move(which), {area.left, area.top, area.left + width * size, area.top + height * size}, size};
}

void draw_legend(const Legend& legend, const Panel& panel) {
    const auto& [which, box, size] = legend;
    const Theme& theme = panel.style.theme;
    const bool over_map = panel.is_map();
    const Color background = over_map ? rgb(0x0b0e13).with_alpha(0.7f) : theme.background.with_alpha(0.88f);
    panel.list.push_back(Box{box.left, box.top, box.right, box.bottom, 0.3f * size, background});
    const float left = box.left + pad_em * size, right = left + sample_em * size;
    float baseline = box.top + (pad_em + 0.8f) * size;
    for (const std::size_t i : which) {
        const Curve& curve = panel.plot.curves[i];
        draw_sample(curve, left, right, baseline - 0.3f * size, panel);
        panel.list.push_back(
            label(curve.label, {right + gap_em * size, baseline}, size, over_map ? rgb(0xffffff) : theme.text));
        baseline += row_em * size;
    }
}

/// The label of a curve or rule, not yet placed.
struct LabelText {
    std::string text;
    float size;
    Weight weight;
    Color color;

    Label at(float left, float top) const {
        return {text, {left, top + 0.8f * size}, size, Align::left, weight, color};
    }
    float width() const { return text_width(text, size, weight); }
    float height() const { return 1.05f * size; }
};

struct Found {
    Label label;
    float cost;
};

/// The area that the ink of a line of text may cover, with the tallest accents and deepest descenders of the font.
Area text_area(const Label& label) {
    const float width = text_width(label.text, label.size, label.weight);
    const float before = label.align == Align::left ? 0 : label.align == Align::center ? width / 2 : width;
    const float left = label.anchor.x - before;
    return {left, label.anchor.y - 0.8f * label.size, left + width, label.anchor.y + 0.25f * label.size};
}

/// Draws a label; over a map, on a dark box.
void write(const Label& label, const Panel& panel) {
    const auto [left, top, right, bottom] = text_area(label).grown(0.3f * label.size, 0.1f * label.size);
    if (panel.is_map())
        panel.list.push_back(Box{left, top, right, bottom, 0.25f * label.size, rgb(0x0b0e13).with_alpha(0.62f)});
    panel.list.push_back(label);
}

/// Candidate points of the curve, from its right end on.
std::vector<Point> places(const DrawnCurve& curve) {
    std::vector<Point> all;
    for (const auto& line : curve.lines)
        for (std::size_t i = 0; i < line.size(); ++i) {
            const Point from = line[i == 0 ? 0 : i - 1], to = line[i];
            // long straight pieces have candidates inside
            const int parts = static_cast<int>(std::min(distance(to, from) / 24, 40.0f));
            for (int k = 1; k < parts; ++k) {
                const float part = static_cast<float>(k) / static_cast<float>(parts);
                all.push_back({std::lerp(from.x, to.x, part), std::lerp(from.y, to.y, part)});
            }
            all.push_back(to);
        }
    if (curve.lines.empty()) all = curve.points;
    if (all.empty()) return {};
    // a few of many, evenly spaced, always with both ends
    constexpr std::size_t maximum = 72;
    std::vector<Point> few;
    const std::size_t step = all.size() / maximum + 1;
    for (std::size_t i = 0; i < all.size(); i += step) few.push_back(all[i]);
    few.push_back(all.back());
    std::ranges::stable_sort(few, [](const Point& a, const Point& b) { return a.x > b.x; });
    return few;
}

/// The best position beside the curve that touches nothing.
std::optional<Found> label_beside(const DrawnCurve& curve, std::size_t owner, const LabelText& text, float clear,
                                  const LabelPlacer& placer) {
    std::optional<Found> best;
    const float w = text.width(), h = text.height(), gap = clear + 0.3f * text.size;
    const std::vector<Point> at = places(curve);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Point p = at[i];
        const bool end = i == 0 || i + 1 == at.size();
        const float far_left = (at.front().x - p.x) / std::max(placer.area().width(), 1.0f);
        for (const float across : {1.0f, 0.5f, 0.0f}) {
            for (const float down : {0.5f, 0.0f, 1.0f}) {
                if (across == 0.5f && down == 0.5f) continue;
                // right of the point, centred, left of it; likewise above and below
                const float left = across == 1 ? p.x + gap : across == 0 ? p.x - gap - w : p.x - w / 2;
                const float top = down == 1 ? p.y + gap : down == 0 ? p.y - gap - h : p.y - h / 2;
                const Area box{left, top, left + w, top + h};
                const float margin = 0.28f * text.size;
                float cost = 1.2f * far_left + (down == 0.5f     ? (end && across == 1 ? -0.3f : 0.4f)
                                                : across == 0.5f ? 0.15f
                                                                 : 0);
                if (best && cost >= best->cost) continue;
                if (!placer.is_free(box.grown(margin, 0.5f * margin)) ||
                    placer.ink(box.grown(margin, 0.5f * margin)) > 0)
                    continue;
                // near other curves it is unclear which curve a label belongs to
                if (placer.ink(box.grown(1.0f * text.size, 0.8f * text.size), owner) > 0) cost += 0.7f;
                if (!best || cost < best->cost) best = Found{text.at(left, top), cost};
            }
        }
    }
    return best;
}

/// A position on the curve at which the label hides no other curve.
std::optional<Found> label_on_curve(const DrawnCurve& curve, std::size_t owner, const LabelText& text,
                                    const LabelPlacer& placer) {
    const float w = text.width(), h = text.height(), margin = 0.15f * text.size;
    for (const Point& p : places(curve)) {
        const Area box{p.x - w / 2, p.y - h / 2, p.x + w / 2, p.y + h / 2};
        if (placer.is_free(box.grown(2 * margin, margin)) && placer.ink(box.grown(margin, margin), owner) == 0)
            return Found{text.at(box.left, box.top), 0};
    }
    return {};
}

/// A position above or below a single mark that touches no line, and the leader line to it.
std::optional<Found> with_leader(Point mark, const LabelText& text, const LabelPlacer& placer, Capsule& leader) {
    constexpr int farthest = 12;  // half lines
    const float w = text.width(), h = text.height(), margin = 0.15f * text.size;
    for (int away = 2; away <= farthest; ++away)
        for (const float across : {0.5f, 0.8f, 0.2f, 1.0f, 0.0f})
            for (const float way : {-1.0f, 1.0f}) {
                const float middle = mark.y + 0.5f * way * static_cast<float>(away) * h;
                const Area box{mark.x - across * w, middle - h / 2, mark.x + (1 - across) * w, middle + h / 2};
                if (!placer.is_free(box.grown(2 * margin, 0)) || placer.ink(box.grown(margin, 0)) > 0) continue;
                leader = {mark, {mark.x, way < 0 ? box.bottom : box.top}, 0, text.color};
                return Found{text.at(box.left, box.top), 0};
            }
    return {};
}

LabelText text_for(const Curve& curve, float size, const Panel& panel) {
    const Theme& theme = panel.style.theme;
    if (curve.quiet && !panel.is_map())
        return {curve.label, std::max(0.9f * size, panel.style.least), Weight::regular, theme.quiet_text};
    return {curve.label, size, Weight::bold, curve_color(curve, theme, panel.is_map())};
}

bool is_empty(const DrawnCurve& curve) {
    return curve.lines.empty() && curve.points.empty();
}

/// The labels placed beside or on the curves, and the curves without space for one.
struct PlacedLabels {
    std::vector<Label> labels;
    std::vector<Area> backgrounds;
    std::vector<Capsule> leaders;
    std::vector<std::size_t> left_out;
};

/// Places labels of `size` at all curves except those named elsewhere.
PlacedLabels place_labels(const std::vector<DrawnCurve>& drawn, float size, bool dense,
                          const std::vector<std::size_t>& elsewhere, const Panel& panel, LabelPlacer placer) {
    constexpr std::size_t max_marks = 60;  // beside more marks no label has space
    const auto& curves = panel.plot.curves;
    const PlotStyle& style = panel.style;
    PlacedLabels made;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const Curve& curve = curves[i];
        if (curve.label.empty() || is_empty(drawn[i]) || std::ranges::count(elsewhere, i) > 0) continue;
        const LabelText text = text_for(curve, size, panel);
        const float clear = curve.mark == Mark::line ? style.curve / 2 : style.marker;
        std::optional<Found> found;
        if (curve.mark != Mark::points || drawn[i].points.size() <= max_marks)
            found = label_beside(drawn[i], i, text, clear, placer);
        if (!found && dense && drawn[i].lines.empty() && drawn[i].points.size() == 1) {
            Capsule leader{};
            found = with_leader(drawn[i].points.front(), text, placer, leader);
            leader.radius = style.hairline / 2;
            if (found) made.leaders.push_back(leader);
        }
        if (!found && dense && !drawn[i].lines.empty()) {
            found = label_on_curve(drawn[i], i, text, placer);
            if (found) made.backgrounds.push_back(text_area(found->label).grown(0.15f * text.size, 0.05f * text.size));
        }
        if (!found) {
            made.left_out.push_back(i);
            continue;
        }
        placer.add_text(text_area(found->label).grown(0.3f * text.size, 0.1f * text.size));
        made.labels.push_back(found->label);
    }
    return made;
}

}  // namespace

std::vector<std::string> wrapped(std::string_view text, float size, Weight weight, float width, const Typeface& type) {
    const auto width_of = [&](std::string_view part) { return type.width(part, size, weight); };
    std::vector<std::string> lines;
    while (true) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        wrap_paragraph(text.substr(0, end), width_of, width, lines);
        if (end == text.size()) return lines;
        text.remove_prefix(end + 1);
    }
}

std::vector<std::string> evenly_wrapped(std::string_view text, float size, Weight weight, float width) {
    constexpr float min_share = 1.0f / 3, narrower = 0.97f;
    auto lines = wrapped(text, size, weight, width);
    const auto ends_short = [&](const std::vector<std::string>& all, float measure) {
        return all.size() > 1 && text_width(all.back(), size, weight) < min_share * measure;
    };
    for (float measure = width; ends_short(lines, measure);) {
        measure *= narrower;
        auto tried = wrapped(text, size, weight, measure);
        if (tried.size() > lines.size()) break;
        lines = std::move(tried);
    }
    return lines;
}

float widest(const std::vector<std::string>& lines, float size) {
    float width = 0;
    for (const std::string& line : lines) width = std::max(width, text_width(line, size));
    return width;
}

float widest(const std::vector<Tick>& ticks, float size) {
    std::vector<std::string> texts;
    for (const Tick& tick : ticks) texts.push_back(tick.text);
    return widest(texts, size);
}

void TextBlock::draw(Point at, PageList& list) const {
    float baseline = at.y + 0.98f * size;
    for (const std::string& line : lines) {
        list.push_back(Label{line, {at.x, baseline}, size, Align::left, weight, color});
        baseline += line_height();
    }
}

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

LabelNeeds label_curves(const std::vector<DrawnCurve>& drawn, const LabelNeeds& given, const LabelPlacer& placer,
                        const Panel& panel) {
    constexpr int many = 10;  // so many curves leave little space beside each
    const auto& curves = panel.plot.curves;
    const PlotStyle& style = panel.style;
    PageList& list = panel.list;
    const float small = style.on_paper ? style.text : 0.8f * style.text;  // on paper, the size that is asked for
    bool dense = given.small || std::ranges::count_if(curves, [](const Curve& c) { return !c.label.empty(); }) > many;
    std::vector<std::size_t> others;
    if (given.legend > 0) {  // beside the panel, with all names
        for (std::size_t i = 0; i < curves.size(); ++i)
            if (!curves[i].label.empty() && !is_empty(drawn[i])) others.push_back(i);
        // in the order of the curves' ends, because curves may share a colour
        std::ranges::stable_sort(others, {}, [&](std::size_t i) {
            return drawn[i].lines.empty() ? drawn[i].points.back().y : drawn[i].lines.back().back().y;
        });
        const float right = panel.held.right;
        // down to the end of the axis's texts, unless the label is so long that it is below the legend, too
        const bool is_short = text_width(panel.plot.x.label, style.axis) <= panel.area.width();
        const float bottom = is_short ? panel.held.bottom : panel.area.bottom;
        const Area beside{right - given.legend, panel.area.top, right, bottom};
        if (!others.empty()) draw_legend(legend_in(beside, curves, others, style.text), panel);
        return given;
    }
    const auto tried = [&](float size, const LabelPlacer& left) {
        return place_labels(drawn, size, dense, others, panel, left);
    };
    bool is_small = dense;
    float size = is_small ? small : style.text;
    PlacedLabels made = tried(size, placer);
    // prefers small labels at all curves to a legend, and labels on the curves to a legend that covers them
    if (!dense && !made.left_out.empty()) {
        PlacedLabels fine = tried(small, placer);
        dense = !fine.left_out.empty() &&
                (panel.plot.needs_no_legend || !fitted_legend(curves, made.left_out, size, placer));
        if (dense) fine = tried(small, placer);
        if (dense || fine.left_out.empty()) made = std::move(fine), size = small, is_small = true;
    }
    // the legend is larger and placed first; curves that then have no space beside it join it
    std::optional<Legend> legend;
    while (!made.left_out.empty()) {
        others.insert(others.end(), made.left_out.begin(), made.left_out.end());
        if (!dense) legend = fitted_legend(curves, others, size, placer);
        LabelPlacer left = placer;
        if (legend) left.add_text(legend->box);
        made = tried(size, left);
    }
    if (legend) draw_legend(*legend, panel);
    const Color background = (panel.is_map() ? rgb(0x0b0e13) : style.theme.background).with_alpha(0.88f);
    for (const auto& [left, top, right, bottom] : made.backgrounds)
        list.push_back(Box{left, top, right, bottom, 0.2f * size, background});
    list.insert(list.end(), made.leaders.begin(), made.leaders.end());
    for (const Label& label : made.labels) write(label, panel);
    return {given.small || is_small, others.empty() || legend ? 0 : legend_width(curves, nullptr, style.text)};
}

void label_rules(const Panel& panel, LabelPlacer& placer) {
    const Area& area = panel.area;
    for (const Rule& rule : panel.plot.rules) {
        if (rule.label.empty()) continue;
        const bool level = rule.orientation == Rule::Orientation::horizontal;
        const Axis& axis = level ? panel.axes.y : panel.axes.x;
        if (const double share = axis.share(rule.at); !(share >= 0 && share <= 1)) continue;
        const float size = std::max(0.9f * panel.style.text, panel.style.least), at = axis.at(rule.at),
                    gap = 0.35f * size;
        const Color color = panel.is_map() ? rgb(0xffffff) : panel.style.theme.quiet_text;
        LabelText text{rule.label, size, Weight::regular, color};
        text.size = fitting_size(text.text, size, text.weight, 0.94f * area.width());
        const float w = text.width(), h = text.height();
        std::optional<Found> best;
        for (int place = 0; place <= 10; ++place) {
            for (const int side : {0, 1}) {
                // from the right end, or from the top
                const float along = static_cast<float>(place) / 10;
                const float left = level       ? area.right - gap - w - along * (area.width() - w - 2 * gap)
                                   : side == 0 ? at + gap
                                               : at - gap - w;
                const float top = level ? (side == 0 ? at - gap - h : at + gap)
                                        : area.top + gap + along * (area.height() - h - 2 * gap);
                const Area box{left, top, left + w, top + h};
                if (!placer.is_free(box.grown(0.2f * size, 0))) continue;
                const float cost =
                    0.5f * along + 0.2f * static_cast<float>(side) + 0.3f * static_cast<float>(placer.ink(box));
                if (!best || cost < best->cost) best = Found{text.at(left, top), cost};
            }
        }
        if (!best) continue;
        placer.add_text(text_area(best->label).grown(0.3f * size, 0.1f * size));
        write(best->label, panel);
    }
}

}  // namespace doppel
