#include "plot/text.hpp"

#include "render/font.hpp"

#include <algorithm>

namespace doppel {
namespace {

/// The first bytes of `text` that make whole characters of at most `width` px, at least one character.
std::size_t bytes_within(std::string_view text, float size, Weight weight, float width) {
    std::size_t taken = 0;
    while (taken < text.size()) {
        std::size_t next = taken + 1;
        while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xc0u) == 0x80) ++next;
        if (taken > 0 && text_width(text.substr(0, next), size, weight) > width) break;
        taken = next;
    }
    return taken;
}

void wrap_paragraph(std::string_view text, float size, Weight weight, float width, std::vector<std::string>& lines) {
    std::string line;
    const auto add = [&](std::string_view word) {
        const std::string longer = line.empty() ? std::string(word) : line + ' ' + std::string(word);
        if (line.empty() || text_width(longer, size, weight) <= width) {
            line = longer;
        } else {
            lines.push_back(std::move(line));
            line = word;
        }
        // what alone is too wide
        while (text_width(line, size, weight) > width) {
            const std::size_t part = bytes_within(line, size, weight, width);
            if (part == line.size()) break;
            lines.push_back(line.substr(0, part));
            line.erase(0, part);
        }
    };
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        if (end > 0) add(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
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

void TextBlock::draw(Point at, DisplayList& list) const {
    float baseline = at.y + 0.98f * size;
    for (const std::string& line : lines) {
        list.push_back(Label{line, {at.x, baseline}, size, Align::left, weight, color});
        baseline += line_height();
    }
}

TextBlock fitted_block(std::string_view text, float size, Weight weight, Color color, float width) {
    if (text.empty()) return {{}, size, weight, color};
    const float shrunk =
        std::max(fitting_size(text, size, weight, width), std::max(0.75f * size, std::min(size, 9.0f)));
    return {wrapped(text, shrunk, weight, width), shrunk, weight, color};
}

}  // namespace doppel
