#include "output/transaction.hpp"

#include "output/fixtures.hpp"
#include "output/png.hpp"
#include "output/sink.hpp"
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
using Transactions = InFolder;

namespace fs = std::filesystem;

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

TEST_F(Transactions, MakeNoFolderThatTheirPathLeaves) {
    fs::create_directory(folder / "there");
    for (const auto* way : {"x/../y", "x/z/../../y", "there/../x/../y", "y"}) {
        Transaction files(folder / way);
        write_part(files, "x.csv", way);
        EXPECT_EQ(files.publish().front().lexically_normal(), folder / "y/x.csv") << way;
        EXPECT_EQ(listing(folder), (Names{"there", "y", "y/" + hidden, "y/" + lock, "y/x.csv"})) << way;
        fs::remove(folder / "y/x.csv");
    }
}

TEST_F(Transactions, AppearTogetherWhenPublished) {
    Transaction files(folder / "a/b");
    write_part(files, "x.csv", "table");
    write_part(files, "x.mp4", "video");
    write_picture(files, "0.png");
    EXPECT_EQ(listing(folder / "a/b"), (in_hidden({"x.csv", "x.mp4", "frames", "frames/0.png"})));
    const auto inner = folder / "a/b";
    EXPECT_EQ(files.publish(), (std::vector<fs::path>{inner / "x.csv", inner / "x.mp4", inner / "frames"}));
    EXPECT_EQ(listing(folder / "a/b"), (Names{hidden, lock, "x.csv", "x.mp4", "frames", "frames/0.png"}));
    EXPECT_EQ(bytes_of(folder / "a/b/x.csv"), "table");
    const auto executable = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    EXPECT_EQ(fs::status(folder / "a/b/x.csv").permissions() & executable, fs::perms::none);
}

TEST_F(Transactions, DestroyedUnpublishedLeaveNothing) {
    fs::create_directory(folder / "a");
    {
        Transaction files(folder / "a/b/c");
        write_part(files, "x.csv", "table");
        write_picture(files, "0.png");
        files.file("never written");
    }
    EXPECT_EQ(listing(folder), Names{"a"});  // existed before
}

TEST_F(Transactions, FoldersWithOtherThingsInThemStay) {
    {
        Transaction files(folder / "a/b");
        files.file("x.csv");
        write_bytes(folder / "a/notes", "somebody's");
    }
    EXPECT_EQ(listing(folder), (Names{"a", "a/notes"}));
}

TEST_F(Transactions, TheWayToPublishedFilesStays) {
    fs::path file;
    {
        Transaction files(folder / "new/../there");
        write_part(files, "x.csv", "table");
        file = files.publish().at(0);
    }
    EXPECT_EQ(bytes_of(file), "table");
}

