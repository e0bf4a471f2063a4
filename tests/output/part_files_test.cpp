#include "output/part_files.hpp"

#include "output/fixtures.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <barrier>
#include <csignal>
#include <set>
#include <thread>

using namespace doppel;
using namespace doppel::test;
namespace fs = std::filesystem;

namespace {

/// All that is below `folder`, as paths relative to it.
std::set<std::string> listing(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        names.insert(entry.path().lexically_relative(folder));
    return names;
}

using Names = std::set<std::string>;

const std::string lock = ".run.lock";

/// Runs `action` in a process of its own, until it raises SIGKILL.
void killed(const std::function<void()>& action) {
    const pid_t child = fork();
    if (child == 0) {
        action();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
}

}  // namespace

TEST(PartFiles, AppearTogetherWhenPublished) {
    const auto out = fresh_folder();
    PartFiles files(out / "a/b");
    write_bytes(files.file("x.csv"), "table");
    write_bytes(files.file("x.mp4"), "video");
    write_bytes(files.directory("frames") / "0.png", "picture");
    EXPECT_EQ(listing(out / "a/b"), (Names{lock, "x.csv.part", "x.mp4.part", "frames.part", "frames.part/0.png"}));
    files.publish();
    EXPECT_EQ(listing(out / "a/b"), (Names{lock, "x.csv", "x.mp4", "frames", "frames/0.png"}));
    EXPECT_EQ(bytes_of(out / "a/b/x.csv"), "table");
}

TEST(PartFiles, DestroyedUnpublishedLeaveNothing) {
    const auto out = fresh_folder();
    fs::create_directory(out / "a");
    {
        PartFiles files(out / "a/b/c");
        write_bytes(files.file("x.csv"), "table");
        write_bytes(files.directory("frames") / "0.png", "picture");
        files.file("never written");
    }
    EXPECT_EQ(listing(out), Names{"a"});  // which was there before
}

TEST(PartFiles, FoldersWithOtherThingsInThemStay) {
    const auto out = fresh_folder();
    {
        PartFiles files(out / "a/b");
        files.file("x.csv");
        write_bytes(out / "a/notes", "somebody's");
    }
    EXPECT_EQ(listing(out), (Names{"a", "a/notes"}));
}

TEST(PartFiles, RunsThatStartTogetherShareTheFoldersTheyMake) {
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
                    const PartFiles files(folder, std::to_string(run));
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

TEST(PartFiles, OlderFilesStayUntilPublishedAndStalePartsGo) {
    const auto out = fresh_folder();
    write_bytes(out / "x.csv", "old");
    write_bytes(out / "x.csv.part", "stale");
    {
        PartFiles files(out);
        EXPECT_FALSE(fs::exists(files.file("x.csv")));
    }
    EXPECT_EQ(bytes_of(out / "x.csv"), "old");
    PartFiles files(out);
    write_bytes(files.file("x.csv"), "new");
    files.publish();
    EXPECT_EQ(bytes_of(out / "x.csv"), "new");
    EXPECT_EQ(listing(out), (Names{lock, "x.csv"}));
}

TEST(PartFiles, AFolderIsReplacedAsAWhole) {
    const auto out = fresh_folder();
    fs::create_directories(out / "frames");
    fs::create_directories(out / "frames.part");
    write_bytes(out / "frames/old.png", "old");
    write_bytes(out / "frames.part/stale.png", "stale");
    PartFiles files(out);
    write_bytes(files.directory("frames") / "new.png", "new");
    files.publish();
    EXPECT_EQ(listing(out), (Names{lock, "frames", "frames/new.png"}));
}

TEST(PartFiles, OneThatCannotBePublishedTakesTheOthersWithIt) {
    const auto out = fresh_folder();
    {
        PartFiles files(out / "a");
        write_bytes(files.file("x.csv"), "table");
        files.file("x.mp4");  // asked for, never written
        expect_error(ExitCode::io_failed, {"x.mp4.part", "No such file"}, [&] { files.publish(); });
    }
    EXPECT_EQ(listing(out), Names{});
}

TEST(PartFiles, WhatIsInTheWayIsNamed) {
    const auto out = fresh_folder();
    fs::create_directories(out / "x/x.csv");
    write_bytes(out / "file", "");
    expect_error(ExitCode::io_failed, {"x/x.csv is a folder; Doppel would write a file there"},
                 [&] { PartFiles(out / "x").file("x.csv"); });
    expect_error(ExitCode::io_failed, {"file is a file; Doppel would make a folder there"},
                 [&] { PartFiles(out).directory("file"); });
    expect_error(ExitCode::io_failed, {"file is no folder"}, [&] { PartFiles(out / "file/x"); });
    expect_error(ExitCode::io_failed, {"/proc/doppel", "No such file"}, [] { PartFiles("/proc/doppel/x"); });
    EXPECT_EQ(listing(out), (Names{"x", "x/x.csv", "file"}));
}

TEST(PartFiles, HoldTheFolderForOneRunAtATime) {
    const auto out = fresh_folder();
    const auto pid = std::to_string(getpid());
    {
        PartFiles files(out / "a");
        expect_error(ExitCode::io_failed, {(out / "a").string() + ": ", "another run, process " + pid, "--out"},
                     [&] { PartFiles(out / "a"); });
        PartFiles shard(out / "a", "shard-1-of-2");  // of another name
        EXPECT_EQ(listing(out / "a"), (Names{lock, ".shard-1-of-2.lock"}));
        write_bytes(files.file("x.csv"), "table");
        files.publish();
    }
    EXPECT_EQ(listing(out), (Names{"a", "a/x.csv"}));
    PartFiles(out / "a").file("x.csv");
}

TEST(PartFiles, WhatAKilledRunLeftGoesWithTheNext) {
    const auto out = fresh_folder();
    write_bytes(out / "notes.part", "somebody's");
    killed([&] {
        PartFiles files(out);
        write_bytes(files.file("x.mp4"), "video");
        write_bytes(files.directory("frames") / "0.png", "picture");
        fs::create_directory(out / "frames.old.part");  // as where it is killed while publishing
        raise(SIGKILL);
    });
    EXPECT_EQ(listing(out),
              (Names{lock, "frames.old.part", "frames.part", "frames.part/0.png", "notes.part", "x.mp4.part"}));
    { PartFiles files(out, "another"); }  // is not concerned
    EXPECT_TRUE(fs::exists(out / "x.mp4.part"));
    {
        PartFiles files(out);
        EXPECT_EQ(listing(out), (Names{lock, "notes.part"}));
    }
    EXPECT_EQ(listing(out), Names{"notes.part"});
}

TEST(PartFiles, AStaleListRemovesNothingButParts) {
    const auto out = fresh_folder();
    fs::create_directory(out / "a");
    write_bytes(out / "x.part", "");
    write_bytes(out / "a/x.csv", "");
    write_bytes(out / "a" / lock, "1\n../x.part\nx.csv\n.\n..\n\n.part\n/\n" + (out / "x.part").string() + "\n");
    { PartFiles files(out / "a"); }
    EXPECT_EQ(listing(out), (Names{"a", "a/x.csv", "x.part"}));
}
