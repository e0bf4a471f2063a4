#include "film/run.hpp"

#include "film/support.hpp"
#include "output/decoded.hpp"
#include "output/fixtures.hpp"
#include "output/png.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

namespace doppel {
namespace run_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::fresh_folder;
const std::atomic<bool> never = false;

std::vector<std::string> lines_of(const fs::path& path) {
    std::istringstream text(bytes_of(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line, '\n');) {
        EXPECT_TRUE(line.ends_with('\r')) << "RFC 4180 ends lines with CR LF";
        lines.push_back(line.substr(0, line.size() - 1));
    }
    return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::string cell;
    for (std::istringstream text(line + ","); std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
}

Scene small(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"video.size=[320, 180]", "scene.duration_s=0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return scene_of("butterfly", arguments);
}

RunResult render(const Scene& scene, RunOptions options) {
    return run(scene, options, never, [](const Progress&) {});
}

TEST(Run, WritesVideoTableAndManifest) {
    const auto out = fresh_folder();
    const auto result = render(small(), {.out = out});
    EXPECT_EQ(result.frames, 61);  // 0.5 s at 120 Hz, both ends
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(out / "butterfly")) names.insert(entry.path().filename().string());
    EXPECT_EQ(names, (std::set<std::string>{"butterfly.mp4", "butterfly.csv", "butterfly.json"}));
}

TEST(Run, VideoHasTheFramesThatWereDrawn) {
    const auto out = fresh_folder();
    const auto scene = small();
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

TEST(Run, TableHasTheColumnsOfTheContract) {
    const auto out = fresh_folder();
    render(small(), {.out = out, .pictures = false});
    const auto lines = lines_of(out / "butterfly/butterfly.csv");
    EXPECT_EQ(lines.front(),
              "sample,time_s,"
              "a_theta1_rad,a_theta2_rad,a_omega1_rad_per_s,a_omega2_rad_per_s,"
              "a_x1_m,a_y1_m,a_vx1_m_per_s,a_vy1_m_per_s,a_x2_m,a_y2_m,a_vx2_m_per_s,a_vy2_m_per_s,"
              "a_energy_J,a_energy_error,a_length_error_m,"
              "b_theta1_rad,b_theta2_rad,b_omega1_rad_per_s,b_omega2_rad_per_s,"
              "b_x1_m,b_y1_m,b_vx1_m_per_s,b_vy1_m_per_s,b_x2_m,b_y2_m,b_vx2_m_per_s,b_vy2_m_per_s,"
              "b_energy_J,b_energy_error,b_length_error_m,"
              "distance,log_ratio");
    ASSERT_EQ(lines.size(), 62u);
    const auto first = cells_of(lines[1]), last = cells_of(lines.back());
    EXPECT_EQ(first[0], "0");
    EXPECT_EQ(first[2], fmt::format("{}", pi / 2));
    EXPECT_EQ(first.back(), "0");  // ln(d0/d0)
    EXPECT_EQ(last[0], "60");
    EXPECT_EQ(last[1], "0.5");
}

TEST(Run, TableHasTheEnergiesLastWhereTheyAreAskedFor) {
    const auto out = fresh_folder();
    render(small({"scene.energy_columns=true"}), {.out = out, .pictures = false});
    render(small(), {.out = out / "plain", .pictures = false});
    const auto lines = lines_of(out / "butterfly/butterfly.csv"),
               plain = lines_of(out / "plain/butterfly/butterfly.csv");
    ASSERT_EQ(lines.size(), plain.size());
    EXPECT_EQ(lines[0], plain[0] + ",a_kinetic_J,a_potential_J,b_kinetic_J,b_potential_J");
    for (std::size_t k = 1; k < lines.size(); ++k) {
        EXPECT_TRUE(lines[k].starts_with(plain[k] + ",")) << k;  // old columns as they were
        const auto cells = cells_of(lines[k]);
        const auto at = [&](std::size_t from_end) { return std::stod(cells[cells.size() - from_end]); };
        // m g (y1 + y2) of side a, and ½ m v²
        const auto cell = [&](std::size_t column) { return std::stod(cells[column]); };
        EXPECT_NEAR(at(3), 9.8 * (cell(7) + cell(11)), 1e-12) << k;  // measured 4e-15
        EXPECT_NEAR(at(4), 0.5 * (cell(8) * cell(8) + cell(9) * cell(9) + cell(12) * cell(12) + cell(13) * cell(13)),
                    1e-12)
            << k;
    }
    const auto again =
        read_preset({"x", "x.toml", resolved_toml(small({"scene.energy_columns=true"}).preset), "x.toml"});
    EXPECT_TRUE(again.energy_columns);
}

TEST(Run, TableLeavesTheLogRatioEmptyWhereThePairStartsAsOne) {
    const auto out = fresh_folder();
    render(scene_of("two-methods", {"scene.duration_s=0.1"}), {.out = out, .pictures = false});
    for (const auto& line : lines_of(out / "two-methods/two-methods.csv"))
        EXPECT_TRUE(line.ends_with("log_ratio") || line.ends_with(","));
}

TEST(Run, TableIsTheSameForAnyJobsAndWithOrWithoutPictures) {
    const auto out = fresh_folder();
    std::set<std::string> tables;
    for (const int jobs : {1, 2, 5}) {
        render(small(), {.out = out, .pictures = jobs != 2, .jobs = jobs});
        tables.insert(sha256_of_file(out / "butterfly/butterfly.csv"));
    }
    EXPECT_EQ(tables.size(), 1u);
}

TEST(Run, AnyFramesAloneAreThoseOfTheWhole) {
    const auto out = fresh_folder();
    const auto all = out / "all", some = out / "some";
    const auto scene = small({"video.format=\"png\""});
    render(scene, {.out = all});
    render(scene, {.out = some, .first = 37, .last = 45, .jobs = 2});
    long count = 0;
    for (const auto& entry : fs::directory_iterator(some / "butterfly/frames")) {
        const auto name = entry.path().filename();
        EXPECT_EQ(bytes_of(entry.path()), bytes_of(all / "butterfly/frames" / name)) << name;
        ++count;
    }
    EXPECT_EQ(count, 8);
    EXPECT_TRUE(fs::exists(some / "butterfly/frames/000037.png"));
    // the table has the same rows, too
    const auto rows = lines_of(some / "butterfly/butterfly.csv"), all_rows = lines_of(all / "butterfly/butterfly.csv");
    ASSERT_EQ(rows.size(), 9u);
    EXPECT_EQ(rows[1], all_rows[1 + 37]);
}

TEST(Run, DrawsTheSameInSequenceAsAlone) {
    // the renderer redraws only what changes; no pixel may depend on it
    const auto out = fresh_folder();
    const auto scene = scene_of("butterfly", {"video.size=[320, 180]", "video.format=\"png\"", "scene.duration_s=1.5"});
    render(scene, {.out = out});
    for (const long sample : {0L, 1L, 90L, 180L})
        EXPECT_EQ(read_png(out / fmt::format("butterfly/frames/{:06}.png", sample)).rgba, frame_of(scene, sample).rgba)
            << sample;
}

TEST(Run, ShowsEveryOtherSampleAtHalfTheRate) {
    const auto out = fresh_folder();
    const auto scene = small({"video.format=\"png\"", "video.fps=60"});
    EXPECT_EQ(render(scene, {.out = out}).frames, 31);
    EXPECT_EQ(read_png(out / "butterfly/frames/000030.png").rgba, frame_of(scene, 60).rgba);
}

TEST(Run, OfAChangingSpeedHasTheSameTableAndMoreFrames) {
    const auto out = fresh_folder();
    const auto even = small(), slow = small({"video.speed=[[0, 1], [0.2, 0.25], [0.4, 1]]", "video.speed_ease_s=0.1"});
    render(even, {.out = out / "even"});
    EXPECT_EQ(render(slow, {.out = out / "slow"}).frames,
              133);  // 0.1 + 0.1 · 2.5 + 0.1 · 4 + 0.1 · 2.5 + 0.1 = 1.1 s …
    EXPECT_EQ(bytes_of(out / "even/butterfly/butterfly.csv"), bytes_of(out / "slow/butterfly/butterfly.csv"));
    // a part of it has the frames of the whole, and the rows of its samples
    const auto png = small({"video.speed=[[0, 1], [0.2, 0.25]]", "video.format=\"png\""});
    render(png, {.out = out / "all"});
    render(png, {.out = out / "part", .first = 24, .last = 31});
    EXPECT_EQ(lines_of(out / "part/butterfly/butterfly.csv").size(), 8u);
    long count = 0;
    for (const auto& entry : fs::directory_iterator(out / "part/butterfly/frames")) {
        EXPECT_EQ(bytes_of(entry.path()), bytes_of(out / "all/butterfly/frames" / entry.path().filename()));
        ++count;
    }
    EXPECT_EQ(count, 25);  // 6 samples at a quarter of the speed, both ends
}

TEST(Run, ManifestTellsWhatRanAndHashesIt) {
    const auto out = fresh_folder();
    render(small({"b.model=\"constraints\""}), {.out = out});
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
        render(small({fmt::format("video.format=\"{}\"", format)}), {.out = out});
        const auto film =
            test::read_video(out / fmt::format("butterfly/butterfly.{}", format), [](const test::Luma&) {});
        std::string said;
        for (const auto& [key, text] : film.metadata) said += text + "\n";
        for (const std::string word :
             {"Three thousandths of a degree", "preset butterfly", "butterfly.json", "Doppel 1."})
            EXPECT_NE(said.find(word), std::string::npos) << format << " lacks " << word << " in " << said;
    }
}

TEST(Run, LeavesNothingWhenItIsInterrupted) {
    for (const char* format : {"mp4", "png"}) {
        const auto out = fresh_folder();
        std::atomic<bool> stop = false;
        const auto [code, message] = error_of([&] {
            run(small({fmt::format("video.format=\"{}\"", format)}), {.out = out}, stop,
                [&](const Progress& p) { stop = p.done == 20; });
        });
        EXPECT_EQ(code, ExitCode::interrupted);
        EXPECT_TRUE(fs::is_empty(out)) << format;
    }
}

TEST(Run, KeepsTheSamplesBeforeTheMethodFailedUnderANameThatSaysSo) {
    const auto out = fresh_folder();
    const auto scene = scene_of("butterfly", {"system.step_s=\"1/3\"", "scene.sample_hz=3", "scene.duration_s=3000",
                                              "video.size=[64, 64]", "system.model=\"constraints\""});
    const auto [code, message] = error_of([&] { render(scene, {.out = out}); });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_NE(message.find("butterfly.failed.csv"), std::string::npos) << message;

    // two files, no video and nothing that looks whole
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(out / "butterfly")) names.insert(entry.path().filename());
    EXPECT_EQ(names, (std::set<std::string>{"butterfly.failed.csv", "butterfly.failed.json"}));
    const auto manifest = nlohmann::json::parse(std::ifstream(out / "butterfly" / "butterfly.failed.json"));
    const std::string failure = manifest["failed"];
    EXPECT_EQ(message.rfind(failure, 0), 0u);
    std::ifstream table(out / "butterfly" / "butterfly.failed.csv");
    long rows = -1;  // the header
    for (std::string line; std::getline(table, line);) ++rows;
    EXPECT_EQ(rows, manifest["samples"]["last"].get<long>() + 1);
    EXPECT_GT(rows, 1);

