#include "film/runs.hpp"
#include "output/decoded.hpp"
#include "output/png.hpp"
#include "output/written.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>

namespace doppel::run_test {

using test::bytes_of;
using test::fresh_folder;

TEST(Run, NamesTheLibrariesThatDraw) {
    for (const auto& [name, gl] : {std::pair("auto", Gl::automatic), {"osmesa", Gl::osmesa}, {"egl", Gl::egl}})
        EXPECT_EQ(value_named<Gl>(name), gl);
}

TEST(Run, VideoHasTheFramesThatWereDrawn) {
    const auto out = fresh_folder();
    const auto scene = small_scene();
    render(scene, {.out = out});
    const auto path = out / "butterfly/butterfly.mp4";
    double worst = 1e9;
    const auto video = test::read_video(path, [&](const test::Luma& luma) {
        if (luma.frame % 10 == 0) worst = std::min(worst, test::luma_psnr(frame_of(scene, luma.frame), luma));
    });
    ASSERT_EQ(video.times.size(), 61u);
    for (std::size_t k = 0; k < video.times.size(); ++k)
        EXPECT_EQ(video.times[k], (test::Ratio{static_cast<std::int64_t>(k), 120})) << k;
    EXPECT_GT(worst, 36);  // dB; measured 42.9
    EXPECT_EQ(video.size, (Size{320, 180}));
    test::expect_tags(video);
    EXPECT_EQ(video.average_rate, (test::Ratio{120, 1}));
}

TEST(Run, OfAChangingSpeedHasTheSameTableAndMoreFrames) {
    const auto out = fresh_folder();
    const auto even = small_scene(),
               slow = small_scene({"video.speed=[[0, 1], [0.2, 0.25], [0.4, 1]]", "video.speed_ease_s=0.1"});
    render(even, {.out = out / "even"});
    EXPECT_EQ(render(slow, {.out = out / "slow"}).frames,
              133);  // 0.1 + 0.1 · 2.5 + 0.1 · 4 + 0.1 · 2.5 + 0.1 = 1.1 s …
    EXPECT_EQ(bytes_of(out / "even/butterfly/butterfly.csv"), bytes_of(out / "slow/butterfly/butterfly.csv"));
    // a range of frames has the same frames as the whole film, and the rows of its samples
    const auto png = small_scene({"video.speed=[[0, 1], [0.2, 0.25]]", "video.format=\"png\""});
    render(png, {.out = out / "all"});
    const long first = png.frames.first_from({24});
    EXPECT_EQ(png.frames.at(first), Moment{24});
    render(png, {.out = out / "part", .first = first, .last = first + 25});
    const auto rows = lines_of(out / "part/butterfly/butterfly.csv");
    ASSERT_EQ(rows.size(), 8u);  // 24 to 30
    EXPECT_EQ(rows[1], lines_of(out / "all/butterfly/butterfly.csv")[1 + 24]);
    const auto frames = files_in(out / "part/butterfly/frames");
    for (const auto& name : frames)
        EXPECT_EQ(bytes_of(out / "part/butterfly/frames" / name), bytes_of(out / "all/butterfly/frames" / name))
            << name;
    EXPECT_EQ(frames.size(), 25u);  // 6 samples at a quarter of the speed, both ends
}

TEST(Run, OfAnyRateHasTheSameTableAndFramesThatAreTheSameAtAnyOther) {
    const auto out = fresh_folder();
    for (const std::string preset : {"butterfly", "fan", "phase-dance"}) {
        const auto scene = [&](const char* fps) {
            return scene_of(preset, {"video.size=[320, 180]", "scene.duration_s=0.2", "video.format=\"png\"",
                                     "video.hold_start_s=0", "video.hold_end_s=0", "video.title_card_s=0",
                                     "video.end_card_s=0", fmt::format("video.fps={}", fps)});
        };
        const auto film = scene("50");
        render(scene("120"), {.out = out / "120"});
        EXPECT_EQ(render(film, {.out = out / "50"}).frames, 11);
        EXPECT_EQ(render(scene("600"), {.out = out / "600"}).frames, 121);
        const auto name = "/" + preset + "/" + preset + ".csv";
        for (const char* other : {"50", "600"})
            EXPECT_EQ(bytes_of(out / (other + name)), bytes_of(out / ("120" + name))) << preset << ' ' << other;
        const auto frame = [&](const char* folder, long k) {
            return bytes_of(out / folder / preset / "frames" / fmt::format("{:06}.png", k));
        };
        for (const long k : {0, 1, 12, 23, 24}) EXPECT_EQ(frame("600", 5 * k), frame("120", k)) << preset << ' ' << k;
        for (const long k : {0, 1, 2, 5, 9, 10}) EXPECT_EQ(frame("50", k), frame("600", 12 * k)) << preset << ' ' << k;
        EXPECT_NE(frame("600", 61), frame("600", 60));
        // and a single frame: sample 16.8, between two samples
        render(film, {.out = out / "part", .first = 7, .last = 8});
        EXPECT_EQ(frame("part", 7), frame("50", 7)) << preset;
    }
}

TEST(Run, ManifestTellsWhatRanAndHashesIt) {
    const auto out = fresh_folder();
    render(small_scene({"b.model=\"constraints\""}), {.out = out});
    EXPECT_EQ(files_in(out / "butterfly"), (std::set<std::string>{"butterfly.mp4", "butterfly.csv", "butterfly.json"}));
    const auto manifest = nlohmann::json::parse(bytes_of(out / "butterfly/butterfly.json"));
    EXPECT_EQ(manifest["preset"], "butterfly");
    EXPECT_EQ(manifest["resolved_preset"]["b"]["angle_deg"][0], 90.003);
    EXPECT_EQ(manifest["resolved_preset"]["video"]["size"][0], 320);
    EXPECT_EQ(manifest["steps"], 2 * 60 * 250);
    EXPECT_EQ(manifest["a"]["model"], "angles");
    EXPECT_EQ(manifest["b"]["model"], "constraints");
    EXPECT_GT(manifest["b"]["worst_length_error_m"], 0);
    EXPECT_NE(manifest["libraries"]["gl"].get<std::string>().find("llvmpipe"), std::string::npos);
    EXPECT_GT(manifest["time"]["cpu_by_stage_s"]["draw"], 0);
    for (const char* name : {"butterfly.mp4", "butterfly.csv"})
        EXPECT_EQ(manifest["files"][name]["sha256"], sha256_of_file(out / "butterfly" / name));
}

TEST(Run, FilmsCanBeTracedToTheirManifest) {
    for (const auto* format : {"mp4", "webm", "gif"}) {
        const auto out = fresh_folder();
        render(small_scene({fmt::format("video.format=\"{}\"", format)}), {.out = out});
        const auto film =
            test::read_video(out / fmt::format("butterfly/butterfly.{}", format), [](const test::Luma&) {});
        std::string said;
        for (const auto& [key, text] : film.metadata) said += text + "\n";
        for (const std::string word :
             {"Three thousandths of a degree", "preset butterfly", "butterfly.json", "Doppel 1."})
            EXPECT_NE(said.find(word), std::string::npos) << format << " lacks " << word << " in " << said;
    }
}

TEST(Run, SameArgumentsGiveTheSameBytesWhateverTheJobsAndCores) {
    const auto one_core = [](auto&& action) {
        cpu_set_t all, one;
        ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
        CPU_ZERO(&one);
        CPU_SET(sched_getcpu(), &one);
        sched_setaffinity(0, sizeof one, &one);
        action();
        sched_setaffinity(0, sizeof all, &all);
    };
    const std::vector<std::pair<std::string, std::vector<std::string>>> formats{
        {"mp4", {}},
        {"webm", {}},
        {"webm", {"video.codec=\"av1\""}},
        {"webm", {"video.codec=\"av1\"", "video.pixel_format=\"yuv444p\""}},
        {"webm", {"video.transparent=true"}},
        {"gif", {}},
        {"apng", {}},
        {"png", {}}};
    for (const auto& [format, more] : formats) {
        const auto out = fresh_folder();
        auto arguments = more;
        arguments.push_back(fmt::format("video.format=\"{}\"", format));
        const auto scene = small_scene(arguments);
        const auto film =
            format == "png" ? out / "butterfly/frames/000019.png" : out / ("butterfly/butterfly." + format);
        std::set<std::string> films, tables;
        const auto keep = [&] {
            films.insert(bytes_of(film));
            tables.insert(bytes_of(out / "butterfly/butterfly.csv"));
        };
        one_core([&] { render(scene, {.out = out, .to_s = Rational{1, 6}, .jobs = 1}); });
        keep();
        render(scene, {.out = out, .to_s = Rational{1, 6}, .jobs = 5});
        keep();
        EXPECT_EQ(films.size() + tables.size(), 2u) << fmt::format("{}", fmt::join(arguments, " "));
    }
}

}  // namespace doppel::run_test
