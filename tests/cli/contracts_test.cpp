// Interfaces to other programs: JSON, --list-outputs, -o -, exit codes.
#include "cli/process.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>

namespace doppel::contracts_test {

namespace fs = std::filesystem;
using namespace test;
using Contracts = ProgramTest;
using Json = nlohmann::json;

TEST_F(Contracts, ListIsJson) {
    fs::create_directories(folder / "presets/figures");
    write_bytes(folder / "presets/mine.toml", "title = \"Mine\"\n");
    write_bytes(folder / "presets/broken.toml", "title = 3\n");
    write_bytes(folder / "presets/figures/sea.toml", "[scene]\nkind = \"section\"\n");
    const auto list = Json::parse(done("list --json").out);
    const auto entry = [&](const std::string& name) {
        return *std::find_if(list.begin(), list.end(), [&](const Json& one) { return one["name"] == name; });
    };
    EXPECT_EQ(entry("mine"),
              Json({{"name", "mine"}, {"title", "Mine"}, {"kind", "pair"}, {"path", "presets/mine.toml"}}));
    EXPECT_EQ(entry("sea")["kind"], "section");
    EXPECT_EQ(entry("sea")["path"], "presets/figures/sea.toml");
    EXPECT_EQ(entry("butterfly")["title"], "Three thousandths of a degree");
    EXPECT_TRUE(entry("butterfly")["path"].is_null());
    EXPECT_TRUE(entry("broken")["kind"].is_null() && entry("broken")["title"].is_null());
    EXPECT_TRUE(has(entry("broken")["error"].get<std::string>(), "presets/broken.toml:1:1"));

    const auto words = doppel("list").out;
    EXPECT_TRUE(has(words, {"\nmine               Mine\n", "\nfigures, for doppel figure:\n", "\nsea ",
                            "\ncannot be read:\nbroken  presets/broken.toml:1:1: "}));
}

TEST_F(Contracts, CheckIsJson) {
    const auto draft = doppel("check calm --quality draft --json --set scene.duration_s=0.1");
    EXPECT_EQ(Json::parse(draft.out).at(0)["size"], Json({960, 540})) << draft.err;
    const auto all = Json::parse(done("check butterfly fig6 measured --json").out);
    ASSERT_EQ(all.size(), 3u);
    const auto& film = all[0];
    const auto expected = Json::parse(R"({"name": "butterfly", "title": "Three thousandths of a degree", "kind": "pair",
        "path": null, "duration_s": 30, "sample_hz": 120, "samples": 3601, "steps": 1800000, "steps_are_exact": true,
        "frames": 3601, "fps": 120, "size": [1920, 1080], "format": "mp4", "times_are_least": false,
        "horizon_s": null})");
    for (const auto& [key, value] : expected.items()) EXPECT_EQ(film[key], value) << key;
    EXPECT_GT(film["render_s"], film["simulate_s"]);
    const auto& a = film["a"];
    EXPECT_EQ(a["integrator"], "euler");
    EXPECT_EQ(a["step_s"], "1/30000");
    EXPECT_EQ(a["precision"], "double");
    EXPECT_NEAR(a["forecast"]["off_from_s"].get<double>(), 11, 0.1);  // measured 10.98
    EXPECT_EQ(a["forecast"]["motion"], "chaotic");
    EXPECT_EQ(film["warnings"][0], "side a: error above half a rad from 11 s on");
    std::string keys;
    for (const auto& [key, value] : all[1].items()) keys += key + " ";
    EXPECT_EQ(keys,
              "array compute_s cpu_s disk_bytes format kind memory_bytes name path shard_cpu_s shard_repeated_share "
              "shards size theme threads times_are_least title trials unit units warnings width_pt ");
    EXPECT_EQ(all[2]["a"]["model"], "track");

    const auto exact = Json::parse(
        doppel("check calm --json --set system.accuracy=1e-6 --set scene.duration_s=5 --set 'video.size=[64, 64]'")
            .out)[0];
    EXPECT_EQ(exact["a"]["accuracy"]["asked_rad"], 1e-6);
    EXPECT_TRUE(exact["a"].contains("tolerance"));
    EXPECT_FALSE(exact["steps_are_exact"]);
    EXPECT_EQ(exact["a"]["other_accuracies"].size(), 2u);
}

