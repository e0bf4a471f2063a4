#include "cli/sandbox.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

namespace doppel::certify_test {

namespace fs = std::filesystem;
using nlohmann::json;
using test::bytes_of;
using test::doppel;
using test::fresh_folder;
using test::with;
using Words = std::vector<std::string>;

const Words brief{"--set", "scene.duration_s=0.5", "--progress", "none"};

/// The rows of a table, without its header.
std::vector<std::vector<double>> rows_of(const fs::path& file) {
    std::istringstream text(bytes_of(file));
    std::string line;
    std::getline(text, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(text, line)) {
        auto& row = rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');)
            row.push_back(cell.empty() || cell == "\r" ? NAN : std::stod(cell));
    }
    return rows;
}

TEST(Certify, WritesBoundsThatContainAnAccurateRun) {
    const auto folder = fresh_folder();
    const auto result = doppel(folder, with({"certify", "butterfly"}, brief));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out.substr(0, result.out.find(' ')), "out/butterfly/butterfly.certified.csv");
    const auto table = bytes_of(folder / "out/butterfly/butterfly.certified.csv");
    EXPECT_TRUE(table.starts_with(
        "sample,time_s,a_theta1_rad_low,a_theta1_rad_high,a_theta2_rad_low,a_theta2_rad_high,a_omega1_rad_per_s_low,a_"
        "omega1_rad_per_s_high,a_omega2_rad_per_s_low,a_omega2_rad_per_s_high,b_theta1_rad_low,b_theta1_rad_high,b_"
        "theta2_rad_low,b_theta2_rad_high,b_omega1_rad_per_s_low,b_omega1_rad_per_s_high,b_omega2_rad_per_s_low,b_"
        "omega2_rad_per_s_high,distance_low,distance_high\r\n"));
    // the same pair in quad: angles, rates and distance
    ASSERT_EQ(doppel(folder, with({"simulate", "butterfly", "--set", "system.integrator=\"taylor\"", "--set",
                                   "system.tolerance=1e-28", "--set", "system.precision=\"quad\"", "--columns",
                                   "time_s,a_theta1_rad,a_theta2_rad,a_omega1_rad_per_s,a_omega2_rad_per_s,distance"},
                                  brief))
                  .code,
              0);
    const auto bounds = rows_of(folder / "out/butterfly/butterfly.certified.csv");
    const auto known = rows_of(folder / "out/butterfly/butterfly.csv");
    ASSERT_EQ(bounds.size(), 61u);
    ASSERT_EQ(known.size(), 61u);
    for (std::size_t n = 0; n < 61; ++n)
        for (std::size_t i = 0; i < 5; ++i) {
            const std::size_t low = i < 4 ? 2 + 2 * i : 18;
            EXPECT_LE(bounds[n][low], known[n][i + 1]) << n << ' ' << i;
            EXPECT_GE(bounds[n][low + 1], known[n][i + 1]) << n << ' ' << i;
            EXPECT_LT(bounds[n][low + 1] - bounds[n][low], 1e-11) << n << ' ' << i;
        }
    // the sentences, too, are bounds
    const std::string before = "angles within ";
    const double radius = std::stod(result.err.substr(result.err.find(before) + before.size()));
    double low = NAN, high = NAN;
    std::sscanf(result.err.substr(result.err.find("is between ")).c_str(), "is between %lf and %lf", &low, &high);
    EXPECT_LE(low, bounds.back()[18]) << result.err;
    EXPECT_GE(high, bounds.back()[19]) << result.err;
    for (const auto& row : bounds)
        for (const std::size_t i : {2, 4, 10, 12}) EXPECT_GE(radius, (row[i + 1] - row[i]) / 2);
    const auto manifest = json::parse(bytes_of(folder / "out/butterfly/butterfly.certified.json"));
    EXPECT_EQ(manifest["certificate"]["bits"], 53);
    EXPECT_EQ(manifest["certificate"]["to_the_end"], true);
    EXPECT_EQ(manifest["certificate"]["a"]["run_proved_until_s"], 0.5);
    EXPECT_EQ(manifest["certificate"]["a"]["run_proved_beyond_s"], nullptr);
    EXPECT_EQ(manifest["resolved_preset"]["scene"]["duration_s"], "1/2");
    EXPECT_TRUE(manifest["files"].contains("butterfly.certified.csv"));
}

