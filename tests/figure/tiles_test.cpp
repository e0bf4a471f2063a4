#include "figure/tiles.hpp"

#include "figure/map_figure.hpp"
#include "figure/support.hpp"
#include "figure/tile_page.hpp"
#include "image/color.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>

namespace doppel {
namespace tiles_test {

namespace fs = std::filesystem;

const std::string flips =
    "title = \"<b> & more</script>\"\n[scene]\nkind = \"grid\"\nduration_s = 0.6\n[grid]\nquantity = \"flip_time\"\n"
    "[grid.x]\nfrom = -180\n[grid.y]\nkey = \"theta2_deg\"\nfrom = -180\n";

FigurePreset small(int columns = 600, int rows = 300) {
    return figure_from(flips, {fmt::format("grid.x.points={}", columns), fmt::format("grid.y.points={}", rows)});
}

struct TileRun {
    fs::path out =
        fs::path(DOPPEL_TEST_OUTPUT) / "tiles" / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::vector<std::string> notes;

    TileRun() { fs::remove_all(out); }
    fs::path tiles() const { return out / "x" / "x.tiles"; }

    RunResult operator()(const FigurePreset& figure, const FigureOptions& options = {},
                         const std::atomic<bool>& stop = false) {
        auto placed = options;
        placed.out = out;
        placed.tiles = true;
        if (placed.jobs == 0) placed.jobs = 2;
        RunResult result;
        run_figures({figure}, placed, stop,
                    {[](std::size_t, const FigureProgress&) {},
                     [&](std::size_t, const std::string& note) { notes.push_back(note); },
                     [&](std::size_t, const RunResult& done) { result = done; }});
        return result;
    }
    std::map<std::string, std::string> contents() const {
        std::map<std::string, std::string> all;
        for (const auto& entry : fs::directory_iterator(tiles()))
            all[entry.path().filename()] = test::bytes_of(entry.path());
        return all;
    }
};

TEST(Pyramid, HasOneTileAtTheTopAndAPixelACellBelow) {
    const Pyramid pyramid(600, 300);
    EXPECT_EQ(pyramid.levels, 2);
    EXPECT_EQ(pyramid.across(2), 3);
    EXPECT_EQ(pyramid.down(2), 2);
    EXPECT_EQ(pyramid.across(1), 2);
    EXPECT_EQ(pyramid.down(1), 1);
    EXPECT_EQ(pyramid.across(0), 1);
    EXPECT_EQ(Pyramid(256, 2).levels, 0);
    EXPECT_EQ(Pyramid(32768, 32768).levels, 7);
}

TEST(Tiles, AreTheCellsOfTheMap) {
    TileRun run;
    const auto figure = small();
    run(figure);
    auto names = run.contents();
    EXPECT_EQ(names.size(), 6u + 2 + 1 + 1);  // and pyramid.json
    // colours only depend on the number, and grow apart with it
    const auto& map = *figure.experiment->map();
    std::map<std::vector<std::uint8_t>, std::pair<double, double>> ranges;  // of times, by colour
    for (const int row : {0, 255, 256, 299})
        for (int column = 0; column < 600; column += 7) {
            std::vector<TrialNumbers> cell(1);
            map.find(299 - row, column, cell, false);
            const auto picture = read_png(run.tiles() / Pyramid::name(2, row / 256, column / 256));
            const auto* pixel = picture.at(column % 256, row % 256);
            EXPECT_EQ(pixel[3], 255);
            const double time = cell[0][0];
            auto& [low, high] = ranges.try_emplace(std::vector(pixel, pixel + 3), time, time).first->second;
            low = std::min(low, time);
            high = std::max(high, time);
        }
    EXPECT_GT(ranges.size(), 25u);
    for (const double end : {0.0, 1.0}) {  // beyond the scale
        const auto color = bytes_of(map_color(end));
        ranges.erase(std::vector(color.begin(), color.begin() + 3));
    }
    for (const auto& [color, range] : ranges)
        EXPECT_TRUE(range.first == range.second || range.second < 1.05 * range.first)
            << range.first << ' ' << range.second;
    // beyond the map there is nothing
    const auto last = read_png(run.tiles() / Pyramid::name(2, 1, 2));
    EXPECT_EQ(last.at(600 - 512, 0)[3], 0);
    EXPECT_EQ(last.at(0, 300 - 256)[3], 0);
}

TEST(Tiles, AreTheSameInPartsAndFromMoreThreads) {
    TileRun whole;
    whole(small());
    const auto expected = whole.contents();
    TileRun parts;
    parts.out += "-parts";
    fs::remove_all(parts.out);
    for (const int number : {2, 3, 1}) parts(small(), {.jobs = number, .shard = Shard{number, 3}});
    EXPECT_EQ(parts.contents().size(), 6u + 1);
    parts(small(), {.merge = true});
    EXPECT_EQ(parts.contents(), expected);
}

TEST(Tiles, OfAMirroredMapAreComputedOnce) {
    TileRun mirrored;
    const auto square = small(512, 512);
    ASSERT_TRUE(square.experiment->map()->frame().is_mirrored);
    const auto result = mirrored(square);
    EXPECT_EQ(result.samples, 512 * 512);
    const auto one = read_png(mirrored.tiles() / "1-0-0.png"), other = read_png(mirrored.tiles() / "1-1-1.png");
    for (int y = 0; y < 256; y += 5)
        for (int x = 0; x < 256; x += 5)
            EXPECT_TRUE(std::equal(one.at(x, y), one.at(x, y) + 4, other.at(255 - x, 255 - y)));
    // as each of the two is by itself
    std::vector<TrialNumbers> cell(1), image(1);
    square.experiment->map()->find(40, 300, cell, false);
    square.experiment->map()->find(511 - 40, 511 - 300, image, false);
    EXPECT_EQ(cell[0], image[0]);
}

TEST(Tiles, GoOnWithThoseThatAreMissing) {
    TileRun run;
    run(small());
    const auto expected = run.contents();
    fs::remove(run.tiles() / "2-0-1.png");
    fs::remove(run.tiles() / "0-0-0.png");
    test::write_bytes(run.tiles() / "2-0-1.png.part", "of a run that was killed");
    const auto kept = fs::last_write_time(run.tiles() / "2-1-1.png");
    const auto result = run(small());
    EXPECT_EQ(result.samples, 256 * 256);
    EXPECT_EQ(run.contents(), expected);
    EXPECT_EQ(fs::last_write_time(run.tiles() / "2-1-1.png"), kept);
    ASSERT_FALSE(run.notes.empty());
    EXPECT_NE(run.notes.back().find("83 %"), std::string::npos) << run.notes.back();
}

std::pair<ExitCode, std::string> refusal(TileRun& run, const FigurePreset& figure, const FigureOptions& options = {},
                                         bool stop = false) {
    try {
        run(figure, options, stop);
    } catch (const Error& fault) {
        return {fault.code(), fault.what()};
    }
    return {ExitCode::done, ""};
}

TEST(Tiles, LeaveOtherFilesAlone) {
    TileRun run;
    run(small());
    auto [code, message] = refusal(run, small(600, 301));
    EXPECT_EQ(code, ExitCode::io_failed);
    EXPECT_NE(message.find("belongs to another preset or version"), std::string::npos) << message;
    fs::remove_all(run.out);
    fs::create_directories(run.tiles());
    test::write_bytes(run.tiles() / "diary.txt", "mine");
    std::tie(code, message) = refusal(run, small());
    EXPECT_EQ(code, ExitCode::io_failed);
    EXPECT_NE(message.find("not a folder of tiles of Doppel's"), std::string::npos) << message;
    EXPECT_EQ(test::bytes_of(run.tiles() / "diary.txt"), "mine");
    // nor through a link
    fs::remove_all(run.tiles());
    fs::create_directories(run.out / "elsewhere");
    fs::create_directory_symlink(run.out / "elsewhere", run.tiles());
    EXPECT_EQ(refusal(run, small()).first, ExitCode::io_failed);
    EXPECT_TRUE(fs::is_empty(run.out / "elsewhere"));
}

TEST(Tiles, OfAnotherSizeOrKindAreRefused) {
    TileRun run;
    run(small());
    const auto tile = run.tiles() / "2-0-0.png";
    const auto elsewhere = run.out / "tile.png";
    fs::rename(tile, elsewhere);
    const auto refused = [&](const char* why) {
        // with the coarser ones there, and to be made of it
        for (const char* coarser : {"", "1-0-0.png"}) {
            if (*coarser) fs::remove(run.tiles() / coarser);
            const auto [code, message] = refusal(run, small());
            EXPECT_EQ(code, ExitCode::io_failed) << why;
            EXPECT_NE(message.find("2-0-0.png"), std::string::npos) << message;
            EXPECT_NE(message.find(why), std::string::npos) << message;
        }
    };
    for (const Size size : {Size{4000, 4000}, {256, 300}, {300, 256}, {1, 1}}) {
        write_png(tile, Picture(size));
        refused("a tile has 256x256; remove it");
    }
    // a bomb: its pixels are not decoded
    write_png(tile, Picture({256, 256}));
    auto bytes = test::bytes_of(tile);
    bytes[18] = bytes[22] = 0x7f;
    test::write_bytes(tile, bytes);
    refused("32512x32512");
    fs::remove(tile);
    fs::create_symlink(elsewhere, tile);
    refused("cannot be read");
    fs::remove(tile);
    ASSERT_EQ(mkfifo(tile.c_str(), 0600), 0);
    refused("not a regular file");
    fs::remove(tile);
    fs::rename(elsewhere, tile);
    run(small());
}

TEST(Tiles, OfAnotherThemeOrScaleAreAnothers) {
    TileRun run;
    const std::string map =
        "title = \"x\"\n[scene]\nkind = \"grid\"\nduration_s = 0.5\n[grid]\ndifference = 0.01\n[grid.x]\npoints = 6\n"
        "[grid.y]\nkey = \"theta2_deg\"\npoints = 4\n";
    run(figure_from(map));
    for (const std::string other : {"chart.theme=\"dark\"", "grid.color_range=[0.3, 0.5]"}) {
        const auto [code, message] = refusal(run, figure_from(map, {other}));
        EXPECT_EQ(code, ExitCode::io_failed) << other;
        EXPECT_NE(message.find("belongs to another preset or version"), std::string::npos) << message;
    }
    run(figure_from("subtitle = \"other words\"\n" + map));  // the tiles are the same
}

TEST(Tiles, CountCellsNotPixels) {
    for (const int side : {20, 16, 256}) {  // a tile is its own image
        TileRun run;
        EXPECT_EQ(run(small(side, side)).samples, side * side);
    }
}

TEST(Tiles, GoOnWhereTheMarkWasCutShort) {
    TileRun run;
    run(small(20, 20));
    const auto mark = test::bytes_of(run.tiles() / "pyramid.json");
    fs::remove_all(run.tiles());
    fs::create_directories(run.tiles());
    test::write_bytes(run.tiles() / "pyramid.json", "");
    run(small(20, 20));
    EXPECT_EQ(test::bytes_of(run.tiles() / "pyramid.json"), mark);
    // but not where somebody's tiles are there
    test::write_bytes(run.tiles() / "pyramid.json", "");
    EXPECT_EQ(refusal(run, small(20, 20)).first, ExitCode::io_failed);
    // nor without an end
    fs::remove(run.tiles() / "pyramid.json");
    fs::create_symlink("/dev/zero", run.tiles() / "pyramid.json");
    EXPECT_EQ(refusal(run, small(20, 20)).first, ExitCode::io_failed);
}

TEST(Tiles, OfAMapWithoutANumberAreAFailureTheSecondTimeToo) {
    TileRun run;
    const auto still = figure_from(flips, {"scene.duration_s=\"1/120\"", "grid.x.points=300", "grid.y.points=260"});
    for (int again = 0; again < 2; ++again) {
        const auto [code, message] = refusal(run, still);
        EXPECT_EQ(code, ExitCode::method_failed);
        EXPECT_NE(message.find("none of the 300 × 260 cells has a number"), std::string::npos) << message;
        EXPECT_FALSE(fs::exists(run.out / "x/x.html"));
    }
}

TEST(Tiles, AreOfMapsAndOfAllParts) {
    TileRun run;
    auto [code, message] = refusal(run, figure_of("fig2-right"));
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_NE(message.find("--tiles are of one map"), std::string::npos) << message;
    run(small(), {.shard = Shard{1, 2}});
    std::tie(code, message) = refusal(run, small(), {.merge = true});
    EXPECT_EQ(code, ExitCode::try_again);
    EXPECT_NE(message.find("2-1-0.png is missing"), std::string::npos) << message;
    EXPECT_EQ(refusal(run, small(), {}, true).first, ExitCode::interrupted);
    EXPECT_EQ(run.contents().size(), 3u + 1);  // what was there stays
}

TEST(Map, OfMoreCellsThanMemoryHoldsIsRefusedBeforeItStarts) {
    const auto out = fs::path(DOPPEL_TEST_OUTPUT) / "tiles" / "too-large";
    fs::remove_all(out);
    constexpr int all = 1'048'576;
    std::string message;
    try {
        run_figures({small(all, all)}, {.out = out}, false, {});
    } catch (const Error& fault) {
        EXPECT_EQ(fault.code(), ExitCode::bad_input);
        message = fault.what();
    }
    EXPECT_TRUE(message.starts_with("x: 1 048 576 × 1 048 576 cells take 17.6 TB of memory")) << message;
    EXPECT_FALSE(fs::exists(out));
    // and tiles where the disk is too small for them
    TileRun run;
    EXPECT_EQ(refusal(run, small(all, all)).first, ExitCode::bad_input);
}

TEST(TilePage, SaysWhatItShowsAndNothingThatTheTitleMeans) {
    TileRun run;
    run(small());
    const auto page = test::bytes_of(run.out / "x" / "x.html");
    EXPECT_LT(page.size(), 100'000u);
    EXPECT_NE(page.find("<title>&lt;b&gt; &amp; more&lt;/script&gt;</title>"), std::string::npos);
    EXPECT_NE(page.find("\"columns\":600"), std::string::npos);
    EXPECT_NE(page.find("no flip within 0.6 s"), std::string::npos);
    EXPECT_EQ(page.find("{map}"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos);
}

TEST(TilePage, TakesAnyNames) {
    const fs::path path = fs::path(DOPPEL_TEST_OUTPUT) / "hostile.html";
    const std::string title = "</title><!--<script>{map}{subtitle}$(x)'\"\n`${1}`\\";
    const std::string label = "<!--<script></script>{title}$&$`\n\u2028'\"\\, m";
    MapFrame frame{.x = {.count = 2}, .y = {.count = 2}, .x_axis = {.label = label}, .y_axis = {.label = "y"}};
    frame.look.low = 0, frame.look.high = 1;
    // the address of a#b is not "a", and a%41 is not aA
    for (const auto& [name, address] : {std::pair("a#b?c", "a%23b%3Fc.tiles"),
                                        {"a%41", "a%2541.tiles"},
                                        {"x:y\\'\"\n<", "x%3Ay%5C%27%22%0A%3C.tiles"},
                                        {"θ\xff", "%CE%B8%FF.tiles"}}) {
        write_tile_page(path,
                        {title, title, std::string(name) + ".tiles", Pyramid(2, 2), frame, frame.look, themes[0]});
        const auto page = test::bytes_of(path);
        const std::string begin = "const map = ";
        const auto from = page.find(begin) + begin.size(), to = page.find(";\n", from);
        const auto data = page.substr(from, to - from);
        EXPECT_EQ(data.find('<'), std::string::npos) << data;
        const auto map = Json::parse(data);
        EXPECT_EQ(map["folder"], address);
        EXPECT_EQ(map["x"]["label"], label);
        // one script, one title, no comment
        for (const char* once : {"<script", "</script", "</title"}) {
            const auto at = page.find(once);
            EXPECT_NE(at, std::string::npos);
            EXPECT_EQ(page.find(once, at + 1), std::string::npos) << once;
        }
        EXPECT_EQ(page.find("<!--"), page.rfind("<!--"));
    }
}

}  // namespace tiles_test
}  // namespace doppel
