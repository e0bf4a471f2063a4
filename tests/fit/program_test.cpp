#include "cli/process.hpp"
#include "fit/support.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <sstream>

namespace doppel::program_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::fresh_folder;

const fs::path data = fs::path(DOPPEL_SOURCE_DIR) / "presets/data/double-pendulum-track";

test::Outcome fit(const std::vector<fs::path>& files, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"fit"};
    for (const auto& file : files) words.push_back(file.string());
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"--progress", "none"});
    return test::doppel(words);
}

const std::vector<fs::path> lab{data / "piece-00.csv", data / "piece-02.csv", data / "piece-04.csv"};

/// Writes the pieces of a track as files.
std::vector<fs::path> files_of(const fs::path& folder, const Track& track) {
    std::vector<fs::path> files;
    for (const auto& piece : track.pieces) {
        files.push_back(fmt::format("p{}.csv", files.size()));
        test::write_bytes(folder / files.back(), test::csv_of(piece));
    }
    return files;
}

/// The columns of a table of numbers.
std::map<std::string, std::vector<double>> columns_of(const fs::path& file) {
    std::istringstream table(bytes_of(file));
    std::string line, cell;
    std::getline(table, line);
    std::vector<std::string> names;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
    std::map<std::string, std::vector<double>> columns;
    while (std::getline(table, line)) {
        auto name = names.begin();
        for (std::istringstream cells(line); std::getline(cells, cell, ',');)
            columns[*name++].push_back(cell.empty() ? NAN : std::stod(cell));
    }
    return columns;
}

double worst_difference(const std::vector<double>& one, const std::vector<double>& other) {
    EXPECT_LE(one.size(), other.size());
    double worst = one.empty() ? NAN : 0;
    for (std::size_t i = 0; i < one.size(); ++i) worst = std::max(worst, std::abs(one[i] - other.at(i)));
    return worst;
}

/// The maximum difference, rad, between the angles of a preset's run and the first piece of the track it was fitted to.
double worst_of_preset(const fs::path& folder, const std::string& name, const TrackPiece& piece, const char* hz) {
    const auto run = test::doppel({"simulate", fmt::format("out/{0}/{0}.toml", name), "--set", "scene.duration_s=2",
                                   "--set", fmt::format("scene.sample_hz={}", hz), "--columns",
                                   "a_theta1_rad,a_theta2_rad", "--progress", "none", "-o", "runs"});
    EXPECT_EQ(run.code, 0) << run.err;
    auto columns = columns_of(folder / fmt::format("runs/{0}/{0}.csv", name));
    return std::max(worst_difference(columns["a_theta1_rad"], piece.angle[0]),
                    worst_difference(columns["a_theta2_rad"], piece.angle[1]));
}

