#include "cli/process.hpp"
#include "cli/terminal.hpp"
#include "output/png.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>

namespace doppel::figure_program_test {

namespace fs = std::filesystem;
using namespace test;
using FigureProgram = ProgramTest;
using Recipe = ProgramTest;

const Words small = "--set grid.x.to=9 --set scene.duration_s=0.5 --size 320x180 --progress none";

/// A map that takes about 1 to 5 s on one core.
const Words long_map = "figure flip-map --set grid.x.points=400 --set grid.y.points=400 --size 320x320";

/// Waits until the file exists.
bool appears(const fs::path& file) {
    for (int i = 0; i < 20'000 && !fs::exists(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return fs::exists(file);
}

TEST_F(FigureProgram, DrawsByNameAndByPath) {
    write_bytes(folder / "mine.toml", bytes_of(fs::path(DOPPEL_SOURCE_DIR) / "presets/figures/fig4-right.toml"));
    // one thread: with two, the second figure may finish first
    const auto result = done(with("figure fig2-right ./mine.toml -o figures --scale 2 --jobs 1", small));
    EXPECT_EQ(result.err, "fig2-right: there is no space for the captions\nmine: there is no space for the captions\n");
    for (const char* file :
         {"fig2-right/fig2-right.png", "fig2-right/fig2-right.csv", "fig2-right/fig2-right.json", "mine/mine.png"}) {
        EXPECT_TRUE(fs::exists(folder / "figures" / file)) << file;
        EXPECT_TRUE(has(result.out, std::string("figures/") + file));
    }
    EXPECT_EQ(read_png(folder / "figures/mine/mine.png").size, (Size{640, 360}));
}

TEST_F(FigureProgram, IsChecked) {
    const auto check = done(with("check fig2-right", "--set grid.x.to=9"));
    EXPECT_TRUE(has(check.out, "pairs: 10"));
    const auto page = done(with("check fig2-right", "--set grid.x.to=9 --set chart.format=html"));
    EXPECT_TRUE(has(page.out, "chart  1600×900 px, html, light")) << page.out;
    // On a slow machine one row of exponents takes longer than the second allowed for the estimate: a lower bound.
    const auto map = doppel("check parting-map --set grid.quantity=exponent");
    EXPECT_TRUE(has(map.out, "takes  about ") || has(map.out, "takes  more than "));
    EXPECT_FALSE(has(map.out, "about 0 s") || has(map.out, "more than 0 s"));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(ProgressReport, RatesBelowTenHaveTwoDigits) {
    for (const auto& [count, words] :
         {std::pair(21, "21 motions in 53.8 s, 0.39 motions/s\n"), {2100, "2100 motions in 53.8 s, 39 motions/s\n"}}) {
        RunResult result;
        result.samples = count;
        result.wall_s = 53.8;
        testing::internal::CaptureStderr();
        ProgressReport(ProgressStyle::plain, "drift", "motions").done(result);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), fmt::format("drift: {}", words));
    }
}

TEST_F(FigureProgram, ReportsProgressAsJson) {
    const auto result =
        done("figure fig2-right --set grid.x.to=9 --set scene.duration_s=0.5 --size 320x180 --progress json");
    EXPECT_EQ(result.err, "");
    nlohmann::json event;
    for (const auto& line : lines_of(result.out)) event = nlohmann::json::parse(line);
    EXPECT_EQ(event["event"], "done");
    EXPECT_EQ(event["unit"], "pairs");
    EXPECT_EQ(event["done"], 10);
    EXPECT_EQ(event["files"].size(), 3u);
}

TEST_F(FigureProgram, ExitsWithinASecondOfASignalWhileItsThreadsCompute) {
    for (const auto& [signal, code] : {std::pair(SIGINT, 130), {SIGTERM, 143}}) {
        fresh_folder();  // empties it
        const auto child = start("figure fig6 droplet --progress none --jobs 4");
        EXPECT_TRUE(appears(folder / "out/fig6/fig6.json"));
        const auto requested = std::chrono::steady_clock::now();
        kill(child, signal);
        EXPECT_EQ(wait_for(child), code);
        EXPECT_LT(std::chrono::steady_clock::now() - requested, std::chrono::seconds(1));  // measured 0.05 s
        EXPECT_TRUE(begins(bytes_of(folder / "stderr"), "doppel: interrupted"));
        // no incomplete file, except the record for resuming
        for (const auto& name : listing(folder / "out/droplet")) EXPECT_TRUE(name.ends_with(".resume")) << name;
        EXPECT_TRUE(fs::exists(folder / "out/fig6/fig6.png")) << "all of what was";
    }
}

TEST_F(FigureProgram, AMissingShardIsExit75) {
    const Words figure = "figure fig6 --set scene.duration_s=0.5 --progress none";
    done(with(figure, "--shard 1/2"));
    expect_refused(with(figure, "--merge"), 75, "doppel: out/fig6: missing shards: 2/2\n");
}

/// A long run keeps its results, whatever stops it.
class LongFigure : public ProgramTest {
protected:
    void SetUp() override {
        child_ = start(with(long_map, "--jobs 1 --progress none"));
        // stopped for 2 s, so that it counts as a long run
        for (int i = 0; i < 60'000 && cpu_s() < 0.2; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        kill(child_, SIGSTOP);
        std::this_thread::sleep_for(std::chrono::milliseconds(2050));
        kill(child_, SIGCONT);
        for (int i = 0; i < 20'000 && (record_ = record()).empty(); ++i)
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
    std::string record() const {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder / "out/flip-map", ignored))
            if (entry.path().extension() == ".resume") return fs::relative(entry.path(), folder).string();
        return "";
    }

    void expect_record_alone() const {
        EXPECT_TRUE(fs::exists(folder / record_));
        for (const char* file : {"flip-map.png", "flip-map.csv", "flip-map.json"})
            EXPECT_FALSE(fs::exists(folder / "out/flip-map" / file)) << file;
    }

    std::string record_;
    pid_t child_ = -1;
};

TEST_F(LongFigure, ResumesAfterItWasKilled) {
    kill(child_, SIGKILL);
    EXPECT_EQ(wait_for(child_), -SIGKILL);
    expect_record_alone();
    const auto again = done(with(long_map, "--jobs 2 --progress plain"));
    EXPECT_TRUE(has(again.err, "resuming from " + record_ + ": "));
    EXPECT_FALSE(has(again.err, ": 0 % is done"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out/flip-map"), {}), 3) << "the record has gone";

    done(with(long_map, "-o whole --progress none"));
    for (const char* file : {"flip-map.csv", "flip-map.png"})
        EXPECT_TRUE(bytes_of(folder / "out/flip-map" / file) == bytes_of(folder / "whole/flip-map" / file)) << file;
}

TEST_F(LongFigure, ReportsItsRecordAfterCtrlC) {
    kill(child_, SIGINT);
    EXPECT_EQ(wait_for(child_), 130);
    const auto said = bytes_of(folder / "stderr");
    EXPECT_TRUE(has(said, "doppel: interrupted; ")) << said;
    EXPECT_TRUE(has(said, "kept in " + record_ + ": the same command resumes"));
    expect_record_alone();
    // another preset does not resume from it, and does not change it
    const auto bytes = bytes_of(folder / record_);
    const auto other = done(with(long_map, "--set scene.duration_s=0.1 --progress plain"));
    EXPECT_TRUE(has(other.err, "ignoring " + record_ + ", of another preset or version"));
    EXPECT_EQ(bytes_of(folder / record_), bytes);
}

// Commands of README.md and docs/figures.md, run in a shell.

const std::string settings = " --set grid.x.to=20 --set scene.duration_s=0.5 --size 320x180 --progress none";

void expect_merged(const fs::path& folder) {
    const auto merge = shell(program + "figure fig2-right --merge" + settings);
    EXPECT_EQ(merge.code, 0) << merge.err;
    EXPECT_EQ(shell(program + "figure fig2-right -o whole" + settings).code, 0);
    for (const char* file : {"fig2-right.csv", "fig2-right.png"})
        EXPECT_TRUE(bytes_of(folder / "out/fig2-right" / file) == bytes_of(folder / "whole/fig2-right" / file)) << file;
}

TEST_F(Recipe, SlurmArray) {
    write_bytes(folder / "job.sh",
                "#!/bin/sh\n#SBATCH --array=1-3\n\"$DOPPEL\" figure fig2-right --shard "
                "\"$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT\"" +
                    settings + "\n");
    const auto jobs = shell(
        "export SLURM_ARRAY_TASK_COUNT=3\n"
        "for i in 1 2 3; do SLURM_ARRAY_TASK_ID=$i sh job.sh & tasks=\"$tasks $!\"; done\n"
        "for task in $tasks; do wait $task || exit; done");
    EXPECT_EQ(jobs.code, 0) << jobs.err;
    for (int i = 1; i <= 3; ++i)
        EXPECT_TRUE(has(jobs.out, "out/fig2-right/fig2-right." + std::to_string(i) + "-of-3.shard"));
    expect_merged(folder);
}

TEST_F(Recipe, GnuParallel) {
    // xargs if there is no GNU parallel: it runs the same commands, with {} replaced
    const auto jobs = shell(
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
