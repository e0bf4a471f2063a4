#include "cli/process.hpp"
#include "scene/preset.hpp"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

namespace doppel::program_test {

namespace fs = std::filesystem;
using namespace test;
using Program = ProgramTest;

const Words tiny = "--set scene.duration_s=0.1 --size 160x90 --progress none";
/// A run whose method fails.
const Words fails =
    "--progress none --set system.step_s=1/3 --set scene.sample_hz=3 --set scene.duration_s=3000 "
    "--set system.model=constraints";

TEST_F(Program, RendersAPresetByNameAndByPath) {
    fs::create_directory(folder / "mine");
    std::ofstream(folder / "mine/two.toml") << bytes_of(fs::path(DOPPEL_SOURCE_DIR) / "presets/calm.toml");
    const auto result = done(with("render butterfly mine/two.toml", tiny));
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(has(result.out, "out/butterfly/butterfly.mp4"));
    for (const char* file :
         {"butterfly/butterfly.mp4", "butterfly/butterfly.csv", "butterfly/butterfly.json", "two/two.mp4"})
        EXPECT_TRUE(fs::exists(folder / "out" / file)) << file;
}

TEST_F(Program, SimulatesWithoutPictures) {
    done("simulate calm -o data");
    EXPECT_TRUE(fs::exists(folder / "data/calm/calm.csv"));
    EXPECT_FALSE(fs::exists(folder / "data/calm/calm.mp4"));
    done("simulate calm --columns 'time_s, distance'");
    EXPECT_TRUE(bytes_of(folder / "out/calm/calm.csv").starts_with("time_s,distance\r\n0,"));
    expect_refused("render calm --columns=time -o none", 2, "doppel: --columns: the table of calm has no \"time\"; ");
    EXPECT_FALSE(fs::exists(folder / "none"));
}

/// A start that the command line gives, whole or in part, is not fitted.
TEST_F(Program, StartsBesideATrackAsGiven) {
    for (const char* given : {"--set 'b.angle_deg=[91, 90]'", "--set b.angle_deg[0]=91"}) {
        const Words beside = "--beside data/double-pendulum-track/piece-00.csv --set scene.duration_s=0.1";
        done(with(with("simulate butterfly", beside), given));
        const auto run = nlohmann::json::parse(bytes_of(folder / "out/butterfly/butterfly.json"));
        EXPECT_EQ(run["resolved_preset"]["b"]["angle_deg"], (std::vector<int>{91, 90}));
    }
}

TEST_F(Program, NotesAGapOfTheTrackAtWhichARunEnds) {
    std::string track = "time_s,theta1_rad,theta2_rad\n";
    for (int k = 0; k <= 200; ++k)
        if (const auto t = std::to_string(0.01 * k); k <= 100 || k >= 150) track += t + "," + t + ",-" + t + "\n";
    write_bytes(folder / "track.csv", track);
    const Words words = "simulate butterfly --beside track.csv --progress plain --set 'b.angle_deg=[0, 0]'";
    const auto gap = done(words);
    EXPECT_TRUE(has(gap.err,
                    "butterfly: side a: the run ends at a gap of the track, from 1 to 1.5 s; the rest: --set "
                    "a.track.start_s=1.5\n"));
    for (const char* more : {"--set a.track.start_s=1.5", "--set scene.duration_s=0.5"})
        EXPECT_FALSE(has(done(with(words, more)).err, "gap"));
}

TEST_F(Program, ListsAndChecks) {
    EXPECT_TRUE(has(doppel("list").out, "butterfly          Three thousandths of a degree\n"));
    const auto check = done("check butterfly");
    EXPECT_TRUE(
        has(check.out, {"angles, explicit Euler, 1/30 000 s, 250 steps a sample", "the smallest model",
                        "samples 0 to 3600 at 120 Hz, 1 800 000 steps in all", "3601 frames of 1920×1080", "to render",
                        "error above half a rad from 1", "chaotic: errors grow tenfold every 2.", "double: about 3"}));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Program, AnAccuracyIsChosenByExplainedAndRecorded) {
    Words arguments = "check calm --set system.accuracy=1e-6 --set scene.duration_s=10 --set 'video.size=[64, 64]'";
    const auto check = done(arguments);
    EXPECT_TRUE(
        has(check.out,
            {"Taylor series, tolerance ", "smallest model; fastest method: taylor",
             "rad to the end; verified by Taylor series in quad", "regular: the Lyapunov exponent is not above 0",
             "half the accuracy, 2.0 × 10⁻⁶ rad, takes ", "ten times the accuracy, 1.0 × 10⁻⁷ rad, takes 1."}));

    arguments.front() = "simulate";
    done(arguments);
    const auto manifest = nlohmann::json::parse(bytes_of(folder / "out/calm/calm.json"));
    const auto& choice = manifest["a"]["accuracy"];
    EXPECT_EQ(manifest["a"]["integrator"], "taylor");
    EXPECT_EQ(choice["asked_rad"], 1e-6);
    EXPECT_EQ(choice["holds_to_the_end"], true);
    EXPECT_EQ(choice["horizon_s"], 10);
    EXPECT_LE(choice["estimated_error_rad"], 1e-6);
    EXPECT_EQ(manifest["resolved_preset"]["a"]["accuracy"], 1e-6);

    arguments[3] = "system.accuracy=1e-18";
    expect_refused(arguments, 2, "accuracy = 1e-18 rad is beyond double here");
}

TEST_F(Program, ExitsWith2OnBadUsageAndWritesNothing) {
    write_bytes(folder / "bad.toml", "[scene]\nkind = \"grid\"\n[grid.x]\nstep = 0\n");
    const std::vector<std::pair<Words, std::string>> cases{
        {{}, "A subcommand is required"},
        {"--nonsense", "there is no option \"--nonsense\" before a command; there are --help and --version"},
        {"--force render butterfly", "there is no option \"--force\" before a command"},
        {"rendr butterfly", "there is no command \"rendr\"; did you mean \"render\"?"},
        {"render", "PRESET is required"},
        {"render nonesuch", "there is no preset \"nonesuch\""},
        {"render butterfly --size 641x360", "--size 641x360: [video] size must be even"},
        {"render butterfly --size wide", "--size must be WIDTHxHEIGHT, such as 1280x720; it is \"wide\""},
        {"render butterfly --frames 9:3", "--frames must be A:B"},
        {"render butterfly --format avi", "--format"},
        {"render butterfly --quality best --set video.crf=3",
         "video.crf is given twice: --set video.crf and --quality best"},
        {"render butterfly --format gif --quality best",
         "--quality best: [video] preset is of mp4 and webm; the format is \"gif\""},
        {"render butterfly --format png --set video.crf=3",
         "--set video.crf: [video] crf is of mp4 and webm; the format is \"png\""},
        {"render butterfly butterfly", "butterfly and butterfly would both be written to butterfly/"},
        {"render butterfly --set 'system.mass_kg=[1, 0]'",
         "--set system.mass_kg: [system] mass_kg[1] must be > 0; it is 0"},
        {"check butterfly --set system.lenght_m=1", "did you mean \"length_m\"?"},
        {"check fig6 --quality draft", "--quality is for films, and not for figures"},
        {"compare nothing.png stdout", "nothing.png: there is no such file or folder"},
        {"check bad", "there is no preset \"bad\"; did you mean bad.toml?"},
        {"render calm --bogus", "--bogus; see doppel render --help"},
        {"figure", "PRESET is required"},
        {"figure fig2-rihgt", "there is no preset \"fig2-rihgt\"; did you mean \"fig2-right\"?"},
        {"figure butterfly", "doppel render butterfly"},
        {"render fig2-right", "doppel figure fig2-right"},
        {"simulate fig2-right", "doppel figure fig2-right"},
        {"figure bad.toml", "bad.toml:4:1: [grid.x] step must be > 0; it is 0"},
        {"figure fig6 fig6", "would both be written to fig6/"},
        {"figure all fig6", "would both be written to fig6/"},
        {"figure fig6 --shard 0/3", "--shard must be I/N"},
        {"figure fig6 --shard 4/3", "\"4/3\""},
        {"figure fig6 --shard x", "\"x\""},
        {"figure fig6 --shard 1/0", "\"1/0\""},
        {"figure fig6 --shard -1/2", "--shard"},
        {"figure fig6 --shard 1/2/3", "\"1/2/3\""},
        {"figure fig6 --shard 1.0/2", "\"1.0/2\""},
        {"figure fig6 --shard 1/9999999999999999999", "--shard"},
        {"figure fig6 --shard 1/2 --merge", "--shard makes a shard and --merge joins them"},
        {"figure fig6 --size wide", "--size must be WIDTHxHEIGHT"},
        {"figure fig6 --scale 0", "--scale"},
        {"figure fig6 --scale 2 --set chart.scale=3", "chart.scale is given twice"},
        {"figure fig6 --jobs 0", "--jobs"},
        {"figure poincare --set system.integrator=\"rk4\"", "[system] has no \"integrator\""},
        // only one file can go to standard output
        {"simulate calm triple -o -", "standard output takes one file; give one preset, not 2"},
        {"render calm --format png -o -", "a PNG sequence is many files; give --format apng"},
        {"figure flip-map --tiles --format html", "--format html: is for a picture; --tiles writes PNGs"},
        {"figure flip-map --tiles --format png", "--format png: is for a picture; --tiles writes PNGs"},
        {"figure flip-map --tiles --format pdf", "--format pdf: is for a picture; --tiles writes PNGs"},
        {"figure flip-map --tiles --size 800x450 --list-outputs", "--size 800x450: is for a picture"},
        {"figure flip-map --tiles --set chart.width_cm=8", "--set chart.width_cm: is for a picture"},
        {"figure flip-map --tiles -o -", "standard output takes one picture, and no tiles"},
        {"figure flip-map --merge -o -", "no merge of parts in a folder"},
        {"figure flip-map --shard 1/2 -o -", "no part for a merge"},
        {"fit swing.csv -o -", "--out: cannot be standard output here; give a name"},
        {"simulate calm -o a --out b", "--out: At Most 1 required but received 2; see"},
    };
    for (const auto& [arguments, words] : cases) {
        EXPECT_EQ(expect_refused(arguments, 2, words).out, "");
    }
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Program, FramesThatALaterPresetLacksAreToldBeforeTheFirstRuns) {
    write_bytes(folder / "long.toml", "[scene]\nduration_s = 2\n");
    write_bytes(folder / "short.toml", "[scene]\nduration_s = 1\n");
    write_bytes(folder / "rare.toml", "[scene]\nduration_s = 2\n[video]\nfps = 1\n");
    expect_refused("render long.toml short.toml --frames 130:140", 2,
                   "doppel: --frames 130:140: short has the frames 0 to 120; A:B must have 0 ≤ A < B ≤ 121\n");
    expect_refused("render long.toml rare.toml --frames 130:140", 2,
                   "doppel: --frames 130:140: rare has the frames 0 to 2; A:B must have 0 ≤ A < B ≤ 3\n");
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Program, TheLongestNameLeavesRoomForEveryEnding) {
    const std::string name(longest_preset_name, 'n');
    write_bytes(folder / (name + ".toml"), "title = \"long\"\n[scene]\nduration_s = 0.1\n");
    const Words pictures = "--size 64x64 --progress none --set video.poster_s=0.1 --set 'video.contact_sheet=[2, 2]'";
    for (const char* format : {"mp4", "gif", "png"})
        done(with({"render", name + ".toml", "--format", format}, pictures));
    EXPECT_EQ(doppel(with({"simulate", name + ".toml"}, fails)).code, 3);
    write_bytes(folder / (name + ".toml"),
                "title = \"long\"\n[scene]\nkind = \"grid\"\nduration_s = 0.1\n[grid]\ndifference = 0.01\n");
    for (const auto& shard : {std::vector<std::string>{"--shard", "100000/100000"}, {}})
        done(with({"figure", name + ".toml", "--progress", "none", "--out", "figures"}, shard));
}

TEST_F(Program, AnEstimateIsNearWhatRenderingTakesAndLeavesNothing) {
    const auto temporary = folder / "temporary";
    fs::create_directory(temporary);
    for (const char* format : {"gif", "webm", "apng"}) {
        const Words film =
            fmt::format("fan --set video.format={} --set video.size=[320,180] --set scene.duration_s=0.5", format);
        const auto said = done(with("check", film), [&] { setenv("TMPDIR", temporary.c_str(), 1); });
        const auto start = std::chrono::steady_clock::now();
        done(with(with("render", film), "--progress none"));
        const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const auto words = said.out.substr(said.out.find("to simulate, ") + 13);
        // measured 1.1 to 1.3; the load of the machine may change
        EXPECT_GT(std::stod(words), taken / 6) << format << " " << taken << " s\n" << said.out;
        EXPECT_LT(std::stod(words), taken * 6) << format << " " << taken << " s\n" << said.out;
    }
    EXPECT_TRUE(fs::is_empty(temporary));
}

TEST_F(Program, ACheckEndsHoweverManyStepsThereAre) {
    const auto check = [&](const Words& sets, const char* words) {
        const auto start = std::chrono::steady_clock::now();
        EXPECT_TRUE(has(done(with("check butterfly", sets)).out, words));
        // measured 0.1 s, and 2.1 s where even a shortened sample is not finished
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    };
    check("--set system.step_s=1/1200000000000", "72 000 000 000 000 steps in all");
    check("--set scene.sample_hz=1/100000 --set scene.duration_s=100000", "6 000 000 000 steps in all");
    check("--set system.integrator=taylor --set scene.sample_hz=1/100000 --set scene.duration_s=100000", "about ");
    const Words endless = "--set system.integrator=taylor --set system.omega_deg_per_s=1e13";
    check(endless, "more than ");

    const auto child = start(with("check butterfly", endless));
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    kill(child, SIGINT);
    EXPECT_EQ(wait_for(child), 130);
}

TEST_F(Program, ExitsWith3WhereTheMethodFails) {
    const auto result =
        expect_refused(with("simulate butterfly", fails), 3, "doppel: butterfly: side a failed by t = ");
    EXPECT_TRUE(has(result.err, {"step_s = \"1/", "the samples before are in out/butterfly/butterfly.failed.csv"}));
    EXPECT_TRUE(fs::exists(folder / "out/butterfly/butterfly.failed.json"));
    EXPECT_FALSE(fs::exists(folder / "out/butterfly/butterfly.csv"));
}

TEST_F(Program, ListsItsMethods) {
    EXPECT_TRUE(has(done("list methods").out, {"euler                    1  step_s     angles, constraints, mechanism",
                                               "taylor                 any  tolerance",
                                               "rattle6                  6  step_s     constraints, mechanism"}));
}

TEST_F(Program, ExitsWith4WhereNothingCanBeWritten) {
    std::ofstream(folder / "taken") << "a file";
    expect_refused(with("render butterfly -o taken", tiny), 4, "taken");

    fs::create_directories(folder / "out/butterfly/butterfly.csv");
    expect_refused(with("render butterfly", tiny), 4, "butterfly.csv is a folder");
    EXPECT_FALSE(fs::exists(folder / "out/butterfly/butterfly.mp4"));

    // a folder where nobody can write, not even root
    expect_refused(with("render butterfly -o /proc", tiny), 4, "doppel: /proc/butterfly: the folder cannot be made: ");
}

TEST_F(Program, ExitsWith4OnAFullDiskAndLeavesNothing) {
    for (const char* format : {"mp4", "png"}) {
        fresh_folder();  // empties it
        expect_refused({"render", "butterfly", "--size", "640x360", "--progress", "none", "--set", "scene.duration_s=2",
                        "--format", format},
                       4, "doppel: out/butterfly", [] {
                           const rlimit small{20'000, 20'000};
                           setrlimit(RLIMIT_FSIZE, &small);
                       });
        EXPECT_TRUE(left_nothing()) << format;
    }
}

TEST_F(Program, ExitsWith4WhereOpenGLIsTooOld) {
    expect_refused(with("render butterfly", tiny), 4, "OpenGL 3.3",
                   [] { setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1); });
    EXPECT_TRUE(left_nothing());
}

