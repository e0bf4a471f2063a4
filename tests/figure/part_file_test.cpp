#include "figure/part_file.hpp"

#include "figure/computation.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <random>

namespace doppel {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::expect_error;
using test::fresh_folder;
using test::write_bytes;

constexpr double infinite = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();

PartHeader some_header(std::size_t trials) {
    return {"some", "0.1.0", "abc", "cafe", trials, 1, 1};
}

void expect_same_bits(const TrialNumbers& a, const TrialNumbers& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_TRUE(std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]) ||
                    (std::isnan(a[i]) && std::isnan(b[i])))
            << a[i] << " and " << b[i];
}

/// Numbers of all sizes and none at all.
KnownTrials some_trials() {
    using Limits = std::numeric_limits<double>;
    KnownTrials trials{{0.0, -0.0, none, infinite, -infinite, -none},
                       {Limits::min(), Limits::max(), -Limits::max(), Limits::denorm_min(), -Limits::denorm_min()},
                       {0.1, 1.0 / 3, 1e22, 1e23, 9007199254740993.0, 5e-324, 123456789012345680.0}};
    std::mt19937_64 random(1);
    for (int i = 0; i < 20; ++i) {
        auto& numbers = trials.emplace_back();
        while (numbers.size() < 50)
            if (const auto x = std::bit_cast<double>(random()); !std::isnan(x)) numbers.push_back(x);
    }
    return trials;
}

TEST(PartFile, KeepsEveryNumberToTheBit) {
    const auto path = fresh_folder() / "some.resume";
    const auto trials = some_trials();
    const PartHeader header{"some \"figure\"", "0.1.0", "abc-dirty", "cafe", trials.size(), 2, 3};
    PartWriter writer(path, header, {});
    for (std::size_t i = trials.size(); i-- > 0;) writer.add(i, trials[i]);  // in any order
    writer.close();
    const auto read = read_part_file(path);
    EXPECT_EQ(read.header, header);
    ASSERT_EQ(read.trials.size(), trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) expect_same_bits(read.trials[i], trials[i]);
}

TEST(PartFile, BeginsWithWhatIsKnownAndReplacesAnOlderOne) {
    const auto path = fresh_folder() / "some.resume";
    write_bytes(path, "something older");
    PartWriter writer(path, some_header(3), {{1.5}, {}, {2.5, none}});
    const auto read = read_part_file(path);  // before it is closed
    expect_same_bits(read.trials[0], {1.5});
    EXPECT_TRUE(read.trials[1].empty());
    expect_same_bits(read.trials[2], {2.5, none});
    writer.add(1, {7});
    writer.flush();
    expect_same_bits(read_part_file(path).trials[1], {7});
}

TEST(PartFile, LeavesOutALastLineCutAtAnyByte) {
    const auto folder = fresh_folder();
    const KnownTrials trials{{1.25, -2e-300}, {none, 12345}, {infinite, 3}};
    PartWriter(folder / "whole", some_header(3), trials).close();
    const auto bytes = bytes_of(folder / "whole");
    const auto header = bytes.find('\n') + 1;
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        write_bytes(folder / "cut", bytes.substr(0, cut));
        if (cut + 1 < header) {
            expect_error(ExitCode::io_failed, {(folder / "cut").string()}, [&] { read_part_file(folder / "cut"); });
            continue;
        }
        const auto read = read_part_file(folder / "cut");
        const auto whole = static_cast<std::size_t>(std::count(bytes.begin() + static_cast<long>(std::min(cut, header)),
                                                               bytes.begin() + static_cast<long>(cut), '\n'));
        for (std::size_t i = 0; i < trials.size(); ++i) {
            if (i < whole)
                expect_same_bits(read.trials[i], trials[i]);
            else
                EXPECT_TRUE(read.trials[i].empty()) << "cut at " << cut;
        }
    }
}

TEST(PartFile, StopsAtALineThatIsNone) {
    const auto path = fresh_folder() / "some.resume";
    PartWriter(path, some_header(9), {{1}, {2}}).close();
    const auto good = bytes_of(path);
    for (const char* line :
         {"x", "2,", "2,1e", "2,1,x", "2;1", "9,1", "-1,1", "2,1 ", ",1", "", "99999999999999999999,1"}) {
        write_bytes(path, good + line + "\n3,4\n");
        const auto read = read_part_file(path);
        expect_same_bits(read.trials[0], {1});
        expect_same_bits(read.trials[1], {2});
        EXPECT_TRUE(read.trials[2].empty()) << line;
        EXPECT_TRUE(read.trials[3].empty()) << line;
    }
}

