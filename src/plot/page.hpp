#pragma once

#include "image/picture.hpp"
#include "plot/axis.hpp"
#include "render/display_list.hpp"
#include "render/typeface.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace doppel {

/// The file format of a page: pixels (png), paths and text, or a figure that tells its numbers (figure/page.hpp).
enum class PictureFormat { png, pdf, svg, html };

/// A picture stretched to `at`, mirrored if its edges are in reverse order. With `within` it is clipped to that area, and
/// cells smaller than pixels are averaged; without, its edges are rounded to whole pixels. Larger cells have sharp edges.
struct Image {
    Area at;                                // px
    std::shared_ptr<const Picture> pixels;  // with alpha
    std::optional<Area> within = {};
};

/// Lines with round joints, dashed if `dash` > 0. If the width is 0, filled polygons.
struct Polylines {
    std::vector<std::vector<Point>> lines;
    float width = 0;  // px
    Color color;
    float dash = 0, gap = 0;          // px
    std::optional<Area> within = {};  // clipped to this area
};

/// One thing to draw: the items of a display list, and those that only charts have. Lists are in order from back to
/// front.
using PageItem = std::variant<Box, Capsule, Ring, Stroke, Label, Image, Polylines>;
using PageList = std::vector<PageItem>;

PageList page_list(const DisplayList& list);

struct Page {
    Size size;        // px
    float scale = 1;  // px per unit of the items
    PageList items;
    Typeface typeface = {};               // fonts of its text
    std::vector<std::string> notes = {};  // what was left out for lack of space
    std::vector<PlotRanges> panels = {};  // the axes of a figure's panels
};

/// Draws the page with Cairo: the same on every machine except for rounding. Throws Error: exit 4 if memory is
/// exhausted, 130 soon after `stop` is set.
Picture picture_of(const Page& page, const std::atomic<bool>& stop = false);

/// The page as a PDF 1.5 or, for any other format, an SVG, `width_pt` (1/72 inch) wide. A PDF contains the glyphs it
/// needs, and its text can be searched; in an SVG letters are paths. Of the metadata, both store title, comment and
/// encoder. Throws Error (exit 4) if memory is exhausted.
std::string page_file(const Page& page, PictureFormat format, double width_pt, const Metadata& metadata);

/// The library for the manifest: "Cairo 1.16.0".
std::string page_library();

/// For a page whose size is given in pixels, as in browsers.
inline constexpr double pt_per_px = 0.75;

}  // namespace doppel