TEST_F(Program, WarningsAreNoProgress) {
    for (const std::string style : {"none", "plain", "json"}) {
        const Words coarse = "simulate butterfly --set system.integrator=euler --set system.step_s=1/1200 --progress";
        const auto result = done(with(coarse, style));
        const auto& told = style == "json" ? result.out : result.err;
        EXPECT_TRUE(has(told, "the energy of side a changed by ")) << style << ": ";
        EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), style == "none" ? 4 : 5) << style << ": " << told;
    }
}

TEST_F(Program, ReportsProgressForPeopleAndPrograms) {
    const auto last_event = [&](const std::string& command) {
        const auto json = doppel(command + " --set scene.duration_s=1 --progress json");
        EXPECT_EQ(json.err, "");
        return nlohmann::json::parse(lines_of(json.out).back());
    };
    const auto event = last_event("render butterfly --size 160x90");
    EXPECT_EQ(event["event"], "done");
    EXPECT_EQ(event["done"], 121);
    EXPECT_EQ(event["files"].size(), 3u);
    EXPECT_EQ(last_event("simulate butterfly --recording b.motion")["files"].back(), "b.motion");
    const auto plain = doppel("render butterfly --size 160x90 --set scene.duration_s=1");
    EXPECT_TRUE(has(plain.err, "butterfly: 121 frames in "));
    EXPECT_FALSE(has(plain.err, "\r")) << "no bar where there is no terminal";
}

}  // namespace doppel::program_test
