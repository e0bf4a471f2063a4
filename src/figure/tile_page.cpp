#include "figure/tile_page.hpp"

#include "base/embedded.hpp"
#include "base/text.hpp"
#include "embedded/figure.hpp"
#include "image/color.hpp"
#include "scene/resolved.hpp"

#include <algorithm>

namespace doppel {
namespace {

std::string hexadecimal(Color color) {
    const auto bytes = bytes_of(color);
    return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

Json axis_json(const CellRange& cells, const PlotAxis& axis) {
    return {{"label", axis.label}, {"from", cells.from}, {"to", cells.to}, {"logarithmic", cells.is_logarithmic()}};
}

Json scale_json(const HeatMap& look, const Theme& theme) {
    constexpr int stops = 33;
    Json colors = Json::array();
    for (int i = 0; i < stops; ++i) colors.push_back(hexadecimal(map_color(static_cast<double>(i) / (stops - 1))));
    return {{"label", look.label},
            {"colors", colors},
            {"from", *look.low},
            {"to", *look.high},
            {"logarithmic", look.logarithmic},
            {"none", look.none_label},
            {"none_color", hexadecimal(look.none_is_bad ? theme.bad : theme.none)}};
}

}  // namespace

void write_tile_page(const std::filesystem::path& place, const TilePage& page) {
    const auto files = figure_files();
    const auto file = std::ranges::find(files, "figure/tiles.html", &EmbeddedFile::name);
    if (file == files.end()) throw io_failed("the page of tiles was not built in");
    const Json map{{"folder", in_address(page.folder)},
                   {"tile", Pyramid::tile},
                   {"levels", page.pyramid.levels},
                   {"columns", page.pyramid.columns},
                   {"rows", page.pyramid.rows},
                   {"x", axis_json(page.frame.x, page.frame.x_axis)},
                   {"y", axis_json(page.frame.y, page.frame.y_axis)},
                   {"scale", scale_json(page.look, page.theme)}};
    const auto data = in_script(map.dump(-1, ' ', false, Json::error_handler_t::replace));
    OutputFile output(place);
    std::string_view rest = file->contents;
    while (!rest.empty()) {
        const auto [name, value] = [&]() -> std::pair<std::string_view, std::string> {
            for (const auto& [key, text] :
                 {std::pair("{title}", markup(page.title)), {"{subtitle}", markup(page.subtitle)}, {"{map}", data}})
                if (rest.starts_with(key)) return {key, text};
            return {};
        }();
        output.write(name.empty() ? rest.substr(0, 1) : std::string_view(value));
        rest.remove_prefix(std::max<std::size_t>(1, name.size()));
        const auto next = std::min(rest.find('{'), rest.size());
        output.write(rest.substr(0, next));
        rest.remove_prefix(next);
    }
    output.close();
}

}  // namespace doppel
