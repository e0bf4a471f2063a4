#include "cli/sandbox.hpp"
#include "output/png.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <sstream>
#include <thread>

namespace doppel::figure_program_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::doppel;
using test::fresh_folder;
using test::left_nothing;
using test::shell;
using test::start;
using test::wait_for;
using test::with;

const std::vector<std::string> small{"--set",  "grid.x.to=9", "--set",      "scene.duration_s=0.5",
                                     "--size", "320x180",     "--progress", "none"};

/// A map that takes about 2 to 10 s on one core.
const std::vector<std::string> long_map{"figure", "flip-map",          "--set",  "grid.x.points=600",
                                        "--set",  "grid.y.points=600", "--size", "320x320"};

/// Waits until the file exists.
bool appears(const fs::path& file) {
    for (int i = 0; i < 20'000 && !fs::exists(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return fs::exists(file);
}

bool contains(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
}

TEST(FigureProgram, DrawsByNameAndByPath) {
    const auto folder = fresh_folder();
    test::write_bytes(folder / "mine.toml", bytes_of(fs::path(DOPPEL_SOURCE_DIR) / "presets/figures/fig4-right.toml"));
    // one thread: with two, the second figure may finish first
    const auto result = doppel(
        folder, with({"figure", "fig2-right", "./mine.toml", "-o", "figures", "--scale", "2", "--jobs", "1"}, small));
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "fig2-right: there is no space for the captions\nmine: there is no space for the captions\n");
    for (const char* file :
         {"fig2-right/fig2-right.png", "fig2-right/fig2-right.csv", "fig2-right/fig2-right.json", "mine/mine.png"}) {
        EXPECT_TRUE(fs::exists(folder / "figures" / file)) << file;
        EXPECT_TRUE(contains(result.out, std::string("figures/") + file)) << result.out;
    }
    EXPECT_EQ(read_png(folder / "figures/mine/mine.png").size, (Size{640, 360}));
}

TEST(FigureProgram, IsChecked) {
    const auto folder = fresh_folder();
    const auto check = doppel(folder, with({"check", "fig2-right"}, {"--set", "grid.x.to=9"}));
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_TRUE(contains(check.out, "pairs: 10")) << check.out;
    // On a slow machine one row of exponents takes longer than the second allowed for the estimate: a lower bound.
    const auto map = doppel(folder, {"check", "parting-map", "--set", "grid.quantity=exponent"});
    EXPECT_TRUE(contains(map.out, "takes  about ") || contains(map.out, "takes  more than ")) << map.out << map.err;
    EXPECT_FALSE(contains(map.out, "about 0 s") || contains(map.out, "more than 0 s")) << map.out;
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(FigureProgram, ReportsProgressAsJson) {
    const auto folder = fresh_folder();
    const auto result = doppel(folder, {"figure", "fig2-right", "--set", "grid.x.to=9", "--set", "scene.duration_s=0.5",
                                        "--size", "320x180", "--progress", "json"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    nlohmann::json event;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) event = nlohmann::json::parse(line);
    EXPECT_EQ(event["event"], "done");
    EXPECT_EQ(event["unit"], "pairs");
    EXPECT_EQ(event["done"], 10);
    EXPECT_EQ(event["files"].size(), 3u);
}

TEST(FigureProgram, ExitsWithinASecondOfASignalWhileItsThreadsCompute) {
    for (const auto& [signal, code] : {std::pair(SIGINT, 130), {SIGTERM, 143}}) {
        const auto folder = fresh_folder();
        const auto child = start(folder, {"figure", "fig6", "droplet", "--progress", "none", "--jobs", "4"});
        EXPECT_TRUE(appears(folder / "out/fig6/fig6.json"));
        const auto requested = std::chrono::steady_clock::now();
        kill(child, signal);
        EXPECT_EQ(wait_for(child), code);
        EXPECT_LT(std::chrono::steady_clock::now() - requested, std::chrono::seconds(1));  // measured 0.05 s
        EXPECT_EQ(bytes_of(folder / "stderr").rfind("doppel: interrupted", 0), 0u);
        // no incomplete file, except the record for resuming
        for (const auto& name : test::listing(folder / "out/droplet")) EXPECT_TRUE(name.ends_with(".resume")) << name;
        EXPECT_TRUE(fs::exists(folder / "out/fig6/fig6.png")) << "all of what was";
    }
}

TEST(FigureProgram, AMissingShardIsExit75) {
    const auto folder = fresh_folder();
    const std::vector<std::string> figure{"figure", "fig6", "--set", "scene.duration_s=0.5", "--progress", "none"};
    ASSERT_EQ(doppel(folder, with(figure, {"--shard", "1/2"})).code, 0);
    const auto merge = doppel(folder, with(figure, {"--merge"}));
    EXPECT_EQ(merge.code, 75);
    EXPECT_EQ(merge.err, "doppel: out/fig6: missing shards: 2/2\n");
}

/// A long run keeps its results, whatever stops it.
class LongFigure : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        child_ = start(folder_, with(long_map, {"--jobs", "1", "--progress", "none"}));
        // stopped for 2 s, so that it counts as a long run
        for (int i = 0; i < 60'000 && cpu_s() < 0.5; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        kill(child_, SIGSTOP);
        std::this_thread::sleep_for(std::chrono::milliseconds(2050));
        kill(child_, SIGCONT);
        for (int i = 0; i < 20'000 && (record_ = record_in(folder_)).empty(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ASSERT_FALSE(record_.empty());
    }

    double cpu_s() const {
        clockid_t clock{};
        timespec time{};
        if (clock_getcpuclockid(child_, &clock) != 0 || clock_gettime(clock, &time) != 0) return 1e9;
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
    /// "out/flip-map/flip-map.c0ffee123456.resume"; empty if there is none.
    static std::string record_in(const fs::path& folder) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder / "out/flip-map", ignored))
            if (entry.path().extension() == ".resume") return fs::relative(entry.path(), folder).string();
        return "";
    }

    void expect_record_alone() const {
        EXPECT_TRUE(fs::exists(folder_ / record_));
        for (const char* file : {"flip-map.png", "flip-map.csv", "flip-map.json"})
            EXPECT_FALSE(fs::exists(folder_ / "out/flip-map" / file)) << file;
    }

    fs::path folder_;
    std::string record_;
    pid_t child_ = -1;
};

