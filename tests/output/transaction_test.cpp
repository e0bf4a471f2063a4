#include "output/transaction.hpp"

#include "output/fixtures.hpp"
#include "output/png.hpp"
#include "output/system_calls.hpp"
#include "output/written.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <csignal>
#include <set>
#include <thread>

namespace doppel::transaction_test {

using namespace test;

namespace fs = std::filesystem;

/// All paths below `folder`, relative to it.
std::set<std::string> listing(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        names.insert(entry.path().lexically_relative(folder));
    return names;
}

using Names = std::set<std::string>;

const std::string hidden = ".doppel-run", lock = ".doppel-run/.lock";

void write_part(Transaction& files, const std::string& name, const std::string& bytes) {
    write_bytes(files.file(name), bytes);
}

void write_picture(Transaction& files, const std::string& name) {
    write_bytes(files.directory("frames") / name, "picture");
}

/// The listing of a folder while a run has these files in its hidden folder.
Names in_hidden(const Names& names) {
    Names all{hidden, lock};
    for (const auto& name : names) all.insert(hidden + "/" + name);
    return all;
}

/// A manifest with these names; creates each in `folder`.
void write_record(const fs::path& folder, const std::vector<std::string>& names) {
    std::string files;
    for (const auto& name : names) files += fmt::format(R"({}"{}": {{}})", files.empty() ? "" : ", ", name);
    write_bytes(folder / "record.json", R"({"doppel": {}, "files": {)" + files + "}}");
}

TEST(Transaction, AppearTogetherWhenPublished) {
    const auto out = fresh_folder();
    Transaction files(out / "a/b");
    write_part(files, "x.csv", "table");
    write_part(files, "x.mp4", "video");
    write_picture(files, "0.png");
    EXPECT_EQ(listing(out / "a/b"), (in_hidden({"x.csv", "x.mp4", "frames", "frames/0.png"})));
    const auto folder = out / "a/b";
    EXPECT_EQ(files.publish(), (std::vector<fs::path>{folder / "x.csv", folder / "x.mp4", folder / "frames"}));
    EXPECT_EQ(listing(out / "a/b"), (Names{hidden, lock, "x.csv", "x.mp4", "frames", "frames/0.png"}));
    EXPECT_EQ(bytes_of(out / "a/b/x.csv"), "table");
    const auto executable = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    EXPECT_EQ(fs::status(out / "a/b/x.csv").permissions() & executable, fs::perms::none);
}

TEST(Transaction, DestroyedUnpublishedLeaveNothing) {
    const auto out = fresh_folder();
    fs::create_directory(out / "a");
    {
        Transaction files(out / "a/b/c");
        write_part(files, "x.csv", "table");
        write_picture(files, "0.png");
        files.file("never written");
    }
    EXPECT_EQ(listing(out), Names{"a"});  // existed before
}

TEST(Transaction, FoldersWithOtherThingsInThemStay) {
    const auto out = fresh_folder();
    {
        Transaction files(out / "a/b");
        files.file("x.csv");
        write_bytes(out / "a/notes", "somebody's");
    }
    EXPECT_EQ(listing(out), (Names{"a", "a/notes"}));
}

TEST(Transaction, TheWayToPublishedFilesStays) {
    const auto out = fresh_folder();
    fs::path file;
    {
        Transaction files(out / "new/../there");
        write_part(files, "x.csv", "table");
        file = files.publish().at(0);
    }
    EXPECT_EQ(bytes_of(file), "table");
}

TEST(Transaction, RunsThatStartTogetherShareTheFoldersTheyMake) {
    const auto out = fresh_folder();
    for (int round = 0; round < 50; ++round) {
        const auto folder = out / std::to_string(round) / "a/b";
        std::barrier start(4);
        std::atomic<int> begun = 0;
        std::vector<std::jthread> runs;
        for (int run = 0; run < 4; ++run)
            runs.emplace_back([&, run] {
                start.arrive_and_wait();
                try {
                    const Transaction files(folder, std::to_string(run));
                    ++begun;
                    start.arrive_and_wait();
                } catch (const std::exception& error) {
                    ADD_FAILURE() << error.what();
                    start.arrive_and_drop();
                }
            });
        runs.clear();
        ASSERT_EQ(begun, 4) << "round " << round;
    }
}

TEST(Transaction, AFolderIsReplacedAsAWhole) {
    const auto out = fresh_folder();
    fs::create_directories(out / "frames");
    write_bytes(out / "frames/000000.png", "old");
    write_bytes(out / "frames/000001.png", "old");
    write_record(out, {"frames/000000.png", "frames/000001.png"});
    Transaction files(out);
    write_picture(files, "000000.png");
    files.publish();
    EXPECT_EQ(listing(out), (Names{hidden, lock, "frames", "frames/000000.png", "record.json"}));
    EXPECT_EQ(bytes_of(out / "frames/000000.png"), "picture");
}

TEST(Transaction, AFailedPublicationLeavesAllFilesUnchanged) {
    const auto out = fresh_folder();
    {
        Transaction files(out / "a");
        write_part(files, "x.csv", "table");
        files.file("x.mp4");  // requested, but never written
        expect_error(ExitCode::io_failed, {"x.mp4", "No such file"}, [&] { files.publish(); });
    }
    EXPECT_EQ(listing(out), Names{});
}

TEST(Transaction, WhatIsInTheWayIsNamed) {
    const auto out = fresh_folder();
    fs::create_directories(out / "x/x.csv");
    write_bytes(out / "file", "");
    expect_error(ExitCode::io_failed, {"x/x.csv is a folder; Doppel would write a file there"},
                 [&] { Transaction(out / "x").file("x.csv"); });
    expect_error(ExitCode::io_failed, {"file is a file; Doppel would make a folder there"},
                 [&] { Transaction(out).directory("file"); });
    expect_error(ExitCode::io_failed, {"file is a file; Doppel would make a folder there"},
                 [&] { Transaction(out / "file/x"); });
    expect_error(ExitCode::io_failed, {"/proc/doppel", "No such file"}, [] { Transaction("/proc/doppel/x"); });
    EXPECT_EQ(listing(out), (Names{"x", "x/x.csv", "file"}));
}

TEST(Transaction, LinksAndPipesBelowTheFolderAreNeverFollowed) {
    const auto out = fresh_folder();
    write_bytes(out / "thesis", "years of work");
    for (const std::string name : {".doppel-run", "x.csv", "frames"})
        for (const std::string kind : {"symbolic link", "hard link", "pipe"}) {
            const auto folder = out / "x";
            fs::remove_all(folder);
            fs::create_directory(folder);
            if (kind == "symbolic link") fs::create_symlink("../thesis", folder / name);
            if (kind == "hard link") fs::create_hard_link(out / "thesis", folder / name);
            if (kind == "pipe") mkfifo((folder / name).c_str(), 0600);
            expect_error(ExitCode::io_failed, {(folder / name).string()}, [&] {
                Transaction files(folder);
                files.file("x.csv");
                files.directory("frames");
            });
            EXPECT_EQ(listing(folder), Names{name}) << kind;
            EXPECT_EQ(bytes_of(out / "thesis"), "years of work") << name << ", " << kind;
        }
    fs::create_directory(out / "elsewhere");
    fs::create_directory_symlink("elsewhere", out / "link");
    expect_error(ExitCode::io_failed, {"link is a symbolic link"}, [&] { Transaction(out / "link"); });
    Transaction(out / "link/x").file("x.csv");  // the user made the link in the path
    EXPECT_EQ(listing(out / "elsewhere"), Names{});
}

TEST(Transaction, WhatIsNotDoppelsIsNeverReplaced) {
    const auto out = fresh_folder();
    fs::create_directory(out / "frames");
    write_bytes(out / "x.csv", "my table");
    write_bytes(out / "frames/000000.png", "ours");
    write_bytes(out / "frames/notes.txt", "mine");
    write_record(out, {"frames/000000.png"});
    Transaction files(out);
    expect_error(ExitCode::io_failed, {(out / "x.csv").string(), "not written by Doppel"},
                 [&] { files.file("x.csv"); });
    expect_error(ExitCode::io_failed, {(out / "frames/notes.txt").string(), "not written by Doppel"},
                 [&] { files.directory("frames"); });
    fs::remove(out / "frames/notes.txt");
    fs::create_directory(out / "frames/000001.png");
    expect_error(ExitCode::io_failed, {(out / "frames/000001.png").string()}, [&] { files.directory("frames"); });
    fs::remove(out / "frames/000001.png");
    // a file that appears during the run
    write_picture(files, "000000.png");
    write_part(files, "x.mp4", "video");
    write_bytes(out / "x.mp4", "my video");
    expect_error(ExitCode::io_failed, {(out / "x.mp4").string()}, [&] { files.publish(); });
    EXPECT_EQ(bytes_of(out / "x.mp4"), "my video");
    EXPECT_EQ(bytes_of(out / "frames/000000.png"), "ours");
}

TEST(Transaction, KnowsWhatDoppelMadeByItsContentToo) {
    const auto out = fresh_folder();
    fs::create_directory(out / "frames");
    write_png(out / "frames/000000.png", noise({4, 4}, 1));
    write_png(out / "x.png", noise({4, 4}, 1));
    Transaction files(out);
    files.file("x.png");
    files.directory("frames");
    write_bytes(out / "y.csv", "sample,time_s,theta1_rad,theta2_rad\r\n");  // also from a measured track
    expect_error(ExitCode::io_failed, {"y.csv"}, [&] { files.file("y.csv"); });
    write_bytes(out / "y.png", bytes_of(out / "x.png").substr(0, 33));  // without its text chunks
    expect_error(ExitCode::io_failed, {"y.png"}, [&] { files.file("y.png"); });
}

TEST(Transaction, ReplacesChangedFilesOnlyIfForced) {
    const auto out = fresh_folder();
    write_bytes(out / "x.toml", "by Doppel");
    write_bytes(out / "record.json", R"({"doppel": {}, "files": {"x.toml": {"bytes": 9, "sha256": ")" +
                                         sha256_of_text("by Doppel") + R"("}}})");
    Transaction(out).file("x.toml");
    write_bytes(out / "x.toml", "by a hand");  // changed by a user, with the same length
    expect_error(ExitCode::io_failed, {"x.toml", "--force"}, [&] { Transaction(out).file("x.toml"); });
    Transaction(out, "run", "", {.force = true}).file("x.toml");
    // the entry of an earlier run in a manifest does not make the file Doppel's again, nor the reverse
    write_bytes(out / "later.json",
                R"({"doppel": {}, "files": {}, "earlier_files": {"x.toml": {"bytes": 9, "sha256": ")" +
                    sha256_of_text("by a hand") + R"("}}})");
    Transaction(out).file("x.toml");
}

