// Interfaces to other programs: JSON, --list-outputs, -o -, exit codes.
#include "cli/sandbox.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <sstream>

namespace doppel::contracts_test {

namespace fs = std::filesystem;
using namespace test;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

Words lines_of(const std::string& text) {
    std::istringstream stream(text);
    Words lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

Words keys_of(const Json& object) {
    Words keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

TEST(Contracts, ListIsJson) {
    const auto folder = fresh_folder();
    fs::create_directories(folder / "presets/figures");
    write_bytes(folder / "presets/mine.toml", "title = \"Mine\"\n");
    write_bytes(folder / "presets/broken.toml", "title = 3\n");
    write_bytes(folder / "presets/figures/sea.toml", "[scene]\nkind = \"section\"\n");
    const auto result = doppel(folder, {"list", "--json"});
    EXPECT_EQ(result.code, 0) << result.err;
    const auto list = Json::parse(result.out);
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
    EXPECT_NE(entry("broken")["error"].get<std::string>().find("presets/broken.toml:1:1"), std::string::npos);

    const auto words = doppel(folder, {"list"}).out;
    for (const char* line : {"\nmine               Mine\n", "\nfigures, for doppel figure:\n", "\nsea ",
                             "\ncannot be read:\nbroken  presets/broken.toml:1:1: "})
        EXPECT_NE(words.find(line), std::string::npos) << line << words;
}

TEST(Contracts, CheckIsJson) {
    const auto folder = fresh_folder();
    const auto draft = doppel(folder, {"check", "calm", "--quality", "draft", "--json"});
    EXPECT_EQ(Json::parse(draft.out).at(0)["size"], Json({960, 540})) << draft.err;
    const auto result = doppel(folder, {"check", "butterfly", "fig6", "measured", "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    const auto all = Json::parse(result.out);
    ASSERT_EQ(all.size(), 3u);
    const auto& film = all[0];
    const Json expected({{"name", "butterfly"},
                         {"title", "Three thousandths of a degree"},
                         {"kind", "pair"},
                         {"path", nullptr},
                         {"duration_s", 30},
                         {"sample_hz", 120},
                         {"samples", 3601},
                         {"steps", 1'800'000},
                         {"steps_are_exact", true},
                         {"frames", 3601},
                         {"fps", 120},
                         {"size", {1920, 1080}},
                         {"format", "mp4"},
                         {"times_are_least", false},
                         {"horizon_s", nullptr}});
    for (const auto& [key, value] : expected.items()) EXPECT_EQ(film[key], value) << key;
    EXPECT_GT(film["render_s"], film["simulate_s"]);
    const auto& a = film["a"];
    EXPECT_EQ(a["integrator"], "euler");
    EXPECT_EQ(a["step_s"], "1/30000");
    EXPECT_EQ(a["precision"], "double");
    EXPECT_NEAR(a["forecast"]["off_from_s"].get<double>(), 11, 0.1);  // measured 10.98
    EXPECT_EQ(a["forecast"]["motion"], "chaotic");
    EXPECT_EQ(film["warnings"][0], "side a: error above half a rad from 11 s on");
    EXPECT_EQ(fmt::format("{}", fmt::join(keys_of(all[1]), " ")),
              "array compute_s cpu_s disk_bytes format kind memory_bytes name path shard_cpu_s shard_repeated_share "
              "shards size theme threads times_are_least title trials unit units warnings width_pt");
    EXPECT_EQ(all[2]["a"]["model"], "track");

    const auto exact = Json::parse(doppel(folder, {"check", "calm", "--json", "--set", "system.accuracy=1e-6"}).out)[0];
    EXPECT_EQ(exact["a"]["accuracy"]["asked_rad"], 1e-6);
    EXPECT_TRUE(exact["a"].contains("tolerance"));
    EXPECT_FALSE(exact["steps_are_exact"]);
    EXPECT_EQ(exact["a"]["other_accuracies"].size(), 2u);
}

TEST(Contracts, CheckTellsAClusterWhatARunTakes) {
    const auto folder = fresh_folder(), beside = folder / "map";
    fs::create_directory(beside);
    const auto computes = start(  // a second of one core, while the films are checked
        beside, {"check", "--json", "flip-map", "--set", "grid.x.points=40000", "--set", "grid.y.points=40000"});
    const auto check = [&](const Words& arguments) {
        const auto result = doppel(folder, with({"check", "--json"}, arguments));
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out)[0];
    };
    // a film: files and memory as estimated, within a factor
    const Words film{"calm", "--set", "video.size=[320, 180]", "--set", "scene.duration_s=3"};
    const auto small = check(film);
    rusage usage{};
    const auto child = start(folder, with({"render", "--progress", "none"}, film));
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
    const Words hours{"butterfly", "--set", "video.size=[320, 180]", "--set", "scene.duration_s=72000"};
    const auto large = check(hours);
    const auto shards = large["shards"].get<long>();
    EXPECT_TRUE(shards > 1 && shards <= 14401) << shards;
    EXPECT_EQ(large["array"], fmt::format("1-{}", shards));
    EXPECT_TRUE(large["shard_cpu_s"] > 900 && large["shard_cpu_s"] <= 1800) << large["shard_cpu_s"];
    EXPECT_LT(large["shard_repeated_share"], 0.2);
    const auto words = doppel(folder, with({"check"}, with(hours, {"--set", "system.step_s=1/300000"}))).out;
    for (const char* said : {" of CPU time, ", ": --array=1-", "; each simulates the motion again, "})
        EXPECT_NE(words.find(said), std::string::npos) << words;
    const auto whole = check({"butterfly", "--set", "video.size=[160, 90]", "--set", "scene.duration_s=72000", "--set",
                              "video.format=gif", "--set", "video.fps=30"});
    EXPECT_EQ(whole["shards"], 1);
    EXPECT_TRUE(whole["array"].is_null());

    ASSERT_EQ(wait_for(computes), 0) << bytes_of(beside / "stderr");
    const auto map = Json::parse(bytes_of(beside / "stdout"))[0];
    EXPECT_GT(map["shards"], 1);
    EXPECT_LE(map["shard_cpu_s"], 1800);
    EXPECT_EQ(map["shard_repeated_share"], 0);
    EXPECT_NEAR(map["disk_bytes"].get<double>() / (1.6e9 * 24), 1, 0.5);  // 24 bytes a cell
}

TEST(Contracts, ListedOutputsAreTheWrittenOnes) {
    const auto folder = fresh_folder();
    write_bytes(folder / "sheet.toml", "[scene]\nduration_s = 0.1\n[video]\nposter_s = 0.1\ncontact_sheet = [2, 1]\n");
    write_bytes(folder / "map.toml",
                "[scene]\nkind = \"grid\"\nduration_s = 1\n[grid]\nquantity = \"flip_time\"\n[grid.x]\npoints = "
                "8\n[grid.y]\nkey = \"theta2_deg\"\npoints = 8\n");
    const Words brief{"--set", "scene.duration_s=0.1"}, small{"--size", "160x90"};
    const Words chart{"--size", "800x450"};  // with space for all its text
    doppel(folder, {"--version"});           // creates the files of its output
    const std::vector<Words> commands{with({"simulate", "calm", "triple"}, brief),
                                      with(with({"render", "calm"}, brief), small),
                                      with({"simulate", "calm", "--recording", "calm.motion"}, brief),
                                      with({"render", "sheet.toml", "-o", "films/of mine"}, small),
                                      with({"render", "sheet.toml", "--format", "png"}, small),
                                      with({"still", "calm", "--at", "0.5", "--format", "svg"}, {}),
                                      with(with({"figure", "fig6", "--format", "pdf"}, brief), small),
                                      with(with({"figure", "fig6", "--format", "html"}, brief), small),
                                      with({"figure", "fig6", "--shard", "2/3"}, brief),
                                      {"figure", "map.toml", "--tiles"}};
    for (const auto& command : commands) {
        const auto before = listing(folder);
        const auto listed = doppel(folder, with(command, {"--list-outputs"}));
        EXPECT_EQ(listed.code, 0) << listed.err;
        EXPECT_EQ(listing(folder), before) << command[1];
        auto written = lines_of(doppel(folder, with(command, {"--progress", "none"})).out);
        for (auto& line : written) line = line.substr(0, line.find(" ("));
        EXPECT_EQ(lines_of(listed.out), written) << command[0] << command[1];
    }
    EXPECT_EQ(doppel(folder, {"figure", "fig6", "--tiles", "--list-outputs"}).code, 2);
    EXPECT_EQ(doppel(folder, {"simulate", "calm", "-o", "-", "--list-outputs"}).out, "-\n");
    for (const auto& command : std::vector<Words>{{"simulate", "calm", "fan"},
                                                  {"still", "calm", "fan", "--at", "1"},
                                                  {"figure", "fig6", "fig7"},
                                                  {"certify", "calm", "triple"}})
        EXPECT_EQ(doppel(folder, with(command, {"-o", "-", "--list-outputs"})).err,
                  "doppel: -o -: standard output takes one file; give one preset, not 2\n");
    EXPECT_EQ(doppel(folder, {"fit", "a/swing.csv", "--list-outputs"}).out,
              "out/swing/swing.toml\nout/swing/swing.residuals.csv\nout/swing/swing.png\nout/swing/swing.fit.json\n");
}

TEST(Contracts, OneFileGoesToStandardOutputAndNothingElse) {
    const auto folder = fresh_folder();
    const Words brief{"--set", "scene.duration_s=0.1"}, small{"--size", "160x90"};
    const Words chart{"--size", "800x450"};  // with space for all its text
    struct Case {
        Words command;
        std::string file;
    };
    for (const auto& [command, file] :
         {Case{with({"simulate", "calm"}, brief), "calm/calm.csv"},
          {with(with({"render", "calm", "--format", "gif"}, brief), small), "calm/calm.gif"},
          {{"still", "calm", "--at", "0.5", "--format", "svg"}, "calm/calm.0.5s.svg"},
          {with(with({"figure", "fig6"}, brief), chart), "fig6/fig6.png"}})
        for (const char* style : {"none", "plain", "json"}) {
            fs::remove_all(folder / "out");
            fs::create_directory(folder / "tmp");
            doppel(folder, {"--version"});  // creates the files of its output
            const auto before = listing(folder);
            const auto streamed =
                doppel(folder, with(command, {"-o", "-", "--progress", style}), [] { setenv("TMPDIR", "tmp", 1); });
            EXPECT_EQ(streamed.code, 0) << streamed.err;
            EXPECT_EQ(listing(folder), before) << command[0];
            EXPECT_EQ(streamed.err.empty(), std::string(style) == "none") << streamed.err;
            ASSERT_EQ(doppel(folder, with(command, {"--progress", "none"})).code, 0);
            EXPECT_TRUE(streamed.out == bytes_of(folder / "out" / file)) << command[0];
            fs::remove(folder / "tmp");
        }
}

TEST(Contracts, StandardOutputTakesOneFileAlone) {
    const auto folder = fresh_folder();
    const auto failed = doppel(folder, {"simulate", "butterfly", "-o", "-", "--set", "system.step_s=0.1", "--set",
                                        "scene.sample_hz=10", "--set", "system.omega_deg_per_s=9e9"});
    EXPECT_EQ(failed.code, 3) << failed.err;
    EXPECT_EQ(failed.out, "");
    EXPECT_EQ(failed.err.find("/doppel-"), std::string::npos) << failed.err;
    const auto quick = std::string("\"$DOPPEL\" simulate calm -o - --progress none --set scene.duration_s=1 ");
    EXPECT_EQ(shell(folder, quick + ">/dev/full").code, 75);
    EXPECT_EQ(shell(folder, quick + ">&-").code, 4);
    EXPECT_EQ(shell(folder, "(" + quick + "--set scene.sample_hz=1000; echo $? >code) | head -n 1 >/dev/null").code, 0);
    EXPECT_EQ(bytes_of(folder / "code"), "0\n");
}

TEST(Contracts, HelpFitsAScreen) {
    const auto folder = fresh_folder();
    for (const char* command : {"", "render", "simulate", "still", "figure", "fit", "compare", "list", "show", "check",
                                "certify", "init", "schema", "completion"}) {
        auto line = Words{"--help"};
        if (*command != 0) line.insert(line.begin(), command);
        const auto help = doppel(folder, line);
        const auto lines = lines_of(help.out);
        EXPECT_EQ(help.code, 0) << command;
        EXPECT_TRUE(lines.size() > 3 && lines.size() <= 42) << command;
        for (const auto& text : lines)
            EXPECT_TRUE(text.size() <= 100 || text.starts_with("  --figure TEXT:{")) << command << ": " << text;
    }
    EXPECT_TRUE(doppel(folder, {"--version"}).out.starts_with("doppel 1."));
}

TEST(Contracts, APresetsFileNeedsNoEnding) {
    const auto folder = fresh_folder();
    write_bytes(folder / "swing.txt", "title = \"Swing\"\n[scene]\nduration_s = 0.1\n");
    EXPECT_EQ(doppel(folder, {"simulate", "swing.txt", "--progress", "none"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "out/swing/swing.csv"));
    write_bytes(folder / "notes.txt", "hello\n");
    EXPECT_TRUE(doppel(folder, {"check", "notes.txt"}).err.starts_with("doppel: notes.txt:1:6: "));
}

TEST(Contracts, RunsReportWhenTheyDivergeAsCheckDoes) {
    const auto folder = fresh_folder();
    const auto run = doppel(folder, {"simulate", "butterfly", "--progress", "none"});
    EXPECT_EQ(run.err,
              "butterfly: side a: error above half a rad from 11 s on\n"
              "butterfly: side b: error above half a rad from 11 s on\n");
    const auto manifest = Json::parse(bytes_of(folder / "out/butterfly/butterfly.json"));
    EXPECT_EQ(manifest["warnings"][1], "side b: error above half a rad from 11 s on");
    const auto brief = doppel(folder, {"simulate", "butterfly", "--progress", "none", "--set", "scene.duration_s=10"});
    EXPECT_EQ(brief.err, "");
    const auto lost = doppel(folder, {"simulate", "butterfly", "--progress", "none", "--set", "system.accuracy=1e-3"});
    EXPECT_NE(lost.err.find("side a: the accuracy is kept up to 2"), std::string::npos) << lost.err;
}

}  // namespace doppel::contracts_test