/// A header's JSON with one key changed.
std::string with_key(const std::string& key, const std::string& value) {
    std::string text = "{\"file\":\"doppel trials\"";
    for (const auto& [name, usual] : std::vector<std::pair<std::string, std::string>>{{"figure", "\"some\""},
                                                                                      {"version", "\"0.1.0\""},
                                                                                      {"revision", "\"abc\""},
                                                                                      {"preset_sha256", "\"cafe\""},
                                                                                      {"trials", "3"},
                                                                                      {"shard", "1"},
                                                                                      {"of", "1"}})
        if (name != key || !value.empty()) text += fmt::format(",\"{}\":{}", name, name == key ? value : usual);
    return text + "}\n0,1\n";
}

TEST(PartFile, RefusesWhatIsSomethingElse) {
    const auto path = fresh_folder() / "some.resume";
    write_bytes(path, with_key("", ""));
    EXPECT_EQ(read_part_file(path).header, some_header(3));
    const std::vector<std::string> others{"",
                                          "\n",
                                          "sample,time_s\r\n0,0\r\n",
                                          "[]\n",
                                          "3\n",
                                          "null\n",
                                          "{}\n",
                                          "{\"file\":\"a table\"}\n",
                                          "\x89PNG\r\n\x1a\n",
                                          with_key("figure", ""),
                                          with_key("figure", "3"),
                                          with_key("trials", "\"many\""),
                                          with_key("trials", "null"),
                                          with_key("preset_sha256", "")};
    for (const auto& other : others) {
        write_bytes(path, other);
        expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
    }
    fs::remove(path);
    expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
    fs::create_directory(path);
    expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
}

TEST(PartFile, RefusesPartsThatCannotBe) {
    const auto path = fresh_folder() / "some.shard";
    for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{{"of", "0"},
                                                                                     {"of", "-2"},
                                                                                     {"shard", "0"},
                                                                                     {"shard", "2"},
                                                                                     {"shard", "-1"},
                                                                                     {"trials", "-1"},
                                                                                     {"trials", "1000000000000000"}}) {
        write_bytes(path, with_key(key, value));
        expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
    }
}

