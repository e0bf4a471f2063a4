// Extreme and invalid requests to the real program.
#include "cli/sandbox.hpp"

#include <fmt/ranges.h>
#include <sys/resource.h>

#include <csignal>
#include <sstream>
#include <string>

namespace doppel::extremes_test {

using namespace test;

std::vector<std::string> set(std::initializer_list<const char*> values) {
    std::vector<std::string> line;
    for (const char* value : values) line.insert(line.end(), {"--set", value});
    return line;
}

/// A request and its exit code: 0 done, 2 rejected with the place of the error, 3 the method fails.
struct Request {
    int code;
    std::vector<std::string> line;
};

/// The exit code must be as expected, within the time limit, and without partial files.
void expect_answer(const std::string& command, const Request& requested) {
    const auto& request = requested.line;
    const auto folder = fresh_folder();
    const auto what = fmt::format("{}", fmt::join(request, " "));
    auto line = with({command, "butterfly", "--progress", "none"}, request);
    if (what.find("duration_s") == std::string::npos) line = with(line, {"--set", "scene.duration_s=0.05"});
    if (command == "render" && what.find("size") == std::string::npos) line = with(line, {"--size", "128x72"});
    const auto patience = [] {
        const rlimit little{10, 10};  // s of CPU time; measured 0.7 at most
        setrlimit(RLIMIT_CPU, &little);
    };
    const int code = wait_at_most(start(folder, line, patience), 120);
    const auto message = bytes_of(folder / "stderr");
    const auto made = listing(folder / "out");
    EXPECT_EQ(code, requested.code) << what << "\n" << message;
    for (const auto& name : made) EXPECT_FALSE(name.ends_with(".part") || name.ends_with(".lock")) << what << name;
    if (code == 0) {
        std::istringstream warnings(message);  // only that a step is too coarse, or the sides are the same
        for (std::string warning; std::getline(warnings, warning);)
            EXPECT_TRUE(warning.find("% of its range") != std::string::npos ||
                        warning.find("both sides are the same") != std::string::npos)
                << what << "\n"
                << message;
        EXPECT_TRUE(made.contains("butterfly/butterfly.csv")) << what;
        return;
    }
    EXPECT_TRUE(one_line(message)) << what << "\n" << message;
    const auto says = [&](const char* words) { return message.find(words) != std::string::npos; };
    const bool names_place =
        says("--set ") || says("--size ") || says("--frames ") || says("butterfly.toml") || says(": side ");
    EXPECT_TRUE(code == 3 || names_place) << what << "\n" << message;
    // the valid samples are kept
    EXPECT_EQ(made.contains("butterfly/butterfly.failed.csv"), says("the samples before are in")) << what << message;
    EXPECT_TRUE(says("the samples before are in") || made.empty()) << what << message;
}

TEST(Extremes, UnusualPicturesAreDrawnOrRefusedWithAPlace) {
    const std::vector<Request> requests{
        {0, {"--size", "64x64"}},
        {2, {"--size", "16384x2"}},
        {0, {"--size", "16384x64"}},
        {0, {"--size", "64x16384"}},
        {2, {"--size", "63x64"}},
        {2, {"--size", "65x65"}},
        {2, {"--size", "0x0"}},
        {2, {"--size", "-64x64"}},
        {2, {"--size", "99999999999x64"}},
        {2, {"--size", "1e3x64"}},
        {0, {"--frames", "5:6"}},
        {2, {"--frames", "9223372036854775806:9223372036854775807"}},
        {0, set({"video.panels=[\"distance\", \"energy\"]", "video.size=[64, 64]"})},
        {0, set({"scene.duration_s=\"1/120\""})},
        {0, set({"scene.sample_hz=1", "scene.duration_s=1"})},
        {0,
         set({"scene.sample_hz=\"30000/1001\"", "system.step_s=\"1001/30000000\"", "scene.duration_s=\"1001/3000\""})},
        {0, set({"video.fps=\"30000/1001\""})},
        {0, set({"video.fps=1e-3"})},
        {0, set({"video.fps=\"1/3\"", "scene.duration_s=3"})},
        {2, set({"video.speed=1e-9"})},
        {2, set({"video.speed=1e9"})},
        {0, set({"video.speed=0.5", "video.fps=60"})},
        {0, set({"video.distance_range=[1e-300, 1e-299]"})},
        {0, set({"video.energy_range=[1e299, 1e308]", "video.panels=[\"energy\"]"})},
        {0, set({"video.trail_s=3600"})},
        {0, set({"system.length_m=[1e-9, 1e9]", "system.integrator=\"taylor\""})},
        {2, set({"system.length_m=1e200"})},
        {0, set({"system.angle_deg=0", "b.angle_deg=0"})},
        {0, set({"system.angle_deg=180", "b.angle_deg=180"})},
    };
    for (const auto& request : requests) expect_answer("render", request);
}

TEST(Extremes, ExtremePhysicsIsSimulatedOrRefusedWithAPlace) {
    const std::vector<Request> requests{
        {0, set({"system.mass_kg=[1e300, 1e300]"})},
        {3, set({"system.mass_kg=[1e-300, 1e300]"})},
        {3, set({"system.mass_kg=[1e300, 1e-300]"})},
        {0, set({"system.mass_kg=1e-320"})},
        {2, set({"system.mass_kg=1e4000"})},
        {3, set({"system.length_m=1e-300"})},
        {3, set({"system.length_m=[1e-300, 1e300]"})},
        {2, set({"system.length_m=1e300"})},
        {3, set({"system.length_m=1e-4000", "system.precision=\"quad\""})},
        {2, set({"system.gravity_m_per_s2=0"})},
        {0, set({"system.gravity_m_per_s2=1e-300"})},
        {3, set({"system.gravity_m_per_s2=1e300"})},
        {2, set({"system.angle_deg=[1e300, -1e300]"})},
        {3, set({"system.omega_deg_per_s=1e300"})},
        {3, set({"system.omega_deg_per_s=[1e20, -1e20]"})},
        {3, set({"system.model=\"constraints\"", "system.length_m=1e-300"})},
        {2, set({"system.model=\"mechanism\"", "system.length_m=1e300"})},
        {2, set({"system.integrator=\"taylor\"", "system.tolerance=1e-300"})},
        {0, set({"system.integrator=\"taylor\"", "system.tolerance=1e300"})},
        {3, set({"system.integrator=\"rattle\"", "system.length_m=1e-150"})},
        {2, set({"system.links=1", "b.angle_deg=[90]"})},
        {2, set({"scene.duration_s=1e-300"})},
        {2, set({"scene.duration_s=\"1/9223372036854775807\""})},
        {0, set({"system.step_s=\"1/120\"", "scene.sample_hz=120", "scene.duration_s=2"})},
        {3, set({"a.mass_kg=[1e18, 1]", "b.mass_kg=[1, 1e18]"})},
    };
    for (const auto& request : requests) expect_answer("simulate", request);
}

TEST(Extremes, EndlessRunsStopOnRequest) {
    for (const auto& request : {set({"system.integrator=\"taylor\"", "system.omega_deg_per_s=1e12"}),
                                set({"scene.sample_hz=\"1/100000\"", "scene.duration_s=100000"}),
                                set({"system.accuracy=1e-9", "system.omega_deg_per_s=1e9"})}) {
        const auto folder = fresh_folder();
        const auto child = start(folder, with({"simulate", "butterfly", "--progress", "none"}, request));
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        kill(child, SIGINT);
        EXPECT_EQ(wait_at_most(child, 2), 130) << fmt::format("{}", fmt::join(request, " "));
        EXPECT_TRUE(listing(folder / "out").empty());
    }
}

}  // namespace doppel::extremes_test