    // a whole run takes them away
    render(scene_of("butterfly", {"scene.duration_s=0.1", "video.size=[64, 64]"}), {.out = out});
    EXPECT_FALSE(fs::exists(out / "butterfly" / "butterfly.failed.csv"));
    EXPECT_TRUE(fs::exists(out / "butterfly" / "butterfly.csv"));
}

TEST(Run, OfAnAdaptiveMethodSaysWhichStepHeld) {
    const auto failure = [](const std::vector<std::string>& arguments) {
        auto all = arguments;
        all.emplace_back("scene.duration_s=2");
        const auto scene = scene_of("butterfly", all);
        return error_of([&] { run(scene, {.out = fresh_folder(), .pictures = false}, never, [](const Progress&) {}); });
    };
    const auto [code, message] = failure({"system.integrator=\"taylor\"", "system.tolerance=1000"});
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_NE(message.find("the smallest step that held was 0.9"), std::string::npos) << message;
    const auto hopeless = failure({"system.integrator=\"dop853\"", "system.length_m=[1e-200, 1]"});
    EXPECT_EQ(hopeless.first, ExitCode::method_failed);
    EXPECT_NE(hopeless.second.find("not even a first step held"), std::string::npos) << hopeless.second;
}

TEST(Run, RefusesFramesThatAreNotThere) {
    const auto [code, message] = error_of([&] { render(small(), {.out = fresh_folder(), .first = 60, .last = 62}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_EQ(message, "--frames 60:62: butterfly has the samples 0 to 60; A:B must have 0 ≤ A < B ≤ 61");
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
        const auto scene = small(arguments);
        const auto film =
            format == "png" ? out / "butterfly/frames/000019.png" : out / ("butterfly/butterfly." + format);
        std::set<std::string> films;
        one_core([&] { render(scene, {.out = out, .last = 20, .jobs = 1}); });
        films.insert(bytes_of(film));
        render(scene, {.out = out, .last = 20, .jobs = 5});
        films.insert(bytes_of(film));
        EXPECT_EQ(films.size(), 1u) << fmt::format("{}", fmt::join(arguments, " "));
    }
}

TEST(Run, StopsBeforeItsFirstFrameWhileItLooksHowFarThePairGets) {
    // 100 million samples of a mechanism, whose view depends on all of them
    const auto scene = scene_of("springs", {"scene.duration_s=800000", "video.size=[64, 64]"});
    const auto out = fresh_folder();
    std::atomic<bool> stop = false;
    const std::jthread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        stop = true;
    });
    const auto start = std::chrono::steady_clock::now();
    const auto [code, message] =
        error_of([&] { run(scene, {.out = out, .first = 0, .last = 1}, stop, [](const Progress&) {}); });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(code, ExitCode::interrupted) << message;
    EXPECT_LT(taken.count(), 2);  // s; measured 0.06, and half an hour where the survey does not look
    EXPECT_TRUE(fs::is_empty(out));
}