TEST(PartFile, ReportsWhereItCannotBeWritten) {
    const auto folder = fresh_folder();
    expect_error(ExitCode::io_failed, {(folder / "none/some").string()},
                 [&] { PartWriter(folder / "none/some", some_header(1), {}); });
    fs::create_directories(folder / "taken/inside");
    expect_error(ExitCode::io_failed, {(folder / "taken").string()},
                 [&] { PartWriter(folder / "taken", some_header(1), {}); });
    const test::FullDisk disk(1000);
    expect_error(ExitCode::io_failed, {(folder / "full").string()}, [&] {
        PartWriter writer(folder / "full", some_header(1), {});
        for (int i = 0; i < 10'000; ++i) writer.add(0, {0.1234567});
        writer.close();
    });
}

TEST(PartHeader, PartsAreAllOfItAndDiffByATrialAtMost) {
    for (const std::size_t trials : {1u, 5u, 181u, 1000u})
        for (const int of : {1, 2, 3, 7, 181, 400}) {
            std::size_t next = 0, least = trials, most = 0;
            for (int i = 1; i <= of; ++i) {
                auto header = some_header(trials);
                header.shard = i;
                header.of = of;
                EXPECT_EQ(header.first(), next);
                least = std::min(least, header.last() - header.first());
                most = std::max(most, header.last() - header.first());
                next = header.last();
            }
            EXPECT_EQ(next, trials);
            EXPECT_LE(most - least, 1u);
        }
}

TEST(PartHeader, IsThatOfTheNumbersAlone) {
    const auto figure = figure_of("fig2-right"),
               drawn = figure_of("fig2-right", {"chart.theme=\"dark\"", "title=\"x\""}),
               other = figure_of("fig2-right", {"sweep.difference=0.004"});
    EXPECT_EQ(header_of(figure), header_of(drawn));
    EXPECT_NE(header_of(figure).preset, header_of(other).preset);
    EXPECT_NE(header_of(figure, 1, 2), header_of(figure));
}

// Going on from a record.

FigurePreset small_sweep() {
    return figure_of("fig2-right", {"sweep.to=9", "scene.duration_s=0.5"});
}

/// A computation that goes on from `record`, and what came of it.
struct Resumed {
    Said said;
    KnownTrials trials;
    double computed_units = 0;

    Resumed(const FigurePreset& figure, const PartHeader& header, const fs::path& record) {
        Computation computation(figure, header, record, 1, said.report());
        const std::atomic<bool> never = false;
        for (std::size_t group = 0; group < computation.groups(); ++group)
            EXPECT_EQ(computation.compute(group, never), group + 1 == computation.groups());
        trials = computation.take();
        computed_units = computation.computed_units();
    }
};

TEST(Computation, ComputesOnlyWhatARecordDoesNotHave) {
    const auto record = fresh_folder() / "x.resume";
    const auto figure = small_sweep();
    const auto expected = computed(figure);
    KnownTrials known(10);
    for (const std::size_t trial : {0u, 1u, 4u, 9u})
        known[trial] = {100.0 + static_cast<double>(trial)};  // to be told apart
    PartWriter(record, header_of(figure), known).close();

    const Resumed resumed(figure, header_of(figure), record);
    EXPECT_EQ(resumed.computed_units, 6);
    EXPECT_TRUE(resumed.said.has("goes on from " + record.string() + ": 40 % is done"));
    ASSERT_FALSE(resumed.said.progress.empty());
    EXPECT_EQ(resumed.said.progress.back().done, 10);
    EXPECT_EQ(resumed.said.progress.back().total, 10);
    for (std::size_t i = 0; i < known.size(); ++i)
        EXPECT_EQ(resumed.trials[i], known[i].empty() ? expected[i] : known[i]) << i;
}

TEST(Computation, NeedsNothingWhereARecordHasAll) {
    const auto record = fresh_folder() / "x.resume";
    const auto figure = small_sweep();
    const auto expected = computed(figure);
    PartWriter(record, header_of(figure), expected).close();
    const Resumed resumed(figure, header_of(figure), record);
    EXPECT_EQ(resumed.trials, expected);
    EXPECT_EQ(resumed.computed_units, 0);
}

TEST(Computation, LeavesARecordOfSomethingElseAlone) {
    const auto record = fresh_folder() / "x.resume";
    const auto figure = small_sweep();
    const auto expected = computed(figure);
    const KnownTrials wrong(10, {100});
    auto headers = std::vector<PartHeader>(6, header_of(figure));
    headers[0].preset = "cafe";
    headers[1].version = "0.0.9";
    headers[2].revision = "other";
    headers[3].figure = "other";
    headers[4].of = 2;
    headers[5].trials = 11;
    for (const auto& header : headers) {
        PartWriter(record, header, wrong).close();
        const Resumed resumed(figure, header_of(figure), record);
        EXPECT_EQ(resumed.trials, expected);
        EXPECT_EQ(resumed.computed_units, 10);
        EXPECT_TRUE(resumed.said.has(record.string() + " belongs to another preset or version; starting anew"));
    }
    write_bytes(record, "my diary");
    expect_error(ExitCode::io_failed, {record.string()}, [&] { Resumed(figure, header_of(figure), record); });
    EXPECT_EQ(bytes_of(record), "my diary");
}

TEST(Computation, KeepsToItsPart) {
    const auto figure = small_sweep();
    const auto expected = computed(figure);
    const auto header = header_of(figure, 2, 3);
    const Resumed part(figure, header, "");
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(part.trials[i], i >= header.first() && i < header.last() ? expected[i] : TrialNumbers{}) << i;
}

TEST(Computation, StopsSoonAndKeepsARecordFromBefore) {
    const auto record = fresh_folder() / "x.resume";
    const auto figure = small_sweep();
    KnownTrials known(10);
    known[3] = {1};
    PartWriter(record, header_of(figure), known).close();
    Said said;
    Computation computation(figure, header_of(figure), record, 1, said.report());
    const std::atomic<bool> stop = true;
    expect_error(ExitCode::interrupted, {"interrupted"}, [&] { computation.compute(0, stop); });
    EXPECT_EQ(read_part_file(record).trials[3], TrialNumbers{1});
    EXPECT_EQ(Resumed(figure, header_of(figure), record).computed_units, 9);
}

}  // namespace
}  // namespace doppel
