// Figures merged from parts.
#include "figure/run.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::merge_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::expect_error;
using test::fresh_folder;
using test::write_bytes;

class Merge : public testing::Test {
protected:
    void SetUp() override {
        out_ = fresh_folder();
        folder_ = out_ / "fig2-right";
        for (int i = 1; i <= 3; ++i) run_figure(small_sweep(), {.out = out_, .shard = Shard{i, 3}});
    }
    fs::path part(int i) const { return folder_ / fmt::format("fig2-right.{}-of-3.shard", i); }

    void expect_refused(ExitCode code, const std::vector<std::string>& words,
                        const FigurePreset& figure = small_sweep()) const {
        const auto before = names_in(folder_);
        expect_error(code, words, [&] { run_figure(figure, {.out = out_, .merge = true}); });
        EXPECT_EQ(names_in(folder_), before);
    }
    /// Replaces text in a part's header.
    void edit(int i, const std::string& from, const std::string& to) const {
        auto bytes = bytes_of(part(i));
        const auto at = bytes.find(from);
        ASSERT_LT(at, bytes.find('\n')) << bytes;
        write_bytes(part(i), bytes.replace(at, from.size(), to));
    }

    fs::path out_, folder_;
};

TEST_F(Merge, JoinsWhatIsThereAndComputesNothing) {
    EXPECT_EQ(names_in(folder_), (std::vector<std::string>{"fig2-right.1-of-3.shard", "fig2-right.2-of-3.shard",
                                                           "fig2-right.3-of-3.shard"}));
    const auto result = run_figure(small_sweep(), {.out = out_, .merge = true});
    EXPECT_EQ(result.samples, 0);
    EXPECT_EQ(bytes_of(folder_ / "fig2-right.csv"), table_text(small_sweep(), computed(small_sweep())));
    EXPECT_TRUE(fs::exists(folder_ / "fig2-right.png"));
    // another picture of the same numbers
    run_figure(small_sweep({"chart.theme=\"dark\""}), {.out = out_, .merge = true});
}

/// Repeating a finished shard does nothing; a damaged shard computes what is missing.
TEST_F(Merge, TakesFinishedPartsAsTheyAre) {
    const auto bytes = bytes_of(part(2));
    const auto time = fs::last_write_time(part(2));
    EXPECT_EQ(run_figure(small_sweep(), {.out = out_, .shard = Shard{2, 3}}).samples, 0);
    EXPECT_EQ(fs::last_write_time(part(2)), time);
    // without the last bytes of the end, and of the last trial before it
    for (const auto& [missing, trials] : {std::pair(2, 0), {18, 1}}) {
        write_bytes(part(2), bytes.substr(0, bytes.size() - static_cast<std::size_t>(missing)));
        EXPECT_EQ(run_figure(small_sweep(), {.out = out_, .shard = Shard{2, 3}}).samples, trials);
        EXPECT_EQ(bytes_of(part(2)), bytes);
    }
    EXPECT_EQ(names_in(folder_).size(), 3u);
    // the part of another preset
    EXPECT_EQ(run_figure(small_sweep({"grid.difference=0.004"}), {.out = out_, .shard = Shard{2, 3}}).samples, 3);
    EXPECT_NE(bytes_of(part(2)), bytes);
}

TEST_F(Merge, NamesThePartsThatAreMissing) {
    fs::remove(part(2));
    expect_refused(ExitCode::try_again, {"missing", "2/3"});
    fs::remove(part(3));
    expect_refused(ExitCode::try_again, {"missing", "2/3, 3/3"});
    fs::remove(part(1));
    expect_refused(ExitCode::try_again, {"contains no shard of fig2-right", "--shard"});
}

