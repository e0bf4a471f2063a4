// Extreme and invalid requests to the real program.
#include "cli/process.hpp"

#include <fmt/ranges.h>
#include <sys/resource.h>

#include <csignal>
#include <string>

namespace doppel::extremes_test {

using namespace test;

/// A request and its exit code: 0 done, 2 rejected with the place of the error, 3 the method fails.
struct Request {
    int code;
    Words line;
};

/// The exit code must be as expected, within the time limit, and without partial files.
void expect_answer(const std::string& command, const Request& requested) {
    const auto& request = requested.line;
    const auto folder = fresh_folder();
    const auto what = fmt::format("{}", fmt::join(request, " "));
    auto line = with({command, "butterfly", "--progress", "none"}, request);
    if (what.find("duration_s") == std::string::npos) line = with(line, "--set scene.duration_s=0.05");
    if (command == "render" && what.find("size") == std::string::npos) line = with(line, "--size 128x72");
    const auto patience = [] {
        const rlimit little{10, 10};  // s of CPU time; measured 0.7 at most
        setrlimit(RLIMIT_CPU, &little);
    };
    const int code = wait_at_most(start(line, patience), 120);
    const auto message = bytes_of(folder / "stderr");
    const auto made = listing(folder / "out");
    EXPECT_EQ(code, requested.code) << what << "\n" << message;
    for (const auto& name : made) EXPECT_FALSE(name.ends_with(".part") || name.ends_with(".lock")) << what << name;
    if (code == 0) {
        for (const auto& warning : lines_of(message))  // only that a step is too coarse, or the sides are the same
            EXPECT_TRUE(has(warning, "% of its range") || has(warning, "both sides are the same")) << what << message;
        EXPECT_TRUE(made.contains("butterfly/butterfly.csv")) << what;
        return;
    }
    EXPECT_TRUE(one_line(message)) << what << "\n" << message;
    const auto says = [&](const char* words) { return bool(has(message, words)); };
    const bool names_place =
        says("--set ") || says("--size ") || says("--frames ") || says("butterfly.toml") || says(": side ");
    EXPECT_TRUE(code == 3 || names_place) << what << "\n" << message;
    // the valid samples are kept
    EXPECT_EQ(made.contains("butterfly/butterfly.failed.csv"), says("the samples before are in")) << what << message;
    EXPECT_TRUE(says("the samples before are in") || made.empty()) << what << message;
}

TEST(Extremes, UnusualPicturesAreDrawnOrRefusedWithAPlace) {
    const std::vector<Request> requests{
        {0, "--size 64x64"},
        {2, "--size 16384x2"},
        {0, "--size 16384x64"},
        {0, "--size 64x16384"},
        {2, "--size 63x64"},
        {2, "--size 65x65"},
        {2, "--size 0x0"},
        {2, "--size -64x64"},
        {2, "--size 99999999999x64"},
        {2, "--size 1e3x64"},
        {0, "--frames 5:6"},
        {2, "--frames 9223372036854775806:9223372036854775807"},
        {0, "--set video.panels=[\"distance\",\"energy\"] --set video.size=[64,64]"},
        {0, "--set scene.duration_s=1/120"},
        {0, "--set scene.sample_hz=1 --set scene.duration_s=1"},
        {0, "--set scene.sample_hz=30000/1001 --set system.step_s=1001/30000000 --set scene.duration_s=1001/3000"},
        {0, "--set video.fps=30000/1001"},
        {0, "--set video.fps=1e-3"},
        {0, "--set video.fps=1/3 --set scene.duration_s=3"},
        {2, "--set video.speed=1e-9"},
        {2, "--set video.speed=1e9"},
        {0, "--set video.speed=0.5 --set video.fps=60"},
        {0, "--set video.distance_range=[1e-300,1e-299]"},
        {0, "--set video.energy_range=[1e299,1e308] --set video.panels=[\"energy\"]"},
        {0, "--set video.trail_s=3600"},
        {0, "--set system.length_m=[1e-9,1e9] --set system.integrator=taylor"},
        {2, "--set system.length_m=1e200"},
        {0, "--set system.angle_deg=0 --set b.angle_deg=0"},
        {0, "--set system.angle_deg=180 --set b.angle_deg=180"},
    };
    for (const auto& request : requests) expect_answer("render", request);
}

TEST(Extremes, ExtremePhysicsIsSimulatedOrRefusedWithAPlace) {
    const std::vector<Request> requests{
        {0, "--set system.mass_kg=[1e300,1e300]"},
        {3, "--set system.mass_kg=[1e-300,1e300]"},
        {3, "--set system.mass_kg=[1e300,1e-300]"},
        {0, "--set system.mass_kg=1e-320"},
        {2, "--set system.mass_kg=1e4000"},
        {3, "--set system.length_m=1e-300"},
        {3, "--set system.length_m=[1e-300,1e300]"},
        {2, "--set system.length_m=1e300"},
        {3, "--set system.length_m=1e-4000 --set system.precision=quad"},
        {2, "--set system.gravity_m_per_s2=0"},
        {0, "--set system.gravity_m_per_s2=1e-300"},
        {3, "--set system.gravity_m_per_s2=1e300"},
        {2, "--set system.angle_deg=[1e300,-1e300]"},
        {3, "--set system.omega_deg_per_s=1e300"},
        {3, "--set system.omega_deg_per_s=[1e20,-1e20]"},
        {3, "--set system.model=constraints --set system.length_m=1e-300"},
        {2, "--set system.model=mechanism --set system.length_m=1e300"},
        {2, "--set system.integrator=taylor --set system.tolerance=1e-300"},
        {0, "--set system.integrator=taylor --set system.tolerance=1e300"},
        {3, "--set system.integrator=rattle --set system.length_m=1e-150"},
        {2, "--set system.links=1 --set b.angle_deg=[90]"},
        {2, "--set scene.duration_s=1e-300"},
        {2, "--set scene.duration_s=1/9223372036854775807"},
        {0, "--set system.step_s=1/120 --set scene.sample_hz=120 --set scene.duration_s=2"},
        {3, "--set a.mass_kg=[1e18,1] --set b.mass_kg=[1,1e18]"},
    };
    for (const auto& request : requests) expect_answer("simulate", request);
}

TEST(Extremes, EndlessRunsStopOnRequest) {
    for (const Words request : {"--set system.integrator=taylor --set system.omega_deg_per_s=1e12",
                                "--set scene.sample_hz=1/100000 --set scene.duration_s=100000",
                                "--set system.accuracy=1e-9 --set system.omega_deg_per_s=1e9"}) {
        const auto folder = fresh_folder();
        const auto child = start(with("simulate butterfly --progress none", request));
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        kill(child, SIGINT);
        EXPECT_EQ(wait_at_most(child, 2), 130) << fmt::format("{}", fmt::join(request, " "));
        EXPECT_TRUE(listing(folder / "out").empty());
    }
}

}  // namespace doppel::extremes_test
