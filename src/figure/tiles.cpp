#include "figure/tiles.hpp"

#include "base/embedded.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "embedded/figure.hpp"
#include "output/png.hpp"

#include <algorithm>

namespace doppel {
namespace {

/// Draws the tiles of a map, each once, and writes them.
class TileWriter {
public:
    TileWriter(const HeatMap& map, const Theme& theme, std::filesystem::path folder, const std::atomic<bool>& stop)
        : map_(map),
          theme_(theme),
          pyramid_(static_cast<int>(map.columns), static_cast<int>(map.rows)),
          folder_(std::move(folder)),
          stop_(stop),
          look_(look_of(map)) {}

    const Pyramid& pyramid() const { return pyramid_; }
    /// The map without its numbers, and with both ends of its scale.
    const HeatMap& look() const { return look_; }

    void write_all(int jobs) {
        // threads take the tiles of a level with some; one thread the coarser ones
        constexpr int shared = 3;
        const int level = std::min(pyramid_.levels, shared), across = pyramid_.across(level);
        std::vector<Picture> drawn(static_cast<std::size_t>(across) * static_cast<std::size_t>(pyramid_.down(level)));
        parallel_for(drawn.size(), jobs, [&](std::size_t i) {
            drawn[i] = written(level, static_cast<int>(i) / across, static_cast<int>(i) % across);
        });
        drawn_level_ = level;
        drawn_ = std::move(drawn);
        if (level > 0) written(0, 0, 0);
    }

private:
    static HeatMap look_of(const HeatMap& map) {
        auto look = map;
        look.values.clear();
        const auto [low, high] = color_range(map);
        look.low = low;
        look.high = high;
        return look;
    }

    /// A tile, and all that it is made of.
    Picture written(int level, int row, int column) const {
        constexpr int tile = Pyramid::tile;
        if (level == drawn_level_) return drawn_[static_cast<std::size_t>(row * pyramid_.across(level) + column)];
        throw_if_set(stop_);
        Picture picture({tile, tile});
        if (level == pyramid_.levels) {
            paste(cells(row, column), 0, 0, picture);
        } else {
            Picture four({2 * tile, 2 * tile});
            for (int r = 2 * row; r < std::min(2 * row + 2, pyramid_.down(level + 1)); ++r)
                for (int c = 2 * column; c < std::min(2 * column + 2, pyramid_.across(level + 1)); ++c)
                    paste(written(level + 1, r, c), c % 2 * tile, r % 2 * tile, four);
            picture = downscaled(four, {tile, tile});
        }
        write_png(folder_ / Pyramid::name(level, row, column), picture, {.with_alpha = !picture.is_opaque()}, stop_);
        return picture;
    }

    Picture cells(int tile_row, int tile_column) const {
        constexpr std::size_t tile = Pyramid::tile;
        const auto left = static_cast<std::size_t>(tile_column) * tile, top = static_cast<std::size_t>(tile_row) * tile;
        auto part = look_;
        part.columns = std::min(tile, map_.columns - left);
        part.rows = std::min(tile, map_.rows - top);
        for (auto row = map_.rows - top - part.rows; row < map_.rows - top; ++row) {  // from the bottom up
            const auto first = map_.values.begin() + static_cast<std::ptrdiff_t>(row * map_.columns + left);
            part.values.insert(part.values.end(), first, first + static_cast<std::ptrdiff_t>(part.columns));
        }
        return cell_picture(part, theme_);
    }

    static void paste(const Picture& from, int left, int top, Picture& into) {
        for (int y = 0; y < from.size.height; ++y)
            std::copy_n(from.at(0, y), 4 * static_cast<std::size_t>(from.size.width), into.at(left, top + y));
    }

    const HeatMap& map_;
    const Theme& theme_;
    Pyramid pyramid_;
    std::filesystem::path folder_;
    const std::atomic<bool>& stop_;
    HeatMap look_;
    int drawn_level_ = -1;
    std::vector<Picture> drawn_;  // the tiles of that level
};

std::string hexadecimal(Color color) {
    const auto bytes = bytes_of(color);
    return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

Json axis_json(const PlotAxis& axis) {
    return {{"label", axis.label}, {"from", *axis.low}, {"to", *axis.high}, {"logarithmic", axis.logarithmic}};
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

/// The page, in which {title}, {subtitle} and {map} stand for what it shows.
std::string page_text(const FigurePreset& figure, const Json& map) {
    const auto files = figure_files();
    const auto file = std::ranges::find(files, "figure/tiles.html", &EmbeddedFile::name);
    if (file == files.end()) throw io_failed("the page of tiles was not built in");
    const std::array<std::pair<std::string_view, std::string>, 3> values{
        {{"{title}", markup(figure.title)},
         {"{subtitle}", markup(figure.subtitle)},
         {"{map}", in_script(map.dump(-1, ' ', false, Json::error_handler_t::replace))}}};
    std::string text;
    for (std::string_view rest = file->contents; !rest.empty();) {
        const auto value = std::find_if(values.begin(), values.end(),
                                        [&](const auto& entry) { return rest.starts_with(entry.first); });
        const auto taken = value == values.end() ? std::min(rest.find('{', 1), rest.size()) : value->first.size();
        text += value == values.end() ? rest.substr(0, taken) : std::string_view(value->second);
        rest.remove_prefix(taken);
    }
    return text;
}

}  // namespace

Pyramid::Pyramid(int across_cells, int down_cells) : columns(across_cells), rows(down_cells), levels(0) {
    while ((static_cast<long>(tile) << levels) < std::max(columns, rows)) ++levels;
}

int Pyramid::tiles(int cells, int level) const {
    const long side = static_cast<long>(tile) << (levels - level);
    return static_cast<int>((cells + side - 1) / side);
}

std::string Pyramid::name(int level, int row, int column) {
    return fmt::format("{}-{}-{}.png", level, row, column);
}

void demand_map(const FigurePreset& figure) {
    const auto map = figure.experiment->map();
    if (!map || map->panels > 1)
        throw bad_input("{}: --tiles are of one map, kind = \"grid\" with [grid.x] and [grid.y] alone", figure.name);
}

Json write_tiles(const FigurePreset& figure, const Figure& page, const Theme& theme, Transaction& files, int jobs,
                 const std::atomic<bool>& stop) {
    demand_map(figure);
    const auto& plot = page.panels.front();
    const auto folder = figure.name + ".tiles", html = figure.name + ".html";
    TileWriter tiles(*plot.map, theme, files.directory(folder), stop);
    tiles.write_all(jobs);
    files.finished(folder);
    const auto& pyramid = tiles.pyramid();
    write_file(files.file(html), page_text(figure, {{"folder", in_address(folder)},
                                                    {"tile", Pyramid::tile},
                                                    {"levels", pyramid.levels},
                                                    {"columns", pyramid.columns},
                                                    {"rows", pyramid.rows},
                                                    {"x", axis_json(plot.x)},
                                                    {"y", axis_json(plot.y)},
                                                    {"scale", scale_json(tiles.look(), theme)}}));
    files.finished(html);
    return {{"folder", folder},
            {"size_px", Pyramid::tile},
            {"levels", pyramid.levels + 1},
            {"cells", {pyramid.columns, pyramid.rows}}};
}

}  // namespace doppel
