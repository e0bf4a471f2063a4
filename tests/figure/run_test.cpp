#include "figure/run.hpp"

#include "figure/support.hpp"
#include "output/png.hpp"
#include "output/written.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace doppel::run_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::expect_error;
using test::fresh_folder;
using test::write_bytes;

nlohmann::json manifest_of(const fs::path& out, const std::string& name) {
    return nlohmann::json::parse(bytes_of(out / name / (name + ".json")));
}

TEST(FigureRun, WritesPictureTableAndManifest) {
    const auto out = fresh_folder();
    const auto result = run_figure(small_sweep({"chart.scale=2"}), {.out = out});
    EXPECT_EQ(names_in(out / "fig2-right"),
              (std::vector<std::string>{"fig2-right.csv", "fig2-right.json", "fig2-right.png"}));
    EXPECT_EQ(result.files.size(), 3u);
    for (const auto& file : result.files) EXPECT_TRUE(fs::exists(file)) << file;
    EXPECT_EQ(read_png(out / "fig2-right/fig2-right.png").size, (Size{640, 360}));
    EXPECT_EQ(bytes_of(out / "fig2-right/fig2-right.csv"), table_text(small_sweep(), computed(small_sweep())));
}

TEST(FigureRun, ManifestTellsWhatTheFigureIs) {
    const auto out = fresh_folder();
    const auto figure = small_sweep({"grid.right=\"exponent\"", "grid.exponent_duration_s=10"});
    run_figure(figure, {.out = out, .jobs = 2});
    const auto manifest = manifest_of(out, "fig2-right");
    EXPECT_EQ(manifest["figure"], "fig2-right");
    EXPECT_EQ(manifest["kind"], "grid");
    EXPECT_EQ(manifest["title"], figure.title);
    EXPECT_EQ(manifest["erratum"], figure.erratum);
    EXPECT_FALSE(figure.erratum.empty());
    EXPECT_EQ(manifest["trials"], 10);
    EXPECT_EQ(manifest["threads"], 2);
    EXPECT_EQ(manifest["resolved_preset"]["grid"]["x"]["to"], 9);
    EXPECT_EQ(manifest["resolved_preset"]["a"]["integrator"], "dop853");
    EXPECT_FALSE(manifest["doppel"]["version"].get<std::string>().empty());
    EXPECT_FALSE(manifest["libraries"]["drawing"].get<std::string>().empty());
}

TEST(FigureRun, ManifestHoldsTheHashesOfItsFiles) {
    const auto out = fresh_folder();
    run_figure(small_sweep(), {.out = out});
    const auto files = manifest_of(out, "fig2-right")["files"];
    EXPECT_EQ(files.size(), 2u);
    for (const auto& [name, facts] : files.items()) {
        const auto bytes = bytes_of(out / "fig2-right" / name);
        EXPECT_EQ(facts["bytes"], bytes.size()) << name;
        EXPECT_EQ(facts["sha256"], sha256_of_text(bytes)) << name;
    }
}

TEST(FigureRun, DrawsTheRightQuantityIfTheOtherFailed) {
    const auto out = fresh_folder();
    // every pair fails, and exponents are drawn
    run_figure(figure_of("fig2-right", {"grid.x.from=60", "grid.x.to=62", "scene.sample_hz=1", "scene.duration_s=3000",
                                        "system.step_s=1", "grid.right=\"exponent\"", "grid.exponent_duration_s=10"}),
               {.out = out});
    EXPECT_TRUE(fs::exists(out / "fig2-right/fig2-right.png"));
}

TEST(FigureRun, MakesSeveralOfSeveralSizes) {
    const auto out = fresh_folder();
    const auto one = small_sweep(), other = figure_of("fig6", {"scene.duration_s=1", "chart.size=[480, 270]"}),
               third = figure_of("fig4-right", small_chart);
    Said said;
    const std::atomic<bool> never = false;
    run_figures({one, other, third}, {.out = out, .jobs = 3}, never, said.run_report());
    EXPECT_EQ(said.results.size(), 3u);
    for (const auto* figure : {&one, &other, &third}) {
        const auto base = (out / figure->name / figure->name).string();
        EXPECT_EQ(bytes_of(base + ".csv"), table_text(*figure, computed(*figure)));
        EXPECT_EQ(read_png(fs::path(base + ".png")).size, figure->chart.size);
        const auto alone = out / "alone";
        run_figure(*figure, {.out = alone});
        EXPECT_TRUE(bytes_of(base + ".png") == bytes_of(alone / figure->name / (figure->name + ".png"))) << base;
    }
}

TEST(FigureRun, LeavesNothingWhereItIsStopped) {
    const auto out = fresh_folder() / "out";
    Said said;
    const std::atomic<bool> stop = true;
    expect_error(ExitCode::interrupted, {"interrupted"}, [&] {
        run_figures({small_sweep(), figure_of("fig6")}, {.out = out}, stop, said.run_report());
    });
    EXPECT_TRUE(!fs::exists(out) || names_in(out).empty());
}

