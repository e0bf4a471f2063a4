#include "cli/process.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

namespace doppel::certify_test {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace test;
using Certify = ProgramTest;

const Words brief = "--set scene.duration_s=0.5 --progress none";

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

TEST_F(Certify, WritesBoundsThatContainAnAccurateRun) {
    const auto result = done(with("certify butterfly", brief));
    EXPECT_EQ(result.out.substr(0, result.out.find(' ')), "out/butterfly/butterfly.certified.csv");
    const auto table = bytes_of(folder / "out/butterfly/butterfly.certified.csv");
    EXPECT_TRUE(table.starts_with(
        "sample,time_s,a_theta1_rad_low,a_theta1_rad_high,a_theta2_rad_low,a_theta2_rad_high,a_omega1_rad_per_s_low,a_"
        "omega1_rad_per_s_high,a_omega2_rad_per_s_low,a_omega2_rad_per_s_high,b_theta1_rad_low,b_theta1_rad_high,b_"
        "theta2_rad_low,b_theta2_rad_high,b_omega1_rad_per_s_low,b_omega1_rad_per_s_high,b_omega2_rad_per_s_low,b_"
        "omega2_rad_per_s_high,distance_low,distance_high\r\n"));
    // the same pair in quad: angles, rates and distance
    done(
        with("simulate butterfly --set system.integrator=\"taylor\" --set system.tolerance=1e-28 --set "
             "system.precision=\"quad\" --columns "
             "time_s,a_theta1_rad,a_theta2_rad,a_omega1_rad_per_s,a_omega2_rad_per_s,distance",
             brief));
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

TEST_F(Certify, SaysWhenTheRunIsProvedToHaveLeftTheTrueMotion) {
    const auto result = done("certify butterfly --set scene.duration_s=3 --radius 1e-3 --progress plain");
    EXPECT_TRUE(has(result.err, "butterfly: the true motion is proved until 3 s in double: angles within "));
    const auto proof = json::parse(bytes_of(folder / "out/butterfly/butterfly.certified.json"))["certificate"];
    const double until = proof["a"]["run_proved_until_s"], beyond = proof["a"]["run_proved_beyond_s"];
    EXPECT_GT(until, 0.5);
    EXPECT_NEAR(beyond - until, 1.0 / 120, 1e-12);  // the bounds are so narrow that the next sample is beyond
}

TEST_F(Certify, HasTheSameBytesForAnyNumberOfThreadsAndOnStandardOutput) {
    for (const char* jobs : {"1", "2"}) done(with({"certify", "calm", "--jobs", jobs, "-o", jobs}, brief));
    const auto table = bytes_of(folder / "1/calm/calm.certified.csv");
    EXPECT_EQ(table, bytes_of(folder / "2/calm/calm.certified.csv"));
    EXPECT_EQ(doppel(with("certify calm -o -", brief)).out, table);
    EXPECT_EQ(doppel("certify calm --list-outputs").out, "out/calm/calm.certified.csv\nout/calm/calm.certified.json\n");
    // beside a film's own files
    done(with("simulate calm -o 1", brief));
    done(with("certify calm -o 1", brief));
}

TEST_F(Certify, RefusesWhatItCannotProve) {
    for (const auto& [name, found] : {std::pair("triple", "links = 3"),
                                      {"rods", "rod_mass_kg = ["},
                                      {"kapitza", "links = 1"},
                                      {"damped", "joint_"},
                                      {"springs", "a particle \""},
                                      {"measured", "track.file = \""}}) {
        const auto result =
            expect_refused(with({"certify", name}, "--progress none"), 2, ": a proof needs two ideal links: ");
        EXPECT_TRUE(begins(result.err, fmt::format("doppel: presets/{}.toml:", name)));
        EXPECT_TRUE(has(result.err, std::string("; the side has ") + found));
        EXPECT_FALSE(fs::exists(folder / "out" / name)) << name;
    }
}

TEST_F(Certify, EndsTheRowsWhereTheProofEnds) {
    // so fast that no step is short enough
    fresh_folder();  // empties it
    const auto result = ends(
        "certify butterfly --set 'system.omega_deg_per_s=[1e10, 0]' --set scene.duration_s=0.5 --progress plain", 3);
    EXPECT_TRUE(begins(result.err,
                       "butterfly: double does not suffice; again in quad\n"
                       "butterfly: quad does not suffice; again in 256 bits\n"
                       "butterfly: the true motion is proved until 0 s in 256 bits"));
    EXPECT_TRUE(result.err.ends_with("doppel: butterfly: nothing is proved after 0 s of 0.5 s; the rows end there\n"));
    EXPECT_EQ(rows_of(folder / "out/butterfly/butterfly.certified.csv").size(), 1u);
    const auto manifest = json::parse(bytes_of(folder / "out/butterfly/butterfly.certified.json"));
    EXPECT_EQ(manifest["certificate"]["to_the_end"], false);
}

TEST_F(Certify, TheKeyOfAPresetAddsTheProof) {
    const Words key = "--set scene.certify=true";
    done(with(with("certify calm", key), brief));
    done(with(with("simulate calm", key), brief));
    const auto manifest = json::parse(bytes_of(folder / "out/calm/calm.json"));
    EXPECT_EQ(manifest["certificate"]["a"]["run_proved_until_s"], 0.5);
    EXPECT_EQ(manifest["resolved_preset"]["scene"]["certify"], true);
    const auto check = doppel(with(with("check calm", key), "--set scene.duration_s=0.5"));
    EXPECT_TRUE(has(check.out, "  proof  side a: its run is proved within 0.5 rad of the true motion until 0.5 s\n"));
    EXPECT_EQ(doppel(with(with("simulate triple", key), brief)).code, 2);
    // a band in the strip, and its text
    const Words picture = "still calm --at 0.5 --size 320x180";
    done(with(with(picture, "-o plain"), brief));
    done(with(with(with(picture, "-o proved"), key), brief));
    EXPECT_NE(bytes_of(folder / "plain/calm/calm.0.5s.png"), bytes_of(folder / "proved/calm/calm.0.5s.png"));
}

}  // namespace doppel::certify_test
