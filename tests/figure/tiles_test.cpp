#include "figure/page.hpp"
#include "figure/support.hpp"
#include "image/color.hpp"
#include "output/packed.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

namespace doppel::tiles_test {

namespace fs = std::filesystem;
using test::expect_error;
using test::fresh_folder;

const std::string flips =
    "title = \"<b> & more</script>\"\n[scene]\nkind = \"grid\"\nduration_s = 0.6\n[grid]\nquantity = \"flip_time\"\n"
    "[grid.x]\nfrom = -180\n[grid.y]\nkey = \"theta2_deg\"\nfrom = -180\n";

FigurePreset small(int columns = 600, int rows = 300) {
    return figure_from(flips, {fmt::format("grid.x.points={}", columns), fmt::format("grid.y.points={}", rows)});
}

RunResult make(const fs::path& out, const FigurePreset& figure, FigureOptions options = {}) {
    options.out = out;
    options.tiles = true;
    return run_figure(figure, options);
}

std::map<std::string, std::string> tiles_in(const fs::path& out) {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(out / "x/x.tiles"))
        all[entry.path().filename()] = test::bytes_of(entry.path());
    return all;
}

TEST(Tiles, DoNotReplaceThePageOfAFigure) {
    const auto out = fresh_folder();
    const auto html = figure_from(flips, {"grid.x.points=8", "grid.y.points=8", "chart.format=\"html\""});
    FigureOptions options{.out = out};
    run_figure(html, options);
    expect_error(ExitCode::io_failed, {"x.html was made by a figure, and this is a map of tiles", "--force"},
                 [&] { make(out, small(8, 8)); });
    make(out, small(8, 8), {.replacing = {.force = true}});
    make(out, small(8, 8));
    expect_error(ExitCode::io_failed, {"x.html was made by a map of tiles, and this is a figure"},
                 [&] { run_figure(html, options); });
}

TEST(Tiles, AreTheCellsOfTheMap) {
    const auto out = fresh_folder();
    const auto figure = small();
    EXPECT_EQ(make(out, figure).samples, 600 * 300);
    std::vector<std::string> names;
    for (const auto& [name, bytes] : tiles_in(out)) names.push_back(name);
    EXPECT_EQ(names, (std::vector<std::string>{"0-0-0.png", "1-0-0.png", "1-0-1.png", "2-0-0.png", "2-0-1.png",
                                               "2-0-2.png", "2-1-0.png", "2-1-1.png", "2-1-2.png"}));
    const auto page = page_of(figure);
    const auto& map = *page.panels.at(0).map;
    // colours depend on the number alone, and differ more the more the numbers differ
    std::map<std::vector<std::uint8_t>, std::pair<double, double>> ranges;  // times by colour
    for (const int row : {0, 255, 256, 299})
        for (int column = 0; column < 600; column += 7) {
            const auto picture = read_png(out / "x/x.tiles" / fmt::format("2-{}-{}.png", row / 256, column / 256));
            const auto* pixel = picture.at(column % 256, row % 256);
            EXPECT_EQ(pixel[3], 255);
            const double time = map.values[static_cast<std::size_t>((299 - row) * 600 + column)];
            auto& [low, high] = ranges.try_emplace(std::vector(pixel, pixel + 3), time, time).first->second;
            low = std::min(low, time);
            high = std::max(high, time);
        }
    EXPECT_GT(ranges.size(), 25u);
    for (const double end : {0.0, 1.0}) {  // outside the scale
        const auto color = bytes_of(map_color(end));
        ranges.erase(std::vector(color.begin(), color.begin() + 3));
    }
    for (const auto& [color, range] : ranges)
        EXPECT_TRUE(range.first == range.second || range.second < 1.05 * range.first || std::isnan(range.first))
            << range.first << ' ' << range.second;
    // outside the map there are no pixels
    const auto last = read_png(out / "x/x.tiles/2-1-2.png");
    EXPECT_EQ(last.at(600 - 512, 0)[3], 0);
    EXPECT_EQ(last.at(0, 300 - 256)[3], 0);
}

/// The pictures equal those drawn from the same files of numbers.
TEST(Tiles, AreTheSameInPartsAndFromMoreThreads) {
    const auto out = fresh_folder(), parts = out / "parts";
    make(out, small(), {.jobs = 1});
    for (const int number : {2, 3, 1}) make(parts, small(), {.jobs = number, .shard = Shard{number, 3}});
    make(parts, small(), {.jobs = 3, .merge = true});
    EXPECT_EQ(tiles_in(parts), tiles_in(out));
    run_figure(small(), {.out = parts, .merge = true});
    EXPECT_TRUE(fs::exists(parts / "x/x.csv"));
    EXPECT_TRUE(fs::exists(parts / "x/x.html"));
}