TEST(Run, LooksAheadOnlyWhereAPictureDependsOnIt) {
    const std::vector<std::string> arguments{"scene.duration_s=800000", "video.size=[64, 64]",
                                             "video.panels=[\"distance\"]", "video.distance_range=[1e-5, 10]"};
    EXPECT_EQ(render(scene_of("springs", arguments), {.out = fresh_folder(), .first = 0, .last = 1}).frames, 1);
}

TEST(Run, LeavesNoFrameOfASequenceThatBrokeDown) {
    // many threads still write large pictures when the method fails, and nothing better is looked for
    const auto scene = scene_of("butterfly", {"system.integrator=\"taylor\"", "system.tolerance=1000",
                                              "scene.duration_s=2", "video.size=[1280, 720]", "video.format=\"png\""});
    for (int round = 0; round < 4; ++round) {
        const auto out = fresh_folder();
        EXPECT_EQ(error_of([&] { render(scene, {.out = out, .jobs = 32}); }).first, ExitCode::method_failed);
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(out / "butterfly"))
            names.insert(entry.path().filename());
        EXPECT_EQ(names, (std::set<std::string>{"butterfly.failed.csv", "butterfly.failed.json"}));
    }
}

TEST(Run, RefusesAPosterOutsideItsFrames) {
    const auto out = fresh_folder();
    const auto scene = small({"video.poster_s=0.25"});
    const auto [code, message] = error_of([&] { render(scene, {.out = out, .first = 0, .last = 30}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_EQ(message,
              "--frames 0:30: the poster of butterfly, poster_s = 1/4, is sample 30; --frames 0:31 would have it");
    EXPECT_TRUE(fs::is_empty(out));
    EXPECT_EQ(error_of([&] { render(scene, {.out = out, .first = 31, .last = 40}); }).first, ExitCode::bad_input);
    render(scene, {.out = out, .first = 30, .last = 31});
    EXPECT_TRUE(fs::exists(out / "butterfly/butterfly.poster.png"));
    render(scene, {.out = out, .pictures = false, .first = 0, .last = 30});  // no picture, no poster to miss
}

TEST(Run, NeverMixesOldFramesIntoNewOnes) {
    const auto out = fresh_folder();
    const auto scene = small({"video.format=\"png\""});
    render(scene, {.out = out, .first = 0, .last = 5});
    render(scene, {.out = out, .first = 10, .last = 12});
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(out / "butterfly/frames"))
        names.insert(entry.path().filename().string());
    EXPECT_EQ(names, (std::set<std::string>{"000010.png", "000011.png"}));
}

TEST(Run, LeavesTheEnergyErrorOpenWhereDampingTakesEnergy) {
    const auto out = fresh_folder();
    const auto scene = make_scene(read_preset({"damped", "damped.toml", R"(
[scene]
duration_s = 0.1
[system]
integrator = "rk4"
step_s = "1/1200"
[[b.force]]
kind = "spring"
from = "bob2"
to = [0, -3]
damping_N_s_per_m = 2
)"}));
    run(scene, {.out = out, .pictures = false}, never, [](const Progress&) {});
    const auto lines = lines_of(out / "damped/damped.csv");
    const auto header = cells_of(lines[0]), last = cells_of(lines.back());
    const auto cell = [&](const char* name) {
        return last[static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin())];
    };
    EXPECT_EQ(header.size(), last.size());
    EXPECT_NE(cell("a_energy_error"), "");
    EXPECT_EQ(cell("b_energy_error"), "");
    EXPECT_NE(cell("b_energy_J"), "");
    EXPECT_NE(cell("b_length_error_m"), "");
    const auto manifest = nlohmann::json::parse(bytes_of(out / "damped/damped.json"));
    EXPECT_TRUE(manifest["a"]["worst_energy_error"].is_number());
    EXPECT_EQ(manifest["a"]["conserves_energy"], true);
    EXPECT_TRUE(manifest["b"]["worst_energy_error"].is_null());
    EXPECT_EQ(manifest["b"]["conserves_energy"], false);
}

}  // namespace run_test
}  // namespace doppel
