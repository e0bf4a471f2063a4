#include "base/text.hpp"
#include "output/png.hpp"
#include "vector/page.hpp"
#include "vector/paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace doppel {
namespace {

/// "12.5", "6400.25".
std::string number(double value) {
    return fmt::format("{:.6g}", value);
}

std::string pair(Point p) {
    return fmt::format("{} {}", number(p.x), number(p.y));
}

/// fill="#ff0000" fill-opacity="0.5"
std::string paint(std::string_view what, const Color& color) {
    const auto bytes = bytes_of(color);
    auto text = fmt::format("{}=\"#{:02x}{:02x}{:02x}\"", what, bytes[0], bytes[1], bytes[2]);
    if (color.a < 1) text += fmt::format(" {}-opacity=\"{:.3g}\"", what, color.a);
    return text;
}

/// Writes items of a page, one a line.
class Writer {
public:
    explicit Writer(std::string& file) : file_(file) {}

    void operator()(const Path& path) const {
        std::string steps;
        for (const auto& step : path.steps) {
            switch (step.kind) {
                case Path::Step::Kind::move:
                    steps += "M" + pair(step.to);
                    break;
                case Path::Step::Kind::line:
                    steps += "L" + pair(step.to);
                    break;
                case Path::Step::Kind::curve:
                    steps += fmt::format("C{} {} {}", pair(step.leave), pair(step.arrive), pair(step.to));
                    break;
                case Path::Step::Kind::close:
                    steps += "Z";
            }
        }
        if (path.pen == 0)
            line(R"(<path d="{}" {}/>)", steps, paint("fill", path.color));
        else
            line(R"(<path d="{}" fill="none" {} stroke-width="{}"{}/>)", steps, paint("stroke", path.color),
                 number(path.pen), path.has_round_ends ? "" : R"( stroke-linecap="butt")");
    }

    void operator()(const Label& label) const {
        constexpr std::string_view anchors[] = {"start", "middle", "end"};
        line(R"(<text x="{}" y="{}" font-size="{}" text-anchor="{}" {}{}>{}</text>)", number(label.anchor.x),
             number(std::round(label.anchor.y)), number(label.size), anchors[static_cast<std::size_t>(label.align)],
             paint("fill", label.color), label.weight == Weight::bold ? R"( font-weight="bold")" : "",
             markup(label.text));
    }

    void operator()(const Image& image) const {
        line(R"(<image x="{}" y="{}" width="{}" height="{}" preserveAspectRatio="none" href="{}"/>)",
             number(image.left), number(image.top), number(image.right - image.left), number(image.bottom - image.top),
             data_url(*image.pixels, {.with_alpha = !image.pixels->is_opaque()}));
    }

private:
    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) const {
        fmt::format_to(std::back_inserter(file_), format, std::forward<Args>(args)...);
        file_ += '\n';
    }

    std::string& file_;
};

}  // namespace

std::string svg_page(const DisplayList& list, const Page& page) {
    const auto [width, height] = page.size;
    std::string faces;
    const auto embed = [&](std::string_view name, const Font& font, std::string_view weight = "normal") {
        faces += fmt::format("@font-face {{ font-family: \"{}\"; font-weight: {}; src: url({}) }}\n", name, weight,
                             data_url("font/ttf", font.bytes()));
    };
    if (const auto* own = page.typeface.own()) embed("Own", *own);
    embed("Doppel", Font::built_in());
    if (std::ranges::any_of(list, [](const Item& item) {
            const auto* label = std::get_if<Label>(&item);
            return label && label->weight == Weight::bold;
        }))
        embed("Doppel", Font::built_in(Weight::bold), "bold");
    auto file = fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- {} -->
<svg xmlns="http://www.w3.org/2000/svg" width="{}pt" height="{}pt" viewBox="0 0 {} {}">
<title>{}</title>
<desc>{}</desc>
<style>
{}text {{ font-family: Own, Doppel, "DejaVu Sans", sans-serif; font-kerning: none; white-space: pre }}
image {{ image-rendering: pixelated }}
</style>
<g stroke-linecap="round" stroke-linejoin="round">
)",
        maker_of(page.metadata), number(page.width_pt), number(page.width_pt * height / width), width, height,
        markup(text_of(page.metadata, "title")), markup(text_of(page.metadata, "comment")), faces);
    const Writer writer(file);
    for (const auto& item : page_items(list)) std::visit(writer, item);
    return file + "</g>\n</svg>\n";
}

std::string text_of(const Metadata& metadata, std::string_view key) {
    const auto found =
        std::ranges::find(metadata, key, [](const auto& entry) -> std::string_view { return entry.first; });
    return found == metadata.end() ? "" : found->second;
}

std::string maker_of(const Metadata& metadata) {
    const auto maker = text_of(metadata, "encoder");
    return maker.starts_with("Doppel") ? maker : "Doppel";
}

void write_page(const std::filesystem::path& place, const DisplayList& list, const Page& page, PictureFormat format) {
    OutputFile file(place);
    file.write(format == PictureFormat::pdf ? pdf_page(list, page) : svg_page(list, page));
    file.close();
}

}  // namespace doppel