TEST(Tiles, OfAMirroredMapAreImagesOfEachOther) {
    const auto out = fresh_folder();
    const auto square = small(512, 512);
    EXPECT_EQ(make(out, square).samples, 512 * 512);
    const auto one = read_png(out / "x/x.tiles/1-0-0.png"), other = read_png(out / "x/x.tiles/1-1-1.png");
    for (int y = 0; y < 256; y += 5)
        for (int x = 0; x < 256; x += 5)
            EXPECT_TRUE(std::equal(one.at(x, y), one.at(x, y) + 4, other.at(255 - x, 255 - y)));
}

TEST(Tiles, ReplaceTheirOwnAndLeaveOtherFilesAlone) {
    const auto out = fresh_folder(), folder = out / "x/x.tiles";
    make(out, small());
    make(out, small(300, 200));
    EXPECT_EQ(tiles_in(out).size(), 2u + 1);
    test::write_bytes(folder / "diary.txt", "mine");
    expect_error(ExitCode::io_failed, {"diary.txt"}, [&] { make(out, small()); });
    EXPECT_EQ(test::bytes_of(folder / "diary.txt"), "mine");
    // nor through a symbolic link
    fs::remove_all(folder);
    fs::create_directories(out / "elsewhere");
    fs::create_directory_symlink(out / "elsewhere", folder);
    expect_error(ExitCode::io_failed, {"x.tiles"}, [&] { make(out, small()); });
    EXPECT_TRUE(fs::is_empty(out / "elsewhere"));
}

TEST(Tiles, AreOfMapsThatHaveNumbers) {
    const auto out = fresh_folder();
    expect_error(ExitCode::bad_input, {"--tiles are of one map"},
                 [&] { make(out, figure_of("fig2-right", small_chart)); });
    const auto still = figure_from(flips, {"scene.duration_s=\"1/120\"", "grid.x.points=300", "grid.y.points=260"});
    expect_error(ExitCode::method_failed, {"none of the 300 × 260 pairs has a flip_time"}, [&] { make(out, still); });
    EXPECT_FALSE(fs::exists(out / "x/x.html"));
}

TEST(Map, OfMoreCellsThanMemoryHoldsIsRefusedBeforeItStarts) {
    const auto out = fresh_folder() / "out";
    constexpr int all = 1'048'576;
    expect_error(ExitCode::bad_input, {"x: 1 048 576 × 1 048 576 cells take 17.6 TB of memory"},
                 [&] { run_figure(small(all, all), {.out = out}); });
    EXPECT_FALSE(fs::exists(out));
}

TEST(TilePage, AsksNothingOfTheNetwork) {
    const auto out = fresh_folder();
    make(out, small());
    const auto page = test::bytes_of(out / "x/x.html"), data = test::data_of(page).dump();
    EXPECT_LT(page.size(), 100'000u);
    EXPECT_NE(page.find("no flip within 0.6 s"), std::string::npos);
    for (const char* scheme : {"http:", "https:"}) EXPECT_EQ((page + data).find(scheme), std::string::npos) << scheme;
}

TEST(TilePage, TakesAnyNames) {
    const std::string label = "<!--<script></script>{title}$&$`\n\u2028'\"\\, m";
    auto figure = small(2, 2);
    figure.title = figure.subtitle = "</title><!--<script>{map}{subtitle}$(x)'\"\n`${1}`\\";
    Figure drawn{
        .panels = {Plot{.x = {.label = label, .low = 0, .high = 1}, .y = {.label = "y", .low = 0, .high = 1}}}};
    drawn.panels[0].map = HeatMap{.columns = 2, .rows = 2, .values = {0, 0, 1, 1}, .low = 0, .high = 1};
    const auto out = fresh_folder();
    // the address of a#b is not "a", and a%41 is not aA
    for (const auto& [name, address] : {std::pair("a#b?c", "a%23b%3Fc.tiles"),
                                        {"a%41", "a%2541.tiles"},
                                        {"x:y\\'\"\n<", "x%3Ay%5C%27%22%0A%3C.tiles"},
                                        {"θ\xff", "%CE%B8%FF.tiles"}}) {
        figure.name = name;
        Transaction files(out);
        write_tiles(figure, drawn, files, 1, never_stopped);
        const auto page = test::bytes_of(files.folder() / ".doppel-run" / (figure.name + ".html"));
        const auto map = test::data_of(page);
        EXPECT_EQ(map["folder"], address);
        EXPECT_EQ(map["x"]["label"], label);
        EXPECT_EQ(map["columns"], 2);
        // its data and three scripts, one title, one comment
        for (const auto& [tag, times] : {std::pair("<script", 4), {"</script", 4}, {"</title", 1}, {"<!--", 1}}) {
            int found = 0;
            for (auto at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) ++found;
            EXPECT_EQ(found, times) << tag;
        }
    }
}

}  // namespace doppel::tiles_test