TEST(FigureRun, LeavesNothingOnAFullDisk) {
    const auto out = fresh_folder() / "out";
    {
        const test::FullDisk disk(3000);
        expect_error(ExitCode::io_failed, {"out/fig2-right"}, [&] { run_figure(small_sweep(), {.out = out}); });
    }
    EXPECT_TRUE(!fs::exists(out) || names_in(out).empty());
}

TEST(FigureRun, KeepsTheFilesOfAnEarlierRunIfItFails) {
    const auto out = fresh_folder();
    run_figure(small_sweep(), {.out = out});
    const auto table = bytes_of(out / "fig2-right/fig2-right.csv");
    Said said;
    const std::atomic<bool> stop = true;
    EXPECT_THROW(run_figures({small_sweep({"grid.x.step=3"})}, {.out = out}, stop, said.run_report()), Error);
    EXPECT_EQ(bytes_of(out / "fig2-right/fig2-right.csv"), table);
    EXPECT_EQ(names_in(out / "fig2-right").size(), 3u);
}

TEST(FigureRun, FailsIfAMethodFails) {
    const auto out = fresh_folder() / "out";
    const auto figure = figure_of("fig4-left", {"system.step_s=\"1/3\"", "scene.sample_hz=3", "scene.duration_s=3000"});
    expect_error(ExitCode::method_failed, {}, [&] { run_figure(figure, {.out = out}); });
    EXPECT_TRUE(!fs::exists(out) || names_in(out).empty());
}

/// The second sentence of an error says what would be right.
TEST(FigureRun, FailsIfEveryPairOfASweepFails) {
    const auto out = fresh_folder() / "out";
    for (const char* method : {"euler", "rk4"}) {  // both in batches
        const auto figure = figure_of("fig2-right", {"grid.x.from=60", "grid.x.to=80", "grid.x.step=5",
                                                     "scene.sample_hz=1", "scene.duration_s=3000", "system.step_s=1",
                                                     fmt::format("system.integrator=\"{}\"", method)});
        expect_error(ExitCode::method_failed, {"fig2-right: all of the 5 pairs failed", "a smaller step"},
                     [&] { run_figure(figure, {.out = out}); });
        EXPECT_TRUE(!fs::exists(out) || names_in(out).empty());
    }
    // the same pair by the films' loop, and merged from parts
    const auto alone =
        figure_of("fig2-right", {"grid.x.from=60", "grid.x.to=62", "scene.sample_hz=1", "scene.duration_s=3000",
                                 "system.step_s=1", "system.model=\"mechanism\""});
    expect_error(ExitCode::method_failed, {"all of the 3 pairs failed"}, [&] { run_figure(alone, {.out = out}); });
    for (int i = 1; i <= 2; ++i) run_figure(alone, {.out = out, .shard = Shard{i, 2}});
    expect_error(ExitCode::method_failed, {"all of the 3 pairs failed"},
                 [&] { run_figure(alone, {.out = out, .merge = true}); });
    EXPECT_EQ(names_in(out / "fig2-right").size(), 2u);
}

TEST(FigureRun, DrawsASweepWithSomeFailedPairs) {
    const auto out = fresh_folder();
    const auto figure = figure_of("fig2-right", {"grid.x.step=30", "scene.sample_hz=5", "scene.duration_s=6",
                                                 "system.step_s=\"1/5\"", "chart.size=[320, 180]"});
    run_figure(figure, {.out = out});
    const auto rows = Table(bytes_of(out / "fig2-right/fig2-right.csv")).rows;
    const auto failed = std::ranges::count_if(rows, [](const auto& row) { return std::isnan(row[1]); });
    EXPECT_GT(failed, 0);
    EXPECT_LT(failed, 7);
}