TEST(Transaction, ReplacesFilesOfAnotherKindOfRunOnlyIfForced) {
    const auto out = fresh_folder();
    write_bytes(out / "x.json", R"({"doppel": {}, "models": [], "files": {"x.csv": {}}})");
    write_bytes(out / "x.csv", "residuals");
    for (const char* name : {"x.json", "x.csv"}) {
        Transaction(out, "run", "fit").file(name);
        Transaction(out, "run", "film", {.force = true}).file(name);
        expect_error(ExitCode::io_failed, {name, "fit", "film", "--out", "--force"},
                     [&] { Transaction(out, "run", "film").require(name); });
    }
}

TEST(Transaction, NeverReplacesAnInput) {
    const auto out = fresh_folder(), elsewhere = out / "elsewhere";
    fs::create_directories(elsewhere);
    write_record(out, {"x.csv"});
    write_bytes(out / "x.csv", "track");
    fs::create_hard_link(out / "x.csv", elsewhere / "hard.csv");
    fs::create_symlink(out / "x.csv", elsewhere / "soft.csv");
    for (const auto& input : {out / "x.csv", elsewhere / "hard.csv", elsewhere / "soft.csv"})
        expect_error(ExitCode::io_failed, {"x.csv", "is read by this run"},
                     [&] { Transaction(out, "run", "", {.inputs = {input}, .force = true}).file("x.csv"); });
    Transaction(out, "run", "", {.inputs = {elsewhere / "none.csv"}}).file("x.csv");
}

