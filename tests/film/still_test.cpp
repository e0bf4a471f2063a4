#include "film/runs.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>

namespace doppel::still_test {

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
    still(scene, {1, 1}, out);  // replaces the last still
    EXPECT_EQ(files_in(out / "butterfly"),
              (std::set<std::string>{"butterfly.csv", "butterfly.json", "butterfly.0.5s.png", "butterfly.1s.png"}));
}

TEST(Still, IsAlsoAPageOfPathsAndText) {
    const auto out = test::fresh_folder();
    for (int time = 0; time < 2; ++time) {  // the second run replaces the file of the first
        const auto svg = still(small(), {1, 1}, out, PictureFormat::svg);
        EXPECT_EQ(svg.filename(), "butterfly.1s.svg");
        EXPECT_NE(test::bytes_of(svg).find("<title>Three thousandths of a degree</title>"), std::string::npos);
        const auto pdf = still(small(), {1, 1}, out, PictureFormat::pdf);
        EXPECT_TRUE(test::bytes_of(pdf).starts_with("%PDF-"));
    }
    // a file that Doppel did not write is not replaced
    test::write_bytes(out / "butterfly/butterfly.0.5s.pdf", "%PDF-1.5 of mine");
    EXPECT_EQ(error_of([&] { still(small(), {1, 2}, out, PictureFormat::pdf); }).first, ExitCode::io_failed);
}

TEST(Still, IsOfAnyTimeUpToTheEnd) {
    const auto path = still(small(), {1003, 1000});
    EXPECT_EQ(path.filename(), "butterfly.1.003s.png");
    // the same picture as in a film that has a sample at this time
    const auto pixels = [](std::vector<std::string> more) {
        more.insert(more.end(), {"video.trail_s=0", "video.panels=[\"pendulums\"]", "video.fps=60"});
        return read_png(still(small(more), {1003, 1000})).rgba;
    };
    EXPECT_EQ(pixels({}), pixels({"scene.sample_hz=1000"}));
    EXPECT_EQ(error_of([&] { still(small(), {2, 1}); }).second, "--at 2: butterfly ends at 1.5 s");
}

TEST(Still, RangesInSecondsAreThoseInFramesWithoutTheirEnd) {
    const auto names_of_frames = [](const RunOptions& options) {
        render(small(), options);
        return files_in(options.out / "butterfly/frames");
    };
    const auto of = [&](std::optional<Rational> from, std::optional<Rational> to) {
        return names_of_frames({.out = test::fresh_folder(), .from_s = from, .to_s = to});
    };
    const auto frames = [&](long first, long last) {
        return names_of_frames({.out = test::fresh_folder(), .first = first, .last = last});
    };
    EXPECT_EQ(of(Rational{1, 2}, Rational{3, 5}), frames(60, 72));
    EXPECT_EQ(of(Rational{7, 5}, std::nullopt), frames(168, 181)) << "the end of the whole is a frame";
    EXPECT_EQ(of(Rational{7, 5}, Rational{3, 2}), frames(168, 180)) << "0.1 s to the frame: such parts make loops";
    EXPECT_EQ(of(std::nullopt, Rational{1, 100}), frames(0, 2));  // between two frames
    // at 25 frames per second, the samples at the same times
    EXPECT_EQ(
        render(small({"video.fps=25"}), {.out = test::fresh_folder(), .from_s = Rational{1, 2}, .to_s = Rational{3, 5}})
            .samples,
        12);
    const auto message = [&](std::optional<Rational> from, std::optional<Rational> to) {
        return error_of([&] { of(from, to); }).second;
    };
    EXPECT_EQ(message(Rational{2, 1}, std::nullopt), "--from 2: butterfly ends at 1.5 s");
    EXPECT_EQ(message(Rational{1, 1}, Rational{1, 2}),
              "--from 1 --to 0.5: the end, which is not included, must be after the start");
    EXPECT_EQ(message(Rational{1001, 1000}, Rational{1002, 1000}),
              "--from 1.001 --to 1.002: butterfly has no frame in this interval; frames are 0.00833 s apart");
}

}  // namespace doppel::still_test