TEST(Certify, SaysWhenTheRunIsProvedToHaveLeftTheTrueMotion) {
    const auto folder = fresh_folder();
    const auto result = doppel(
        folder, {"certify", "butterfly", "--set", "scene.duration_s=3", "--radius", "1e-3", "--progress", "plain"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("butterfly: the true motion is proved until 3 s in double: angles within "),
              std::string::npos)
        << result.err;
    const auto proof = json::parse(bytes_of(folder / "out/butterfly/butterfly.certified.json"))["certificate"];
    const double until = proof["a"]["run_proved_until_s"], beyond = proof["a"]["run_proved_beyond_s"];
    EXPECT_GT(until, 0.5);
    EXPECT_NEAR(beyond - until, 1.0 / 120, 1e-12);  // the bounds are so narrow that the next sample is beyond
}

TEST(Certify, HasTheSameBytesForAnyNumberOfThreadsAndOnStandardOutput) {
    const auto folder = fresh_folder();
    for (const char* jobs : {"1", "2"})
        ASSERT_EQ(doppel(folder, with({"certify", "calm", "--jobs", jobs, "-o", jobs}, brief)).code, 0);
    const auto table = bytes_of(folder / "1/calm/calm.certified.csv");
    EXPECT_EQ(table, bytes_of(folder / "2/calm/calm.certified.csv"));
    EXPECT_EQ(doppel(folder, with({"certify", "calm", "-o", "-"}, brief)).out, table);
    EXPECT_EQ(doppel(folder, {"certify", "calm", "--list-outputs"}).out,
              "out/calm/calm.certified.csv\nout/calm/calm.certified.json\n");
    // beside a film's own files
    EXPECT_EQ(doppel(folder, with({"simulate", "calm", "-o", "1"}, brief)).code, 0);
    EXPECT_EQ(doppel(folder, with({"certify", "calm", "-o", "1"}, brief)).code, 0);
}

TEST(Certify, RefusesWhatItCannotProve) {
    const auto folder = fresh_folder();
    for (const auto& [name, found] : {std::pair("triple", "links = 3"),
                                      {"rods", "rod_mass_kg = ["},
                                      {"kapitza", "links = 1"},
                                      {"damped", "joint_"},
                                      {"springs", "a particle \""},
                                      {"measured", "track.file = \""}}) {
        const auto result = doppel(folder, with({"certify", name}, {"--progress", "none"}));
        EXPECT_EQ(result.code, 2) << name;
        EXPECT_NE(result.err.find(": a proof needs two ideal links: "), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(std::string("; the side has ") + found), std::string::npos) << result.err;
        EXPECT_FALSE(fs::exists(folder / "out" / name)) << name;
    }
}

TEST(Certify, EndsTheRowsWhereTheProofEnds) {
    // so fast that no step is short enough
    const auto folder = fresh_folder();
    const auto result =
        doppel(folder, with({"certify", "butterfly", "--set", "system.omega_deg_per_s=[1e10, 0]"}, brief));
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(result.err.starts_with("butterfly: the true motion is proved until 0 s in 256 bits")) << result.err;
    EXPECT_TRUE(result.err.ends_with("doppel: butterfly: nothing is proved after 0 s of 0.5 s; the rows end there\n"));
    EXPECT_EQ(rows_of(folder / "out/butterfly/butterfly.certified.csv").size(), 1u);
    const auto manifest = json::parse(bytes_of(folder / "out/butterfly/butterfly.certified.json"));
    EXPECT_EQ(manifest["certificate"]["to_the_end"], false);
}

TEST(Certify, TheKeyOfAPresetAddsTheProof) {
    const auto folder = fresh_folder();
    const Words key{"--set", "scene.certify=true"};
    ASSERT_EQ(doppel(folder, with(with({"simulate", "calm"}, key), brief)).code, 0);
    const auto manifest = json::parse(bytes_of(folder / "out/calm/calm.json"));
    EXPECT_EQ(manifest["certificate"]["a"]["run_proved_until_s"], 0.5);
    EXPECT_EQ(manifest["resolved_preset"]["scene"]["certify"], true);
    const auto check = doppel(folder, with(with({"check", "calm"}, key), {"--set", "scene.duration_s=0.5"}));
    EXPECT_NE(check.out.find("  proof  side a: its run is proved within 0.5 rad of the true motion until 0.5 s\n"),
              std::string::npos)
        << check.out;
    EXPECT_EQ(doppel(folder, with(with({"simulate", "triple"}, key), brief)).code, 2);
    // a band in the strip, and its text
    const Words picture{"still", "calm", "--at", "0.5", "--size", "320x180"};
    ASSERT_EQ(doppel(folder, with(with(picture, {"-o", "plain"}), brief)).code, 0);
    ASSERT_EQ(doppel(folder, with(with(with(picture, {"-o", "proved"}), key), brief)).code, 0);
    EXPECT_NE(bytes_of(folder / "plain/calm/calm.0.5s.png"), bytes_of(folder / "proved/calm/calm.0.5s.png"));
}

}  // namespace doppel::certify_test