/// The real pendulum: the statements of README and docs/fit.md.
TEST(FitProgram, FitsARealPendulum) {
    const auto folder = fresh_folder();
    const auto result = fit(lab, {"--name", "lab"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* ending : {".toml", ".fit.json", ".residuals.csv", ".png"})
        EXPECT_NE(result.out.find("out/lab/lab" + std::string(ending)), std::string::npos) << result.out;
    const auto json = nlohmann::json::parse(bytes_of(folder / "out/lab/lab.fit.json"));
    const auto& model = json["model"];
    EXPECT_NE(bytes_of(folder / "out/lab/lab.toml").find("\ntitle = \"lab, as fitted\"\n"), std::string::npos);
    EXPECT_EQ(model["name"], "rigid bodies, viscous, Coulomb, drag by relative velocity");
    EXPECT_LT(model["left_out_rms_rad"].get<double>(), 0.0007);  // measured 0.00046
    const auto ratio = [&](const char* key) { return model["ratios_to_B"][key]["value"].get<double>(); };
    EXPECT_NEAR(ratio("inertia_ratio"), 1.795, 0.02);  // published
    EXPECT_NEAR(ratio("coupling_ratio"), 0.882, 0.01);
    EXPECT_NEAR(ratio("gravity_1_per_s2"), 105.8, 1);
    EXPECT_NEAR(ratio("gravity_2_per_s2"), 50.1, 0.5);
    EXPECT_NEAR(json["pendulum"]["length_m"][0].get<double>(), 0.1727, 0.002);  // measured 0.1730
    EXPECT_FALSE(json["residuals"]["like_noise"].get<bool>());
    EXPECT_NEAR(json["track"]["period"]["seconds"].get<double>(), 5.334, 0.005);
    EXPECT_EQ(json["models"].size(), 9u);
    EXPECT_EQ(read_png(folder / "out/lab/lab.png").size, (Size{1600, 1300}));
    // the preset, with bodies, Coulomb friction and drag by relative velocity, follows the track
    EXPECT_LT(worst_of_preset(folder, "lab", read_tracks(lab).pieces[0], "500"), 0.02);  // measured 6.0e-3
}

TEST(FitProgram, OmittedDataIsReportedAsANote) {
    const auto folder = fresh_folder();
    auto track = read_tracks({lab[0]});
    track.pieces[0].angle[0][500] += 5;
    const auto result = fit(files_of(folder, track), {"--model", "point"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "p0: 1 of 2668 angles are outliers, and were left out\n");
}

/// Pieces that were not fitted: two seconds determine the start, the rest is predicted.
TEST(FitProgram, ItsPresetRunsBesideATrack) {
    const auto folder = fresh_folder();
    ASSERT_EQ(fit({data / "piece-00.csv", data / "piece-02.csv"}, {"--name", "lab"}).code, 0);
    const auto beside = [&](const std::string& track, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"simulate", "out/lab/lab.toml", "--beside", track, "--progress", "none"};
        words.insert(words.end(), more.begin(), more.end());
        return test::doppel(words);
    };
    const auto left_out = (data / "piece-04.csv").string();
    const auto result = beside(left_out);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(fs::exists(folder / "out/lab/lab.residuals.csv"));
    EXPECT_TRUE(
        nlohmann::json::parse(bytes_of(folder / "out/lab/lab.fit.json")).contains("models"));  // still the fit's file
    auto columns = columns_of(folder / "out/lab/lab.csv");
    for (const char* theta : {"theta1_rad", "theta2_rad"})  // measured 2.2e-3 rad
        EXPECT_LT(worst_difference(columns[fmt::format("a_{}", theta)], columns[fmt::format("b_{}", theta)]), 5e-3);
    EXPECT_NEAR(columns["time_s"].back(), 319 / 120.0, 1e-9);  // as long as the track
    const auto json = nlohmann::json::parse(bytes_of(folder / "out/lab/lab.json"));
    EXPECT_EQ(json["a"]["measured"]["file"], left_out);
    EXPECT_EQ(json["a"]["measured"]["samples"], 1334);
    EXPECT_EQ(json["resolved_preset"]["b"]["note"].get<std::string>().substr(0, 28), "start fitted to 2 s, within ");

    ASSERT_EQ(beside(left_out, {"--set", "scene.duration_s=1", "--set", "a.track.start_s=0.5"}).code, 0);
    EXPECT_EQ(columns_of(folder / "out/lab/lab.csv")["time_s"].back(), 1);

    const auto gone = beside("gone.csv");
    EXPECT_EQ(gone.code, 2);
    EXPECT_EQ(gone.err, "doppel: --beside gone.csv (a.track.file): [a.track] file gone.csv: there is no such file\n");
}

/// Files of other origin are not replaced; its own files are.
TEST(FitProgram, WritesTheSameBytesForAnyNumberOfThreads) {
    const auto folder = fresh_folder(), preset = folder / "out/lab/lab.toml",
               table = folder / "out/lab/lab.residuals.csv";
    ASSERT_EQ(fit(lab, {"--name", "lab", "-j", "1"}).code, 0);
    const auto preset_bytes = bytes_of(preset), table_bytes = bytes_of(table);
    ASSERT_EQ(fit(lab, {"--name", "lab", "-j", "3"}).code, 0);
    EXPECT_EQ(bytes_of(preset), preset_bytes);
    EXPECT_EQ(bytes_of(table), table_bytes);
    fs::remove_all(folder / "out");
    fs::create_directories(folder / "out/lab");
    test::write_bytes(preset, "mine");
    const auto refused = fit(lab, {"--name", "lab"});
    EXPECT_EQ(refused.code, 4) << refused.err;
    EXPECT_EQ(bytes_of(preset), "mine");
}

TEST(FitProgram, RefusesWithAReasonAndLeavesNothing) {
    const auto folder = fresh_folder();
    test::write_bytes(folder / "bad.csv", "time_s,theta1_rad,theta2_rad\n0,0,nan\n");
    for (const auto& [file, words] :
         {std::pair("none.csv", "doppel: none.csv: there is no such file\n"),
          std::pair("bad.csv", "doppel: bad.csv:2: theta2_rad is nan; leave out rows without a measurement\n")}) {
        const auto refused = fit({file});
        EXPECT_EQ(refused.code, 2);
        EXPECT_EQ(refused.err, words);
    }
    fs::copy_file(lab[0], folder / "swing.csv");
    const auto twice = fit({"swing.csv", lab[1], "./swing.csv"});
    EXPECT_EQ(twice.code, 2);
    EXPECT_EQ(twice.err,
              "doppel: swing.csv and ./swing.csv are the same file; samples counted twice would make the "
              "errors too small\n");
    EXPECT_EQ(fit({"swing.csv"}, {"--every", "30"}).err,
              "doppel: --every is the time from a piece to the next, and swing.csv is one piece\n");
    for (const auto& [option, value] :
         {std::pair("--every", "1"), std::pair("--name", "../lab"), std::pair("--model", "rope")})
        EXPECT_EQ(fit(lab, {option, value}).code, 2) << option;
    EXPECT_FALSE(fs::exists(folder / "out/bad"));
    EXPECT_FALSE(fs::exists(folder / "out/piece-00/piece-00.toml"));
}

/// Names with control characters are rejected, or sanitised where they are only quoted.
TEST(FitProgram, ControlCharactersInNamesAreSanitised) {
    const auto folder = fresh_folder();
    for (const char* name : {"\x1b[2J", "a\nb",
                             "a\xe2\x80\xae"
                             "b",
                             "\xff"}) {
        const auto refused = fit(lab, {"--name", name});
        EXPECT_EQ(refused.code, 2) << refused.err;
        EXPECT_EQ(refused.err.find(name), std::string::npos);
    }
    const auto track = folder / "a\n[video]\nformat=\"png\"\n#.csv";
    fs::copy_file(lab[0], track);
    EXPECT_EQ(fit({track}).code, 2);  // the default name of the files would be the track's name
    ASSERT_EQ(fit({track}, {"--name", "lab"}).code, 0);
    const auto preset = bytes_of(folder / "out/lab/lab.toml");
    EXPECT_TRUE(preset.starts_with("# Fitted by doppel fit to a [video] format=\"png\" #.csv: ")) << preset;
    const auto json = nlohmann::json::parse(bytes_of(folder / "out/lab/lab.fit.json"));
    EXPECT_EQ(json["track"]["files"][0], "a [video] format=\"png\" #.csv");  // without the path from the root
    const auto& horizon = json["horizon"];
    EXPECT_EQ(preset.find("\n[video]\nmodel_limit_s = ") != std::string::npos,
              horizon.contains("median_s") && horizon["median_s"].is_number());
}

/// The preset is valid for "check" and "simulate", and its motion follows the track.
TEST(FitProgram, ItsPresetSwingsAsTheTrackDid) {
    const auto track = test::simulated(test::ratios_of(test::point_masses(1.3, 1, 0.2, 0.25)), Drag::own,
                                       {.pieces = 3, .noise = 1e-4});
    const auto folder = fresh_folder();
    ASSERT_EQ(fit(files_of(folder, track), {"--name", "points"}).code, 0);
    EXPECT_LT(worst_of_preset(folder, "points", track.pieces[0], "100"), 2e-3);  // measured 5e-4
}

}  // namespace doppel::program_test
