#pragma once

#include "output/files.hpp"
#include "output/sink.hpp"
#include "render/display_list.hpp"
#include "render/typeface.hpp"

#include <string>
#include <string_view>

namespace doppel {

/// What a picture is written as: pixels, or paths and text.
enum class PictureFormat { png, pdf, svg };

/// A sheet that a display list fills.
struct Page {
    Size size;            // of the list, px
    double width_pt = 0;  // on paper, 1/72 inch; its height follows
    Metadata metadata = {};
    Typeface typeface = {};  // of its text
};

/// One page as a file: paths as paths, images pixel by pixel as they are, text as text, glows as rings. PDF 1.5 holds
/// those letters of the fonts that it needs; SVG 1.1 all of the built-in font and of the user's, none of the system's.
/// Throws Error (exit 4) where there is no memory.
std::string pdf_page(const DisplayList& list, const Page& page);
std::string svg_page(const DisplayList& list, const Page& page);

/// The same as a file; `format` is not png.
void write_page(const std::filesystem::path& place, const DisplayList& list, const Page& page, PictureFormat format);

/// The metadata's text of that key; empty where there is none.
std::string text_of(const Metadata& metadata, std::string_view key);
/// The program that makes a page, by which it is known for Doppel's: "Doppel" and more.
std::string maker_of(const Metadata& metadata);

/// Of a page whose size is in pixels alone, as browsers have it.
inline constexpr double pt_per_px = 0.75;

}  // namespace doppel
