#include "base/text.hpp"

#include "plot/labels.hpp"
#include "render/typeface.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The number of bytes of `text` whose whole characters are at most `width` px wide; at least one character.
std::size_t bytes_within(std::string_view text, float size, Weight weight, float width) {
    std::size_t taken = 0;
    for (std::string_view rest = text; !rest.empty();) {
        next_character(rest);
        const std::size_t next = text.size() - rest.size();
        if (taken > 0 && text_width(text.substr(0, next), size, weight) > width) break;
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

/// The parts of `text` between which a line may break.
std::vector<std::string> words_of(std::string_view text, float size, Weight weight, float width) {
    std::vector<std::string> words;
    std::string_view before;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        if (const auto word = text.substr(0, end); !word.empty()) {
            const auto joined = words.empty() ? "" : words.back() + ' ' + std::string(word);
            if (!joined.empty() && stay_together(before, word) && text_width(joined, size, weight) <= width)
                words.back() = joined;
            else
                words.emplace_back(word);
            before = word;
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

void wrap_paragraph(std::string_view text, float size, Weight weight, float width, std::vector<std::string>& lines) {
    std::string line;
    const auto add = [&](const std::string& word) {
        const std::string longer = line.empty() ? word : line + ' ' + word;
        if (line.empty() || text_width(longer, size, weight) <= width) {
            line = longer;
        } else {
            lines.push_back(std::move(line));
            line = word;
        }
        // wider than a line by itself
        while (text_width(line, size, weight) > width) {
            const std::size_t part = bytes_within(line, size, weight, width);
            if (part == line.size()) break;
            lines.push_back(line.substr(0, part));
            line.erase(0, part);
        }
    };
    for (const auto& word : words_of(text, size, weight, width)) add(word);
    lines.push_back(std::move(line));
}

}  // namespace

Area text_area(const Label& label) {
    const float width = text_width(label.text, label.size, label.weight);
    const float before = label.align == Align::left ? 0 : label.align == Align::center ? width / 2 : width;
    const float left = label.anchor.x - before;
    return {left, label.anchor.y - 0.8f * label.size, left + width, label.anchor.y + 0.25f * label.size};
}

std::vector<std::string> wrapped(std::string_view text, float size, Weight weight, float width) {
    std::vector<std::string> lines;
    while (true) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        wrap_paragraph(text.substr(0, end), size, weight, width, lines);
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

}  // namespace doppel
