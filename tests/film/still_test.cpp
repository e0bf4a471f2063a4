#include "film/runs.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace still_test {

namespace fs = std::filesystem;
Scene small(std::vector<std::string> more = {}) {
    more.emplace_back("video.format=\"png\"");
    return small_scene(more, "1.5");
}

fs::path still(const Scene& scene, const Rational& time, const fs::path& out = test::fresh_folder(),
               PictureFormat format = PictureFormat::png) {
    return draw_still(scene, time, format, {.out = out}, false, [](const Progress&) {}).files.at(0);
}

TEST(Still, IsTheFrameOfTheFilm) {
    const auto scene = small();
    const auto path = still(scene, {5, 4});
    EXPECT_EQ(path.filename(), "butterfly.1.25s.png");
    EXPECT_EQ(read_png(path).rgba, frame_of(scene, 150).rgba);
}

TEST(Still, IsOfAnySampleWhateverTheFrames) {
    const auto scene = small({"video.fps=30"});
    EXPECT_EQ(read_png(still(scene, {1, 120})).rgba, frame_of(scene, 1).rgba);
}

TEST(Still, HasTheOpacityOfATransparentFilm) {
    const auto picture = read_png(still(small({"video.transparent=true"}), {1, 1}));
    EXPECT_EQ(picture.rgba[3], 0);  // the corner
}

TEST(Still, IsWrittenBesideAFilmAndOtherStills) {
    const auto out = test::fresh_folder();
    const auto scene = small();
    render(scene, {.out = out, .pictures = false});
    still(scene, {1, 2}, out);
    still(scene, {1, 1}, out);
    still(scene, {1, 1}, out);  // in place of the last
    EXPECT_EQ(files_in(out / "butterfly"),
              (std::set<std::string>{"butterfly.csv", "butterfly.json", "butterfly.0.5s.png", "butterfly.1s.png"}));
}

TEST(Still, IsAlsoAPageOfPathsAndText) {
    const auto out = test::fresh_folder();
    for (int time = 0; time < 2; ++time) {  // the second in place of the first
        const auto svg = still(small(), {1, 1}, out, PictureFormat::svg);
        EXPECT_EQ(svg.filename(), "butterfly.1s.svg");
        EXPECT_NE(test::bytes_of(svg).find("Three thousandths of a degree</text>"), std::string::npos);
        const auto pdf = still(small(), {1, 1}, out, PictureFormat::pdf);
        EXPECT_TRUE(test::bytes_of(pdf).starts_with("%PDF-"));
    }
    // somebody else's is not replaced
    test::write_bytes(out / "butterfly/butterfly.0.5s.pdf", "%PDF-1.5 of mine");
    EXPECT_EQ(error_of([&] { still(small(), {1, 2}, out, PictureFormat::pdf); }).first, ExitCode::io_failed);
}

TEST(Still, SaysWhichTimesThereAre) {
    const auto message = [](const Rational& time) { return error_of([&] { still(small(), time); }).second; };
    EXPECT_EQ(message({1003, 1000}),
              "--at 1.003: butterfly has no sample there; those at 1 s and 1.008333 s are next to it");
    EXPECT_EQ(message({2, 1}), "--at 2: butterfly ends at 3/2 s");
}

TEST(Still, RangesInSecondsAreThoseInSamples) {
    const auto names_of_frames = [](const RunOptions& options) {
        render(small(), options);
        return files_in(options.out / "butterfly/frames");
    };
    const auto of = [&](std::optional<Rational> from, std::optional<Rational> to) {
        return names_of_frames({.out = test::fresh_folder(), .from_s = from, .to_s = to});
    };
    const auto samples = [&](long first, long last) {
        return names_of_frames({.out = test::fresh_folder(), .first = first, .last = last});
    };
    EXPECT_EQ(of(Rational{1, 2}, Rational{3, 5}), samples(60, 73));  // both ends
    EXPECT_EQ(of(Rational{7, 5}, std::nullopt), samples(168, 181));
    EXPECT_EQ(of(std::nullopt, Rational{1, 100}), samples(0, 2));  // between two samples
    const auto message = [&](std::optional<Rational> from, std::optional<Rational> to) {
        return error_of([&] { of(from, to); }).second;
    };
    EXPECT_EQ(message(Rational{2, 1}, std::nullopt), "--from 2: butterfly ends at 3/2 s");
    EXPECT_EQ(message(Rational{1, 1}, Rational{1, 2}), "--from 1 --to 0.5: the end must not be before the start");
    EXPECT_EQ(message(Rational{1001, 1000}, Rational{1002, 1000}),
              "--from 1.001 --to 1.002: butterfly has no sample there; they are 0.00833 s apart");
}

}  // namespace still_test
}  // namespace doppel
