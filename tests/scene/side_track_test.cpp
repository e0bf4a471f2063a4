// A side that shows a measured motion, from a preset to a scene.
#include "base/text.hpp"
#include "scene/captions.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace doppel::side_track_test {

namespace fs = std::filesystem;

constexpr std::string_view built_in =
    "[scene]\nduration_s = 2\n[a.track]\nfile = \"data/double-pendulum-track/piece-00.csv\"\n";

Preset with_track(const std::string& more = "") {
    return preset_from(std::string(built_in) + more);
}

TEST(SideTrack, IsShownInPlaceOfASimulation) {
    const auto scene = make_scene(with_track());
    PairRun run(scene);
    const auto start = run.next(never);
    EXPECT_NEAR(start.a.bobs[0].theta, -0.525818, 1e-4);  // the file's first row
    EXPECT_NEAR(start.a.bobs[1].theta, 0.399823, 1e-4);
    EXPECT_FALSE(start.a.energy_error);
    EXPECT_TRUE(start.b.energy_error);
    for (int k = 0; k < 240; ++k) run.next(never);
    EXPECT_EQ(run.effort_a().steps, 0);
    EXPECT_GT(run.effort_b().steps, 0);
}

TEST(SideTrack, BeginsAtItsTime) {
    const auto scene = make_scene(with_track("start_s = 0.5\noffset_deg = [1, 0]\n"));
    const auto later = SideRun(scene, scene.a, 'a').next(never);
    auto from_start = make_scene(with_track());
    SideRun run(from_start, from_start.a, 'a');
    Observation same;
    for (int k = 0; k <= 60; ++k) same = run.next(never);
    EXPECT_NEAR(later.bobs[0].theta, same.bobs[0].theta - std::acos(-1.0) / 180, 1e-12);
    EXPECT_NEAR(later.bobs[1].theta, same.bobs[1].theta, 1e-12);
}

TEST(SideTrack, IsFoundBesideThePresetOrInTheCurrentFolder) {
    const auto folder = fs::path(DOPPEL_TEST_OUTPUT) / "side-track";
    fs::create_directories(folder);
    fs::copy_file(fs::path(DOPPEL_SOURCE_DIR) / "presets/data/double-pendulum-track/piece-02.csv", folder / "mine.csv",
                  fs::copy_options::overwrite_existing);
    const std::string text = "[scene]\nduration_s = 2\n[b.track]\nfile = \"mine.csv\"";
    const auto beside = preset_from(text, {}, (folder / "x.toml").string());
    EXPECT_EQ(beside.b.track.file, (folder / "mine.csv").string());
    const Override option{"b.track.file", toml_text((folder / "mine.csv").string()), "--set b.track.file"};
    const auto here = read_preset({"x", "nowhere/x.toml", text}, {option});
    EXPECT_EQ(here.b.track.sha256, beside.b.track.sha256);
    EXPECT_EQ(with_track().a.track.file, "data/double-pendulum-track/piece-00.csv");  // built in
}

TEST(SideTrack, CaptionsTellWhichIsMeasured) {
    const auto scene = make_scene(with_track());
    const auto words = side_captions(scene);
    EXPECT_EQ(words[0].heading, "measured");
    EXPECT_EQ(words[0].note, "piece-00.csv, 500 Hz");
    EXPECT_EQ(words[1].heading, "computed");
    EXPECT_EQ(words[1].note, "angles, explicit Euler, 1/30 000 s");
    EXPECT_EQ(scene_caption(scene), "a real double pendulum and its simulation");
    EXPECT_EQ(scene.preset.video.strips[0], StripKind::distance);
}

