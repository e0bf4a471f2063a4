#include "film/runs.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>
#include <tuple>

namespace doppel::failed_films_test {

namespace fs = std::filesystem;
using test::fresh_folder;

TEST(FailedFilms, KeepsTheSamplesBeforeTheMethodFailedUnderANameThatSaysSo) {
    const auto out = fresh_folder();
    const auto scene = scene_of("butterfly", {"system.step_s=\"1/3\"", "scene.sample_hz=3", "scene.duration_s=3000",
                                              "video.size=[64, 64]", "system.model=\"constraints\""});
    const auto [code, message] = error_of([&] { render(scene, {.out = out}); });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_NE(message.find("butterfly.failed.csv"), std::string::npos) << message;

    // two files, no video, and no file that looks complete
    EXPECT_EQ(files_in(out / "butterfly"), (std::set<std::string>{"butterfly.failed.csv", "butterfly.failed.json"}));
    const auto manifest = nlohmann::json::parse(std::ifstream(out / "butterfly" / "butterfly.failed.json"));
    EXPECT_TRUE(message.starts_with(manifest["failed"].get<std::string>())) << message;
    const auto lines = lines_of(out / "butterfly" / "butterfly.failed.csv");  // with the header
    EXPECT_EQ(lines.size(), manifest["samples"]["last"].get<std::size_t>() + 2);
    EXPECT_GT(lines.size(), 2u);

    // a complete run removes them
    render(scene_of("butterfly", {"scene.duration_s=0.1", "video.size=[64, 64]"}), {.out = out});
    EXPECT_FALSE(fs::exists(out / "butterfly" / "butterfly.failed.csv"));
    EXPECT_TRUE(fs::exists(out / "butterfly" / "butterfly.csv"));
}

TEST(FailedFilms, OfAnAdaptiveMethodNamesTheSmallestStepBefore) {
    for (const auto& [integrator, other, words] :
         {std::tuple("taylor", "system.tolerance=1000", "the smallest step before was 0.9"),
          {"dop853", "system.length_m=[1e-200, 1]", "the first step failed"}}) {
        const auto scene =
            scene_of("butterfly", {"scene.duration_s=2", std::string("system.integrator=") + integrator, other});
        test::expect_error(ExitCode::method_failed, {words},
                           [&] { render(scene, {.out = fresh_folder(), .pictures = false}); });
    }
}

TEST(FailedFilms, StopsDuringTheSimulationBeforeTheFirstFrame) {
    // 100 million samples of a mechanism, whose view depends on all samples
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
    EXPECT_LT(taken.count(), 2);  // s; measured 0.06, and half an hour if the survey ignores the request to stop
    EXPECT_TRUE(fs::is_empty(out));
}

TEST(FailedFilms, SimulatesInAdvanceOnlyIfAPictureDependsOnIt) {
    const std::vector<std::string> arguments{"scene.duration_s=800000", "video.size=[64, 64]",
                                             "video.panels=[\"distance\"]", "video.distance_range=[1e-5, 10]"};
    EXPECT_EQ(render(scene_of("springs", arguments), {.out = fresh_folder(), .first = 0, .last = 1}).frames, 1);
    EXPECT_FALSE(depends_on_motion(scene_of("whip-256"))) << "a still of its start takes no run of seconds";
}

TEST(FailedFilms, WhatIsTooLargeToKeepIsSimulatedAgain) {
    const auto scene = scene_of("fan", {"scene.duration_s=0.5", "video.members=3", "video.fps=50"});
    struct Seen {
        std::vector<double> numbers;
        MotionRecord record;
        MotionBounds bounds;
    };
    const auto seen = [&](double max_bytes) {
        Recording recording(scene, {40}, true, never_stopped, {}, max_bytes);
        const double cpu_s = recording.cpu_s();
        std::vector<double> numbers;
        for (int time = 0; time < 2; ++time)
            recording.play([&](const Snapshot& snapshot) {
                numbers.insert(numbers.end(), {snapshot.pair.share, snapshot.pair.a.bobs[1].x, snapshot.pair.distance});
                for (const auto& bobs : snapshot.members) numbers.push_back(bobs.back().theta);
            });
        EXPECT_EQ(recording.cpu_s() > cpu_s, max_bytes == 0) << "simulated again";
        return Seen{numbers, recording.record(), recording.bounds()};
    };
    const auto kept = seen(Recording::usual_bytes), again = seen(0);
    EXPECT_EQ(kept.numbers.size(), 2u * (40 + 13) * 6);  // 13 of 17 frames lie between two samples
    EXPECT_EQ(kept.numbers, again.numbers);
    EXPECT_EQ(kept.record.outcome.largest_distance, again.record.outcome.largest_distance);
    EXPECT_EQ(kept.record.a.effort.steps, again.record.a.effort.steps);
    EXPECT_EQ(kept.bounds.strips[0].maximum, again.bounds.strips[0].maximum);
    EXPECT_GT(kept.bounds.strips[0].count, 40) << "to the end";
}

TEST(FailedFilms, LeavesNoFrameOfAFailedSequence) {
    // many threads are still writing large pictures when the method fails
    const auto scene = scene_of("butterfly", {"system.integrator=\"taylor\"", "system.tolerance=1000",
                                              "scene.duration_s=2", "video.size=[1280, 720]", "video.format=\"png\""});
    for (int round = 0; round < 4; ++round) {
        const auto out = fresh_folder();
        EXPECT_EQ(error_of([&] { render(scene, {.out = out, .jobs = 32}); }).first, ExitCode::method_failed);
        EXPECT_EQ(files_in(out / "butterfly"),
                  (std::set<std::string>{"butterfly.failed.csv", "butterfly.failed.json"}));
    }
}

TEST(FailedFilms, RefusesFramesThatAreNotThereAndAPosterOutsideThem) {
    const auto out = fresh_folder();
    const auto scene = small_scene({"video.poster_s=0.25"});
    const auto expect_refused = [&](long first, long last, const std::string& expected) {
        EXPECT_EQ(error_of([&] { render(scene, {.out = out, .first = first, .last = last}); }),
                  std::pair(ExitCode::bad_input, expected));
    };
    expect_refused(60, 62, "--frames 60:62: butterfly has the frames 0 to 60; A:B must have 0 ≤ A < B ≤ 61");
    const std::string poster = "the poster of butterfly, poster_s = 0.25, is frame 30; ";
    expect_refused(0, 30, "--frames 0:30: " + poster + "--frames 0:31 includes it");
    expect_refused(31, 40, "--frames 31:40: " + poster + "--frames 30:40 includes it");
    EXPECT_TRUE(fs::is_empty(out));
    render(scene, {.out = out, .first = 30, .last = 31});
    EXPECT_TRUE(fs::exists(out / "butterfly/butterfly.poster.png"));
    render(scene, {.out = out, .pictures = false, .first = 0, .last = 30});  // no picture, no poster to miss
}

}  // namespace doppel::failed_films_test