TEST_F(Transactions, RunsThatStartTogetherShareTheFoldersTheyMake) {
    for (int round = 0; round < 50; ++round) {
        const auto inner = folder / std::to_string(round) / "a/b";
        std::barrier start(4);
        std::atomic<int> begun = 0;
        std::vector<std::jthread> runs;
        for (int run = 0; run < 4; ++run)
            runs.emplace_back([&, run] {
                start.arrive_and_wait();
                try {
                    const Transaction files(inner, std::to_string(run));
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

TEST_F(Transactions, AFolderIsReplacedAsAWhole) {
    fs::create_directories(folder / "frames");
    write_bytes(folder / "frames/000000.png", "old");
    write_bytes(folder / "frames/000001.png", "old");
    write_record(folder, {"frames/000000.png", "frames/000001.png"});
    Transaction files(folder);
    write_picture(files, "000000.png");
    files.publish();
    EXPECT_EQ(listing(folder), (Names{hidden, lock, "frames", "frames/000000.png", "record.json"}));
    EXPECT_EQ(bytes_of(folder / "frames/000000.png"), "picture");
}

TEST_F(Transactions, AFailedPublicationLeavesAllFilesUnchanged) {
    {
        Transaction files(folder / "a");
        write_part(files, "x.csv", "table");
        files.file("x.mp4");  // requested, but never written
        expect_io_failed({"x.mp4", "No such file"}, [&] { files.publish(); });
    }
    EXPECT_EQ(listing(folder), Names{});
}

TEST_F(Transactions, WhatIsInTheWayIsNamed) {
    fs::create_directories(folder / "x/x.csv");
    write_bytes(folder / "file", "");
    expect_io_failed({"x/x.csv is a folder; Doppel would write a file there"},
                     [&] { Transaction(folder / "x").file("x.csv"); });
    expect_io_failed({"file is a file; Doppel would make a folder there"},
                     [&] { Transaction(folder).directory("file"); });
    expect_io_failed({"file is a file; Doppel would make a folder there"}, [&] { Transaction(folder / "file/x"); });
    expect_io_failed({"/proc/doppel", "No such file"}, [] { Transaction("/proc/doppel/x"); });
    fs::create_symlink("loop", folder / "loop");
    expect_io_failed({"loop/x: cannot be reached: Too many levels"}, [&] { Transaction(folder / "loop/x"); });
    EXPECT_EQ(listing(folder), (Names{"x", "x/x.csv", "file", "loop"}));
}

TEST_F(Transactions, LinksAndPipesBelowTheFolderAreNeverFollowed) {
    write_bytes(folder / "thesis", "years of work");
    for (const std::string name : {".doppel-run", "x.csv", "frames"})
        for (const std::string kind : {"symbolic link", "hard link", "pipe"}) {
            const auto inner = folder / "x";
            fs::remove_all(inner);
            fs::create_directory(inner);
            if (kind == "symbolic link") fs::create_symlink("../thesis", inner / name);
            if (kind == "hard link") fs::create_hard_link(folder / "thesis", inner / name);
            if (kind == "pipe") mkfifo((inner / name).c_str(), 0600);
            expect_io_failed({(inner / name).string()}, [&] {
                Transaction files(inner);
                files.file("x.csv");
                files.directory("frames");
            });
            EXPECT_EQ(listing(inner), Names{name}) << kind;
            EXPECT_EQ(bytes_of(folder / "thesis"), "years of work") << name << ", " << kind;
        }
    fs::create_directory(folder / "elsewhere");
    fs::create_directory_symlink("elsewhere", folder / "link");
    expect_io_failed({"link is a symbolic link"}, [&] { Transaction(folder / "link"); });
    Transaction(folder / "link/x").file("x.csv");  // the user made the link in the path
    EXPECT_EQ(listing(folder / "elsewhere"), Names{});
}

TEST_F(Transactions, WhatIsNotDoppelsIsNeverReplaced) {
    fs::create_directory(folder / "frames");
    write_bytes(folder / "x.csv", "my table");
    write_bytes(folder / "frames/000000.png", "ours");
    write_bytes(folder / "frames/notes.txt", "mine");
    write_record(folder, {"frames/000000.png"});
    Transaction files(folder);
    expect_io_failed({(folder / "x.csv").string(), "may not be Doppel's"}, [&] { files.file("x.csv"); });
    expect_io_failed({(folder / "frames/notes.txt").string(), "may not be Doppel's"},
                     [&] { files.directory("frames"); });
    fs::remove(folder / "frames/notes.txt");
    fs::create_directory(folder / "frames/000001.png");
    expect_io_failed({(folder / "frames/000001.png").string()}, [&] { files.directory("frames"); });
    fs::remove(folder / "frames/000001.png");
    // a file that appears during the run
    write_picture(files, "000000.png");
    write_part(files, "x.mp4", "video");
    write_bytes(folder / "x.mp4", "my video");
    expect_io_failed({(folder / "x.mp4").string()}, [&] { files.publish(); });
    EXPECT_EQ(bytes_of(folder / "x.mp4"), "my video");
    EXPECT_EQ(bytes_of(folder / "frames/000000.png"), "ours");
}

TEST_F(Transactions, KnowsWhatDoppelMadeByItsContentToo) {
    fs::create_directory(folder / "frames");
    write_png(folder / "frames/000000.png", noise({4, 4}, 1));
    write_png(folder / "x.png", noise({4, 4}, 1));
    Transaction files(folder);
    files.file("x.png");
    files.directory("frames");
    write_bytes(folder / "y.csv", "sample,time_s,theta1_rad,theta2_rad\r\n");  // also from a measured track
    expect_io_failed({"y.csv"}, [&] { files.file("y.csv"); });
    write_bytes(folder / "y.png", bytes_of(folder / "x.png").substr(0, 33));  // without its text chunks
    expect_io_failed({"y.png"}, [&] { files.file("y.png"); });
}

TEST_F(Transactions, KnowsDoppelsFilmsByTheirMetadata) {
    for (const auto& [format, name] : {std::pair{FilmFormat::mp4, "x.mp4"},
                                       {FilmFormat::webm, "x.webm"},
                                       {FilmFormat::gif, "x.gif"},
                                       {FilmFormat::apng, "x.apng"}})
        for (const std::string maker : {"Doppel", "Other"})
            for (const std::size_t letters : {9, 200}) {  // the second comment takes several blocks of a GIF
                VideoOptions options{.format = format, .size = {64, 36}, .fps_numerator = 25};
                options.metadata = {{"title", std::string(letters, 't')},
                                    {"comment", maker + " 1.0.0, preset x"},
                                    {"encoder", maker + " 1.0.0"}};
                EXPECT_EQ(made_by(film(folder / name, options, 2)), maker == "Doppel") << name << ' ' << letters;
            }
    write_bytes(folder / "x.mp4", bytes_of(folder / "x.mp4").substr(0, 40));
    EXPECT_FALSE(made_by(folder / "x.mp4"));
}

TEST_F(Transactions, ReplacesChangedFilesOnlyIfForced) {
    write_bytes(folder / "x.toml", "by Doppel");
    write_bytes(folder / "record.json", R"({"doppel": {}, "files": {"x.toml": {"bytes": 9, "sha256": ")" +
                                            sha256_of_text("by Doppel") + R"("}}})");
    Transaction(folder).file("x.toml");
    write_bytes(folder / "x.toml", "by a hand");  // changed by a user, with the same length
    expect_io_failed({"x.toml", "--force"}, [&] { Transaction(folder).file("x.toml"); });
    Transaction(folder, "run", "", {.force = true}).file("x.toml");
    // the entry of an earlier run in a manifest does not make the file Doppel's again, nor the reverse
    write_bytes(folder / "later.json",
                R"({"doppel": {}, "files": {}, "earlier_files": {"x.toml": {"bytes": 9, "sha256": ")" +
                    sha256_of_text("by a hand") + R"("}}})");
    Transaction(folder).file("x.toml");
}