TEST_F(Contracts, CheckTellsAClusterWhatARunTakes) {
    const auto beside = folder / "map";
    fs::create_directory(beside);
    const auto computes = start(  // about an hour of one core; its check takes a second, while the films are checked
        "check --json flip-map --set grid.x.points=16000 --set grid.y.points=50000", {}, beside);
    const auto check = [&](const Words& arguments) {
        return Json::parse(done(with("check --json", arguments)).out)[0];
    };
    // a film: files and memory as estimated, within a factor
    const Words film = "calm --set 'video.size=[320, 180]' --set scene.duration_s=3";
    const auto small = check(film);
    rusage usage{};
    const auto child = start(with("render --progress none", film));
    int status = 0;
    wait4(child, &status, 0, &usage);
    ASSERT_EQ(status, 0) << bytes_of(folder / "stderr");
    double bytes = 0;
    for (const char* file : {"out/calm/calm.mp4", "out/calm/calm.csv"})
        bytes += static_cast<double>(fs::file_size(folder / file));
    EXPECT_NEAR(small["disk_bytes"].get<double>() / bytes, 1, 0.6);  // measured 1.1
#ifndef DOPPEL_SANITIZE
    EXPECT_NEAR(small["memory_bytes"].get<double>() / (1024.0 * static_cast<double>(usage.ru_maxrss)), 1, 0.4);
#endif
    EXPECT_GT(small["cpu_s"], 0);
    EXPECT_EQ(small["shards"], 1);
    EXPECT_EQ(small["array"], "1-1");
    EXPECT_EQ(small["shard_cpu_s"], small["cpu_s"]);

    // one shard for each 5 s at most, of half an hour at most
    const Words hours = "butterfly --set 'video.size=[320, 180]' --set scene.duration_s=72000 --set scene.sample_hz=30";
    const auto large = check(hours);
    const auto shards = large["shards"].get<long>();
    EXPECT_TRUE(shards > 1 && shards <= 14401) << shards;
    EXPECT_EQ(large["array"], fmt::format("1-{}", shards));
    EXPECT_TRUE(large["shard_cpu_s"] > 900 && large["shard_cpu_s"] <= 1800) << large["shard_cpu_s"];
    EXPECT_LT(large["shard_repeated_share"], 0.2);
    const auto words = doppel(with("check", with(hours, "--set system.step_s=1/300000"))).out;
    EXPECT_TRUE(has(words, {" of CPU time, ", ": --array=1-", "; each simulates the motion again, "}));
    const auto whole = check(with(hours, "--set video.format=gif"));
    EXPECT_EQ(whole["shards"], 1);
    EXPECT_TRUE(whole["array"].is_null());

    ASSERT_EQ(wait_for(computes), 0) << bytes_of(beside / "stderr");
    const auto map = Json::parse(bytes_of(beside / "stdout"))[0];
    EXPECT_GT(map["shards"], 1);
    EXPECT_LE(map["shard_cpu_s"], 1800);
    EXPECT_EQ(map["shard_repeated_share"], 0);
    EXPECT_NEAR(map["disk_bytes"].get<double>() / (8e8 * 24), 1, 0.5);  // 24 bytes a cell
}

TEST_F(Contracts, ListedOutputsAreTheWrittenOnes) {
    write_bytes(folder / "sheet.toml", "[scene]\nduration_s = 0.1\n[video]\nposter_s = 0.1\ncontact_sheet = [2, 1]\n");
    write_bytes(folder / "map.toml", small_map);
    doppel("--version");  // creates the files of its output
    for (const Words& command : std::vector<Words>{
             "simulate calm triple --set scene.duration_s=0.1", "render calm --size 160x90 --set scene.duration_s=0.1",
             "simulate calm --recording calm.motion --set scene.duration_s=0.1",
             "render sheet.toml -o 'films/of mine' --size 160x90", "render sheet.toml --format png --size 160x90",
             "still calm --at 0.5 --format svg", "figure fig6 --format pdf --size 160x90 --set scene.duration_s=0.1",
             "figure fig6 --format html --size 160x90 --set scene.duration_s=0.1",
             "figure fig6 --shard 2/3 --set scene.duration_s=0.1", "figure map.toml --tiles"}) {
        const auto before = listing(folder);
        const auto listed = done(with(command, "--list-outputs"));
        EXPECT_EQ(listing(folder), before) << command[1];
        auto written = lines_of(doppel(with(command, "--progress none")).out);
        for (auto& line : written) line = line.substr(0, line.find(" ("));
        EXPECT_EQ(lines_of(listed.out), written) << command[0] << command[1];
    }
    EXPECT_EQ(doppel("figure fig6 --tiles --list-outputs").code, 2);
    EXPECT_EQ(doppel("simulate calm -o - --list-outputs").out, "-\n");
    for (const auto& command :
         std::vector<Words>{"simulate calm fan", "still calm fan --at 1", "figure fig6 fig7", "certify calm triple"})
        expect_refused(with(command, "-o - --list-outputs"), 2,
                       "doppel: -o -: standard output takes one file; give one preset, not 2\n");
    EXPECT_EQ(doppel("fit a/swing.csv --list-outputs").out,
              "out/swing/swing.toml\nout/swing/swing.residuals.csv\nout/swing/swing.png\nout/swing/swing.fit.json\n");
}

