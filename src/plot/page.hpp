#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"
#include "render/typeface.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace doppel {

/// What a page is written as: pixels, or paths and text.
enum class PictureFormat { png, pdf, svg };

/// A picture stretched over a rectangle, whose edges are rounded to whole pixels; nearest neighbour.
struct Image {
    float left = 0, top = 0, right = 0, bottom = 0;  // px
    std::shared_ptr<const Picture> pixels;           // with opacity
};

/// Lines drawn with a pen of round joints, dashed where `dash` > 0; or, where the width is 0, polygons that are filled.
struct Polylines {
    std::vector<std::vector<Point>> lines;
    float width = 0;  // px
    Color color;
    float dash = 0, gap = 0;          // px
    std::optional<Area> within = {};  // what lies outside is cut off
};

/// A picture stretched over `at`, whose ends may be in reverse, cut off at `within`; its pixels are squares where they are
/// as large as the page's, else averaged.
struct CellImage {
    Area at, within;  // px
    std::shared_ptr<const Picture> pixels;
};

/// What to draw, back to front: what a display list may hold, and what only charts have.
using PageItem = std::variant<Box, Capsule, Ring, Stroke, Label, Image, Polylines, CellImage>;
using PageList = std::vector<PageItem>;

PageList page_list(const DisplayList& list);

/// A sheet and what is on it.
struct Page {
    Size size;        // px
    float scale = 1;  // px to a unit of the items
    PageList items;
    Typeface typeface = {};               // of its text
    std::vector<std::string> notes = {};  // what there was no room for
};

/// The page in pixels, by Cairo: the same on every machine to within its rounding. Throws Error: exit 4 where there is no
/// memory, 130 soon after `stop` is set.
Picture picture_of(const Page& page, const std::atomic<bool>& stop = false);

/// The page as a PDF 1.5 or an SVG, `width_pt` (1/72 inch) wide: paths as paths, images pixel by pixel as they are, glows as
/// rings. The PDF holds those letters of the fonts that it needs, and its text can be searched; in an SVG letters are paths. Of
/// the metadata both hold title, comment and encoder. Throws Error (exit 4) where there is no memory.
std::string page_file(const Page& page, PictureFormat format, double width_pt, const Metadata& metadata);

/// What draws, for the manifest: "Cairo 1.16.0".
std::string page_library();

/// Of a page whose size is in pixels alone, as browsers have it.
inline constexpr double pt_per_px = 0.75;

}  // namespace doppel