TEST(Transaction, FilesOfEarlierRunsStayKnown) {
    const auto out = fresh_folder();
    fs::create_directory(out / "frames");
    write_bytes(out / "frames/000000.png", "picture");
    write_bytes(out / "x.mp4", "video");
    write_bytes(out / "x.csv", "table");
    write_record(out, {"frames/000000.png", "x.mp4", "x.csv", "gone.png", "frames/000001.png"});
    Transaction files(out);
    files.file("x.csv");
    std::set<std::string> earlier;
    for (const auto& [name, about] : files.earlier_files()) earlier.insert(name);
    EXPECT_EQ(earlier, (Names{"frames/000000.png", "x.mp4"}));
}

TEST(Transaction, WhatIsFinishedStaysWhereALaterStepFails) {
    const auto out = fresh_folder();
    {
        Transaction files(out);
        write_part(files, "x.mp4", "video");
        files.finished("x.mp4");
        write_part(files, "x.csv", "half a tab");
        expect_error(
            ExitCode::io_failed, {"no more room; what is finished stays", (out / hidden / "x.mp4").string()}, [&] {
                files.keeping_finished([]() -> std::vector<fs::path> { throw std::runtime_error("no more room"); });
            });
        expect_error(ExitCode::method_failed, {"it broke down; what is finished stays", "x.mp4"}, [&] {
            files.keeping_finished([]() -> std::vector<fs::path> { throw method_failed("it broke down"); });
        });
    }
    EXPECT_EQ(listing(out), in_hidden({"x.mp4"}));
    fs::copy_file(out / hidden / "x.mp4", out / "rescued.mp4");
    { Transaction files(out); }
    EXPECT_EQ(listing(out), Names{"rescued.mp4"});
    {
        Transaction files(out);
        write_part(files, "x.mp4", "video");
        files.finished("x.mp4");
        expect_error(ExitCode::interrupted, {"stop"}, [&] {
            files.keeping_finished([]() -> std::vector<fs::path> { throw Error(ExitCode::interrupted, "stop"); });
        });
    }
    EXPECT_EQ(listing(out), Names{"rescued.mp4"});
}