TEST_F(LongFigure, ResumesAfterItWasKilled) {
    kill(child_, SIGKILL);
    EXPECT_EQ(wait_for(child_), -SIGKILL);
    expect_record_alone();
    const auto again = doppel(folder_, with(long_map, {"--jobs", "2", "--progress", "plain"}));
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_TRUE(contains(again.err, "resuming from " + record_ + ": ")) << again.err;
    EXPECT_FALSE(contains(again.err, ": 0 % is done")) << again.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out/flip-map"), {}), 3) << "the record has gone";

    ASSERT_EQ(doppel(folder_, with(long_map, {"-o", "whole", "--progress", "none"})).code, 0);
    for (const char* file : {"flip-map.csv", "flip-map.png"})
        EXPECT_TRUE(bytes_of(folder_ / "out/flip-map" / file) == bytes_of(folder_ / "whole/flip-map" / file)) << file;
}

TEST_F(LongFigure, ReportsItsRecordAfterCtrlC) {
    kill(child_, SIGINT);
    EXPECT_EQ(wait_for(child_), 130);
    const auto said = bytes_of(folder_ / "stderr");
    EXPECT_TRUE(contains(said, "doppel: interrupted; ")) << said;
    EXPECT_TRUE(contains(said, "kept in " + record_ + ": the same command resumes")) << said;
    expect_record_alone();
    // another preset does not resume from it, and does not change it
    const auto bytes = bytes_of(folder_ / record_);
    const auto other = doppel(folder_, with(long_map, {"--set", "scene.duration_s=0.1", "--progress", "plain"}));
    EXPECT_EQ(other.code, 0) << other.err;
    EXPECT_TRUE(contains(other.err, "ignoring " + record_ + ", of another preset or version")) << other.err;
    EXPECT_EQ(bytes_of(folder_ / record_), bytes);
}

// Commands of README.md and docs/figures.md, run in a shell.

const std::string settings = " --set grid.x.to=20 --set scene.duration_s=0.5 --size 320x180 --progress none";

void expect_merged(const fs::path& folder) {
    const auto merge = shell(folder, "\"$DOPPEL\" figure fig2-right --merge" + settings);
    EXPECT_EQ(merge.code, 0) << merge.err;
    EXPECT_EQ(shell(folder, "\"$DOPPEL\" figure fig2-right -o whole" + settings).code, 0);
    for (const char* file : {"fig2-right.csv", "fig2-right.png"})
        EXPECT_TRUE(bytes_of(folder / "out/fig2-right" / file) == bytes_of(folder / "whole/fig2-right" / file)) << file;
}

TEST(Recipe, SlurmArray) {
    const auto folder = fresh_folder();
    test::write_bytes(folder / "job.sh",
                      "#!/bin/sh\n#SBATCH --array=1-3\n\"$DOPPEL\" figure fig2-right --shard "
                      "\"$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT\"" +
                          settings + "\n");
    const auto jobs = shell(folder,
                            "export SLURM_ARRAY_TASK_COUNT=3\n"
                            "for i in 1 2 3; do SLURM_ARRAY_TASK_ID=$i sh job.sh & tasks=\"$tasks $!\"; done\n"
                            "for task in $tasks; do wait $task || exit; done");
    EXPECT_EQ(jobs.code, 0) << jobs.err;
    for (int i = 1; i <= 3; ++i)
        EXPECT_TRUE(contains(jobs.out, "out/fig2-right/fig2-right." + std::to_string(i) + "-of-3.shard")) << jobs.out;
    expect_merged(folder);
}

TEST(Recipe, GnuParallel) {
    const auto folder = fresh_folder();
    // xargs if there is no GNU parallel: it runs the same commands, with {} replaced
    const auto jobs = shell(folder,
                            "if command -v parallel >/dev/null; then\n"
                            "    parallel --will-cite -j 4 \"$DOPPEL\" figure fig2-right --shard {}/8" +
                                settings +
                                " ::: $(seq 8)\n"
                                "else\n"
                                "    seq 8 | xargs -P 4 -I '{}' \"$DOPPEL\" figure fig2-right --shard '{}/8'" +
                                settings +
                                "\n"
                                "fi");
    EXPECT_EQ(jobs.code, 0) << jobs.err;
    expect_merged(folder);
}

}  // namespace doppel::figure_program_test