TEST_F(Contracts, OneFileGoesToStandardOutputAndNothingElse) {
    for (const auto& [command, file] : std::vector<std::pair<Words, std::string>>{
             {"simulate calm --set scene.duration_s=0.1", "calm/calm.csv"},
             {"render calm --format gif --set scene.duration_s=0.1 --size 160x90", "calm/calm.gif"},
             {"still calm --at 0.5 --format svg", "calm/calm.0.5s.svg"},
             {"figure fig6 --set scene.duration_s=0.1 --size 800x450", "fig6/fig6.png"}})  // with space for its text
        for (const char* style : {"none", "plain", "json"}) {
            fs::remove_all(folder / "out");
            fs::create_directory(folder / "tmp");
            doppel("--version");  // creates the files of its output
            const auto before = listing(folder);
            const auto streamed =
                done(with(command, {"-o", "-", "--progress", style}), [] { setenv("TMPDIR", "tmp", 1); });
            EXPECT_EQ(listing(folder), before) << command[0];
            EXPECT_EQ(streamed.err.empty(), std::string(style) == "none") << streamed.err;
            done(with(command, "--progress none"));
            EXPECT_TRUE(streamed.out == bytes_of(folder / "out" / file)) << command[0];
            fs::remove(folder / "tmp");
        }
}

TEST_F(Contracts, StandardOutputTakesOneFileAlone) {
    const auto failed = ends(
        "simulate butterfly -o - --set system.step_s=1/1000 --set scene.sample_hz=1000 --set "
        "system.omega_deg_per_s=9e9",
        3);
    EXPECT_EQ(failed.out, "");
    EXPECT_FALSE(has(failed.err, "/doppel-"));
    const auto quick = std::string("\"$DOPPEL\" simulate calm -o - --progress none --set scene.duration_s=1 ");
    EXPECT_EQ(shell("TMPDIR=/none " + quick).err,
              "doppel: /none: cannot be used for temporary files (TMPDIR): No such file or directory\n");
    EXPECT_EQ(shell(quick + ">/dev/full").code, 75);
    EXPECT_EQ(shell(quick + ">&-").code, 4);
    EXPECT_EQ(shell("(" + quick + "--set scene.sample_hz=1000; echo $? >code) | head -n 1 >/dev/null").code, 0);
    EXPECT_EQ(bytes_of(folder / "code"), "0\n");
}

TEST_F(Contracts, HelpFitsAScreen) {
    for (const char* command : {"", "render", "simulate", "still", "figure", "fit", "compare", "list", "show", "check",
                                "certify", "init", "schema", "completion"}) {
        const auto lines = lines_of(done(with(command, "--help")).out);
        EXPECT_TRUE(lines.size() > 3 && lines.size() <= 42) << command;
        for (const auto& text : lines)
            EXPECT_TRUE(text.size() <= 100 || text.starts_with("  --figure TEXT:{")) << command << ": " << text;
    }
    EXPECT_TRUE(doppel("--version").out.starts_with("doppel 1."));
}

TEST_F(Contracts, APresetsFileNeedsNoEnding) {
    write_bytes(folder / "swing.txt", "title = \"Swing\"\n[scene]\nduration_s = 0.1\n");
    done("simulate swing.txt --progress none");
    EXPECT_TRUE(fs::exists(folder / "out/swing/swing.csv"));
    write_bytes(folder / "notes.txt", "hello\n");
    EXPECT_TRUE(doppel("check notes.txt").err.starts_with("doppel: notes.txt:1:6: "));
}

TEST_F(Contracts, RunsReportWhenTheyDivergeAsCheckDoes) {
    const auto run = doppel("simulate butterfly --progress none");
    EXPECT_EQ(run.err,
              "butterfly: side a: error above half a rad from 11 s on\n"
              "butterfly: side b: error above half a rad from 11 s on\n");
    const auto manifest = Json::parse(bytes_of(folder / "out/butterfly/butterfly.json"));
    EXPECT_EQ(manifest["warnings"][1], "side b: error above half a rad from 11 s on");
    EXPECT_EQ(doppel("simulate butterfly --progress none --set scene.duration_s=10").err, "");
    const auto lost = doppel("simulate butterfly --progress none --set system.accuracy=1e-3");
    EXPECT_TRUE(has(lost.err, "side a: the accuracy is kept up to 2"));
}

}  // namespace doppel::contracts_test