TEST(Transaction, OneAloneIsKeptUnderAnotherName) {
    const auto out = fresh_folder();
    Transaction files(out);
    write_part(files, "x.csv", "table");
    write_part(files, "x.mp4", "video");
    write_picture(files, "0.png");
    files.keep_only("x.csv", "x.failed.csv");
    EXPECT_EQ(listing(out), in_hidden({"x.failed.csv"}));
    EXPECT_EQ(files.publish(), std::vector<fs::path>{out / "x.failed.csv"});
    EXPECT_EQ(listing(out), (Names{hidden, lock, "x.failed.csv"}));
    EXPECT_EQ(bytes_of(out / "x.failed.csv"), "table");
}

TEST(Files, NamesAreInTheirOrder) {
    const auto folder = fresh_folder();
    std::vector<std::string> names;
    for (int i = 0; i < 60; ++i) write_bytes(folder / names.emplace_back(fmt::format("{}", 37 * i % 60)), "");
    std::ranges::sort(names);
    EXPECT_EQ(names_in(folder), names);
}

TEST(Transaction, LockTheFolderForOneRun) {
    const auto out = fresh_folder();
    const auto pid = std::to_string(getpid());
    {
        Transaction files(out / "a");
        expect_error(ExitCode::try_again, {(out / "a").string() + ": ", "another run, process " + pid, "--out"},
                     [&] { Transaction(out / "a"); });
        Transaction shard(out / "a", "shard-1-of-2");  // with another name
        EXPECT_EQ(listing(out / "a"), (Names{hidden, lock, ".doppel-shard-1-of-2", ".doppel-shard-1-of-2/.lock"}));
        write_part(files, "x.csv", "sample,time_s,");
        files.publish();
    }
    EXPECT_EQ(listing(out), (Names{"a", "a/x.csv"}));
    Transaction(out / "a").file("y.csv");
}

TEST(Transaction, RemovesFilesOfAKilledRun) {
    const auto out = fresh_folder();
    write_bytes(out / "x.mp4.part", "somebody's");
    EXPECT_TRUE(killed_before(0, [&] {
        Transaction files(out);
        write_part(files, "x.mp4", "video");
        write_picture(files, "0.png");
        raise(SIGKILL);
    }));
    auto left = in_hidden({"x.mp4", "frames", "frames/0.png"});
    left.insert("x.mp4.part");
    EXPECT_EQ(listing(out), left);
    { Transaction files(out, "another"); }  // is independent of it
    EXPECT_EQ(listing(out), left);
    {
        Transaction files(out);
        EXPECT_EQ(listing(out), (Names{hidden, lock, "x.mp4.part"}));
    }
    EXPECT_EQ(listing(out), Names{"x.mp4.part"});
}

TEST(Transaction, ItsLockFileCannotNameAnotherFolder) {
    const auto out = fresh_folder();
    write_bytes(out / "x.csv", "mine");
    fs::create_directories(out / "a" / hidden);
    for (const std::string notes : {"", "1", "1\n", "1\npublish 7", "1\npublish ../x.csv 7\n", "my own\nlock\n"}) {
        fs::create_directories(out / "a" / hidden);
        write_bytes(out / "a" / lock, notes);
        { Transaction files(out / "a"); }
        EXPECT_EQ(listing(out), (Names{"a", "x.csv"})) << notes;
    }
}

}  // namespace doppel::transaction_test