TEST(FigureRun, FailsWhereAFigureHasNothingToDraw) {
    const auto out = fresh_folder() / "out";
    // both hang at rest, with different gravity
    const auto at_rest = [](const std::string& kind, const std::string& keys) {
        return figure_from("[scene]\nkind = \"" + kind +
                           "\"\nduration_s = \"1/2\"\n[system]\nangle_deg = [0, 0]\n[b]\ngravity_m_per_s2 = 9\n" +
                           keys);
    };
    const std::string over_lengths = "[grid.x]\nkey = \"system.length_m\"\nfrom = 1\nto = 3\npoints = 3\n",
                      over_masses = "[grid.y]\nkey = \"system.mass_kg\"\nfrom = 1\nto = 2\npoints = 3\n";
    const std::vector<std::pair<FigurePreset, std::string>> all{
        {at_rest("series", "[series]\nlogarithmic = true\n"), "nothing is greater than 0"},
        {at_rest("grid", "[grid]\nquantity = \"distance_at_end\"\n" + over_lengths + over_masses),
         "none of the 3 × 3 pairs has a distance_at_end above 0"},
        {at_rest("grid", "[grid]\nquantity = \"energy_error\"\n" + over_lengths),
         "none of the 3 pairs has an energy_error above 0"},
        {at_rest("grid", "[grid]\nquantity = \"energy_error\"\n" + over_lengths + over_masses),
         "none of the 3 × 3 pairs has an energy_error above 0"},
        {at_rest("grid",
                 "[grid]\nquantity = \"flip_time\"\n[grid.x]\nfrom = -10\nto = 10\npoints = 3\n[grid.y]\nkey = "
                 "\"theta2_deg\"\nfrom = -10\nto = 10\npoints = 3\n"),
         "none of the 3 × 3 pairs has a flip_time: no flip within 0.5 s"},
        {figure_of("flip-map", {"grid.x.points=4", "grid.y.points=4", "grid.x.from=-30", "grid.x.to=30",
                                "grid.y.from=-30", "grid.y.to=30"}),
         "none of the 4 × 4 pairs has a flip_time: no flip within 20 s"},
        {figure_of("stability", {"grid.panel.values=[\"euler\"]", "grid.y.points=2", "grid.x.points=2",
                                 "grid.x.from=0.5", "grid.x.to=1"}),
         "all of the 2 × 2 pairs failed"},
        {figure_of("poincare", {"system.gravity_m_per_s2=1e-12", "section.energy_J=[1e-12]", "section.orbits=2",
                                "section.exponent_duration_s=10"}),
         "no orbit comes back"},
        {figure_of("speed-accuracy", {"chart.cost=\"evaluations\"", "work_precision.problems=[\"P4\"]",
                                      "work_precision.methods=[\"semi-implicit-euler\"]",
                                      "work_precision.models=[\"angles\"]", "work_precision.most_evaluations=150"}),
         "no run of any method"},
        {figure_of("drift", {"series.duration_s=10", "series.methods=[\"rk4\"]", "series.projected=[]",
                             "system.angle_deg=[0, 0]"}),
         "no method has an error"}};
    for (const auto& [figure, words] : all) {
        SCOPED_TRACE(words);
        // a record of its trials, as a slow run leaves it
        const auto header = header_of(figure);
        fs::create_directories(out / figure.name);
        PartWriter(out / figure.name / resume_name(header), header, KnownTrials(header.trials)).finish();
        expect_error(ExitCode::method_failed, {figure.name + ": ", words}, [&] { run_figure(figure, {.out = out}); });
        EXPECT_TRUE(!fs::exists(out / figure.name) || names_in(out / figure.name).empty());
    }
}

/// A request to stop also works between computing, drawing and writing.
TEST(FigureRun, StopsBetweenItsStages) {
    const auto out = fresh_folder() / "out";
    std::atomic<bool> stop = false;
    const FigureReport report{[&](std::size_t, const FigureProgress& p) { stop = p.done == p.total; },
                              [](std::size_t, const std::string&) {}, [](std::size_t, const RunResult&) {}};
    expect_error(ExitCode::interrupted, {"interrupted"},
                 [&] { run_figures({small_sweep()}, {.out = out, .jobs = 1}, stop, report); });
    EXPECT_TRUE(!fs::exists(out) || names_in(out).empty());
    run_figure(small_sweep(), {.out = out, .shard = Shard{1, 1}});
    stop = true;
    expect_error(ExitCode::interrupted, {"interrupted"},
                 [&] { run_figures({small_sweep()}, {.out = out, .merge = true}, stop, report); });
    EXPECT_EQ(names_in(out / "fig2-right"), std::vector<std::string>{"fig2-right.shard"});
}

// Resuming.

TEST(Resume, OfAnotherRunStaysAsItIs) {
    const auto out = fresh_folder();
    const auto folder = out / "fig2-right";
    fs::create_directory(folder);
    const auto large = small_sweep({"grid.x.step=0.5"});
    const auto record = folder / resume_name(header_of(large)), other = folder / resume_name(header_of(large, {2, 3}));
    for (const auto& path : {record, other}) PartWriter(path, header_of(large), KnownTrials(19, {1})).finish();
    const auto bytes = bytes_of(record);
    Said said;
    run_figure(small_sweep(), {.out = out}, said);
    EXPECT_TRUE(said.has("ignoring " + record.string() + ", of another preset or version"));
    EXPECT_EQ(said.notes.size(), 1u);  // no note about the other part
    EXPECT_EQ(bytes_of(record), bytes);
    EXPECT_EQ(bytes_of(folder / "fig2-right.csv"), table_text(small_sweep(), computed(small_sweep())));
    EXPECT_EQ(names_in(folder).size(), 5u);
    // its own record is used, and then removed
    run_figure(large, {.out = out}, said);
    EXPECT_TRUE(said.has("resuming from " + record.string() + ": 100 % is done"));
    EXPECT_FALSE(fs::exists(record));
    EXPECT_TRUE(fs::exists(other));
}

}  // namespace doppel::run_test