TEST_F(Merge, NamesTheFirstOfManyMissing) {
    for (int i = 1; i <= 3; ++i) fs::remove(part(i));
    run_figure(small_sweep(), {.out = out_, .shard = Shard{3, 100'000}});
    const auto message = error_of([&] { run_figure(small_sweep(), {.out = out_, .merge = true}); }).second;
    EXPECT_NE(message.find("missing shards: 1/100000, 2/100000, 4/100000, 5/100000, 6/100000 … 99999 in all"),
              std::string::npos)
        << message.substr(0, 1000);
    EXPECT_LT(message.size(), folder_.string().size() + 150);
}

TEST_F(Merge, RefusesAPartThatIsThereTwice) {
    const auto copy = folder_ / "fig2-right.1-of-3 (copy).shard";
    fs::copy_file(part(1), copy);
    expect_refused(ExitCode::bad_input, {part(1).string(), copy.string(), "both shard 1/3"});
    fs::remove(copy);
    fs::copy_file(part(1), part(2), fs::copy_options::overwrite_existing);
    expect_refused(ExitCode::bad_input, {part(1).string(), part(2).string(), "both shard 1/3"});
}

TEST_F(Merge, RejectsAChangedDigit) {
    const auto bytes = bytes_of(part(2));
    const auto expect_damaged = [&] {
        expect_refused(ExitCode::io_failed, {part(2).string(), "is damaged or incomplete", "--shard 2/3"});
    };
    auto digit = bytes;
    const auto start = bytes.find('\n') + 1, number = start + 16 + 16;  // after the block's head, trial and size
    digit[number] = static_cast<char>(digit[number] ^ 1);
    write_bytes(part(2), digit);
    expect_damaged();
    // blocks of another part, after the end and in its place, and numbers of no trial
    const auto other = bytes_of(part(1)), blocks = other.substr(other.find('\n') + 1);
    for (const auto& whole : {bytes, bytes.substr(0, bytes.size() - 16)}) {
        write_bytes(part(2), whole + blocks);
        expect_damaged();
    }
    PartWriter(part(2), header_of(small_sweep(), {2, 3}), KnownTrials(10, {1, 2})).finish();
    expect_damaged();
}

TEST_F(Merge, RefusesPartsOfAnotherPreset) {
    expect_refused(ExitCode::bad_input, {part(1).string(), "preset"}, small_sweep({"grid.difference=0.004"}));
    expect_refused(ExitCode::bad_input, {part(1).string(), "preset"}, small_sweep({"grid.x.step=0.5"}));
}

TEST_F(Merge, RefusesPartsOfAnotherVersionOrRevision) {
    edit(2, "\"version\":\"", "\"version\":\"9");
    expect_refused(ExitCode::bad_input, {part(2).string(), "another version: 9", "--shard 2/3"});
    edit(2, "\"version\":\"9", "\"version\":\"");
    edit(3, "\"revision\":\"", "\"revision\":\"x");
    expect_refused(ExitCode::bad_input, {part(3).string(), "another revision: x", "--shard 3/3"});
    edit(3, "\"revision\":\"x", "\"revision\":\"");
    edit(3, "\"figure\":\"fig2", "\"figure\":\"fig4");
    expect_refused(ExitCode::bad_input, {part(3).string(), "another figure: fig4-right"});
}

TEST_F(Merge, RefusesPartsOfDifferentNumbers) {
    run_figure(small_sweep(), {.out = out_, .shard = Shard{2, 4}});
    expect_refused(ExitCode::bad_input, {"fig2-right.2-of-4.shard", "remove those that do not belong"});
}

TEST_F(Merge, RefusesAPartThatIsCut) {
    const auto bytes = bytes_of(part(2));
    write_bytes(part(2), bytes.substr(0, bytes.size() - 1));
    expect_refused(ExitCode::io_failed, {part(2).string(), "is damaged or incomplete", "--shard 2/3"});
    write_bytes(part(2), "my diary");
    expect_refused(ExitCode::io_failed, {part(2).string()});
}

TEST_F(Merge, IgnoresPartsOfOtherNames) {
    write_bytes(folder_ / "fig2-right-mine.1-of-2.shard", "my diary");
    write_bytes(folder_ / "fig2-right.1-of-3.shard.part", "cut");
    run_figure(small_sweep(), {.out = out_, .merge = true});
    EXPECT_TRUE(fs::exists(folder_ / "fig2-right.csv"));
}

TEST(MergeOfNothing, SaysHowToMakeParts) {
    const auto out = fresh_folder() / "out";
    expect_error(ExitCode::try_again, {"fig2-right", "--shard I/N"},
                 [&] { run_figure(small_sweep(), {.out = out, .merge = true}); });
    EXPECT_TRUE(!fs::exists(out) || names_in(out).empty());
}

/// An orbit that never returns to the section has no points, but counts as computed.
TEST(MergeOfNothing, ReportsUnknownTrials) {
    const auto out = fresh_folder();
    const auto figure = figure_from(
        "[scene]\nkind = \"section\"\n[system]\ngravity_m_per_s2 = 1e-9\n[section]\nenergy_J = [1e-6]\n"
        "orbits = 2\ncrossings = 1\n[chart]\nsize = [320, 180]");
    const auto trials = computed(figure);
    const bool any_empty = std::any_of(trials.begin(), trials.end(), [](const auto& t) { return t.empty(); });
    for (int i = 1; i <= 2; ++i) run_figure(figure, {.out = out, .shard = Shard{i, 2}});
    run_figure(figure, {.out = out, .merge = true});
    EXPECT_EQ(bytes_of(out / "x/x.csv"), table_text(figure, trials)) << any_empty;
}

}  // namespace doppel::merge_test