TEST_F(Transactions, ReplacesFilesOfAnotherKindOfRunOnlyIfForced) {
    write_bytes(folder / "x.json", R"({"doppel": {}, "models": [], "files": {"x.csv": {}}})");
    write_bytes(folder / "x.csv", "residuals");
    for (const char* name : {"x.json", "x.csv"}) {
        Transaction(folder, "run", "fit").file(name);
        Transaction(folder, "run", "film", {.force = true}).file(name);
        expect_io_failed({name, "fit", "film", "--out", "--force"},
                         [&] { Transaction(folder, "run", "film").require(name); });
    }
}

TEST_F(Transactions, NeverReplacesAnInput) {
    const auto elsewhere = folder / "elsewhere";
    fs::create_directories(elsewhere);
    write_record(folder, {"x.csv"});
    write_bytes(folder / "x.csv", "track");
    fs::create_hard_link(folder / "x.csv", elsewhere / "hard.csv");
    fs::create_symlink(folder / "x.csv", elsewhere / "soft.csv");
    for (const auto& input : {folder / "x.csv", elsewhere / "hard.csv", elsewhere / "soft.csv"})
        expect_io_failed({"x.csv", "is read by this run"},
                         [&] { Transaction(folder, "run", "", {.inputs = {input}, .force = true}).file("x.csv"); });
    Transaction(folder, "run", "", {.inputs = {elsewhere / "none.csv"}}).file("x.csv");
}

TEST_F(Transactions, FilesOfEarlierRunsStayKnown) {
    fs::create_directory(folder / "frames");
    write_bytes(folder / "frames/000000.png", "picture");
    write_bytes(folder / "x.mp4", "video");
    write_bytes(folder / "x.csv", "table");
    write_record(folder, {"frames/000000.png", "x.mp4", "x.csv", "gone.png", "frames/000001.png"});
    Transaction files(folder);
    files.file("x.csv");
    std::set<std::string> earlier;
    for (const auto& [name, about] : files.earlier_files()) earlier.insert(name);
    EXPECT_EQ(earlier, (Names{"frames/000000.png", "x.mp4"}));
}

TEST_F(Transactions, WhatIsFinishedStaysWhereALaterStepFails) {
    {
        Transaction files(folder);
        write_part(files, "x.mp4", "video");
        files.finished("x.mp4");
        write_part(files, "x.csv", "half a tab");
        expect_io_failed({"no more room; what is finished stays", (folder / hidden / "x.mp4").string()}, [&] {
            files.keeping_finished([]() -> std::vector<fs::path> { throw std::runtime_error("no more room"); });
        });
        expect_error(ExitCode::method_failed, {"it broke down; what is finished stays", "x.mp4"}, [&] {
            files.keeping_finished([]() -> std::vector<fs::path> { throw method_failed("it broke down"); });
        });
    }
    EXPECT_EQ(listing(folder), in_hidden({"x.mp4"}));
    fs::copy_file(folder / hidden / "x.mp4", folder / "rescued.mp4");
    { Transaction files(folder); }
    EXPECT_EQ(listing(folder), Names{"rescued.mp4"});
    {
        Transaction files(folder);
        write_part(files, "x.mp4", "video");
        files.finished("x.mp4");
        expect_error(ExitCode::interrupted, {"stop"}, [&] {
            files.keeping_finished([]() -> std::vector<fs::path> { throw Error(ExitCode::interrupted, "stop"); });
        });
    }
    EXPECT_EQ(listing(folder), Names{"rescued.mp4"});
}