/// "measured": the residual of the fit for this piece is 0.6 mrad rms in the first 2 s (docs/fit.md).
TEST(SideTrack, TheSimulationStaysCloseToTheTrack) {
    const auto scene = scene_of("measured");
    PairRun run(scene);
    double worst = 0, squares = 0;
    for (long k = 0; k <= scene.samples; ++k) {
        const auto now = run.next(never);
        for (std::size_t i = 0; i < 2; ++i) {
            const double error = now.a.bobs[i].theta - now.b.bobs[i].theta;
            worst = std::max(worst, std::abs(error));
            squares += error * error;
        }
    }
    EXPECT_LT(worst, 5e-3);                                                              // measured 3.7e-3 rad
    EXPECT_LT(std::sqrt(squares / 2 / static_cast<double>(scene.samples + 1)), 1.5e-3);  // measured 1.0e-3 rad
}

TEST(SideTrack, RefusalsSayWhatWouldBeRight) {
    const std::string track(built_in), preset_file = DOPPEL_SOURCE_DIR "/presets/butterfly.toml";
    const std::vector<std::pair<std::string, std::string>> refused{
        {"[a.track]\nfile = \"gone.csv\"", "x.toml:2:1: [a.track] file gone.csv: there is no such file"},
        {"[a.track]\nfile = \"/\"", "x.toml:2:1: [a.track] file / is a folder; a track is a CSV file"},
        {"[a.track]\nfile = \"/dev/zero\"",
         "x.toml:2:1: [a.track] file /dev/zero is not a file; a track is a CSV file"},
        // the line, but none of the file's text: a preset from somebody else may name any file
        {"[a.track]\nfile = \"" + preset_file + "\"",
         "x.toml:2:1: [a.track] file " + preset_file +
             ":1: there is no column time_s; columns are named as here, in small letters"},
        {"[system]\nlinks = 3\n" + track.substr(track.find("[a.track]")),
         "x.toml:4:1: [a.track] file is of two links; the side has 3 links"},
        {track + "start_s = 3",
         "x.toml:5:1: [a.track] start_s is 3 s, without a sample there: the track goes from 0 to 2.666 s"},
        {"[a.track]\noffset_deg = [1, 0]",
         "x.toml:2:1: [a.track] offset_deg is of a measured motion; give the file of one"},
        {track + "start_s = 1",
         "x: [scene] duration_s must be at most \"199/120\" (1.658 s), as long as the track of side a lasts; it is 2"},
        {track + "[video]\npanels = [\"pendulums\", \"rod-force\"]",
         "x: [video] panels: \"rod-force\" needs massless rods; links with mass, friction or a drive, and tracks, have "
         "no rod tension"},
        {track + "[video]\nlayout = \"ensemble\"",
         "x.toml:6:1: [video] layout \"ensemble\" needs two simulations; a side shows a track"}};
    for (const auto& [text, message] : refused) expect_refused(text, message);
    for (const std::string key : {"angle_deg[1]", "accuracy", "angle_deg"})
        EXPECT_EQ(refusal([&] { scene_of("measured", {"a." + key + "=0.1"}); }),
                  "--set a." + key + ": [a] " + key + " has no effect, because the side shows a measured track");
}

/// An ensemble interpolates the numbers of friction and drives from side a to side b, like those of the chain.
TEST(Ensemble, GoesFromFrictionToFriction) {
    const auto scene = scene_from(
        "[a]\njoint_viscous_N_m_s = [0, 0.25]\n[b]\njoint_viscous_N_m_s = [0.5, 0.75]\n[b.pivot]\namplitude_m = 1\n"
        "[video]\nlayout = \"ensemble\"\nmembers = 5");
    ASSERT_EQ(scene.members.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k) {
        const auto& member = *scene.members[k].physical;
        EXPECT_EQ(member.friction.viscous[0], Quad(k) / 8);
        EXPECT_EQ(member.friction.viscous[1], Quad(1) / 4 + Quad(k) / 8);
        EXPECT_EQ(member.pivot.y, Quad(k) / 4);
    }
    EXPECT_EQ(refusal([] { preset_from("[a]\ncenter_m = 0.5\n[video]\nlayout = \"ensemble\"\nmembers = 5"); }),
              "x.toml:4:1: [video] layout \"ensemble\" needs sides that differ only in numbers of the "
              "system, not in center_m");
}

}  // namespace doppel::side_track_test