TEST_F(Transactions, OneAloneIsKeptUnderAnotherName) {
    Transaction files(folder);
    write_part(files, "x.csv", "table");
    write_part(files, "x.mp4", "video");
    write_picture(files, "0.png");
    files.keep_only("x.csv", "x.failed.csv");
    EXPECT_EQ(listing(folder), in_hidden({"x.failed.csv"}));
    EXPECT_EQ(files.publish(), std::vector<fs::path>{folder / "x.failed.csv"});
    EXPECT_EQ(listing(folder), (Names{hidden, lock, "x.failed.csv"}));
    EXPECT_EQ(bytes_of(folder / "x.failed.csv"), "table");
}

TEST_F(Transactions, NamesAreInTheirOrder) {
    std::vector<std::string> names;
    for (int i = 0; i < 60; ++i) write_bytes(folder / names.emplace_back(fmt::format("{}", 37 * i % 60)), "");
    std::ranges::sort(names);
    EXPECT_EQ(names_in(folder), names);
}

TEST_F(Transactions, LockTheFolderForOneRun) {
    const auto pid = std::to_string(getpid());
    {
        Transaction files(folder / "a");
        expect_error(ExitCode::try_again, {(folder / "a").string() + ": ", "another run, process " + pid, "--out"},
                     [&] { Transaction(folder / "a"); });
        Transaction shard(folder / "a", "shard-1-of-2");  // with another name
        EXPECT_EQ(listing(folder / "a"), (Names{hidden, lock, ".doppel-shard-1-of-2", ".doppel-shard-1-of-2/.lock"}));
        write_part(files, "x.csv", "sample,time_s,");
        files.publish();
    }
    EXPECT_EQ(listing(folder), (Names{"a", "a/x.csv"}));
    Transaction(folder / "a").file("y.csv");
}

TEST_F(Transactions, RemovesFilesOfAKilledRun) {
    write_bytes(folder / "x.mp4.part", "somebody's");
    EXPECT_TRUE(killed_before(0, [&] {
        Transaction files(folder);
        write_part(files, "x.mp4", "video");
        write_picture(files, "0.png");
        raise(SIGKILL);
    }));
    auto left = in_hidden({"x.mp4", "frames", "frames/0.png"});
    left.insert("x.mp4.part");
    EXPECT_EQ(listing(folder), left);
    { Transaction files(folder, "another"); }  // is independent of it
    EXPECT_EQ(listing(folder), left);
    {
        Transaction files(folder);
        EXPECT_EQ(listing(folder), (Names{hidden, lock, "x.mp4.part"}));
    }
    EXPECT_EQ(listing(folder), Names{"x.mp4.part"});
}

TEST_F(Transactions, KeepsWhatAUserPutsIntoTheHiddenFolder) {
    for (const std::string mine : {"thesis", "frames/notes.txt"})
        for (const bool is_killed : {true, false}) {
            const auto path = folder / hidden / mine;
            EXPECT_TRUE(killed_before(0, [&] {
                {
                    Transaction files(folder);
                    write_part(files, "x.mp4", "video");
                    write_picture(files, "0.png");
                    write_bytes(path, "mine");
                    if (is_killed) raise(SIGKILL);
                }
                raise(SIGKILL);
            }));
            const auto place = (folder / hidden / fs::path(mine).begin()->string()).string();
            expect_io_failed({place + " may not be Doppel's: no manifest lists it; move it"},
                             [&] { Transaction files(folder); });
            EXPECT_EQ(bytes_of(path), "mine") << is_killed;
            Names left{hidden, hidden + "/" + mine};
            if (mine != "thesis") left.insert(hidden + "/frames");
            EXPECT_EQ(listing(folder), left) << is_killed;
            fs::remove_all(folder / hidden);
        }
}

TEST_F(Transactions, RemovesWhatTheWriterOfAFileKeptBesideIt) {
    EXPECT_TRUE(killed_before(0, [&] {
        Transaction files(folder);
        write_part(files, "x.gif", "film");
        write_bytes(folder / hidden / "x.gif.frames", "film");
        raise(SIGKILL);
    }));
    { Transaction files(folder); }
    EXPECT_EQ(listing(folder), Names{});
}

TEST_F(Transactions, ItsLockFileCannotNameAnotherFolder) {
    write_bytes(folder / "x.csv", "mine");
    fs::create_directories(folder / "a" / hidden);
    for (const std::string notes : {"", "1", "1\n", "1\npublish 7", "1\npublish ../x.csv 7\n", "my own\nlock\n"}) {
        fs::create_directories(folder / "a" / hidden);
        write_bytes(folder / "a" / lock, notes);
        { Transaction files(folder / "a"); }
        EXPECT_EQ(listing(folder), (Names{"a", "x.csv"})) << notes;
    }
}

}  // namespace doppel::transaction_test
