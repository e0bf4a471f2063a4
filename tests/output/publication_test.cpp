// Several files are published together, or none, after any interruption.
#include "output/fixtures.hpp"
#include "output/system_calls.hpp"
#include "output/transaction.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>

namespace doppel::publication_test {

using namespace test;
using Transactions = InFolder;

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;

/// Path and bytes of every file below the folder.
Contents contents(const fs::path& folder) {
    Contents all;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) all[entry.path().lexically_relative(folder)] = bytes_of(entry.path());
    return all;
}

/// A run that writes a film, pictures and a manifest, which all contain `word`.
void run(const fs::path& folder, const std::string& word) {
    Transaction files(folder);
    write_bytes(files.file("x.mp4"), word);
    const auto frames = files.directory("frames");
    for (const char* name : {"000000.png", "000001.png"}) write_bytes(frames / name, word);
    files.finished("x.mp4");
    files.finished("frames");
    files.remove("x.failed.csv");
    std::string manifest = R"({"doppel": {}, "files": {"x.failed.csv": {})";
    for (const auto& [name, about] : files.finished_files())
        manifest += fmt::format(R"(, "{}": {{"bytes": {}, "sha256": "{}"}})", name, about.bytes, about.sha256);
    write_bytes(files.file("x.json"), manifest + "}}");
    files.publish();
}

/// An empty folder, in memory if possible: on a disk, hundreds of runs take minutes.
class QuickFolder {
public:
    QuickFolder() {
        std::string name = "/dev/shm/doppel-test-XXXXXX";
        path = mkdtemp(name.data()) ? fs::path(name) : fresh_folder();
    }
    ~QuickFolder() { fs::remove_all(path); }
    QuickFolder(const QuickFolder&) = delete;
    QuickFolder& operator=(const QuickFolder&) = delete;

    fs::path path;
};

/// Syncs do nothing, and no call fails.
int as_always(const std::string& /*call*/) {
    return 0;
}

/// The folder after the run "old" and a failed run after it.
fs::path after_old_run(const fs::path& folder) {
    watch_calls(as_always);
    run(folder, "old");
    watch_calls({});
    write_bytes(folder / "x.failed.csv", "old");
    write_bytes(folder / "notes.txt", "mine");
    return folder;
}

/// The contents of the folder after the complete run "new".
Contents after_new_run(const fs::path& where) {
    const auto folder = after_old_run(where / "expected");
    watch_calls(as_always);
    run(folder, "new");
    watch_calls({});
    return contents(folder);
}

int no_exchange(const std::string& call) {
    return call == "renameat2" ? EINVAL : 0;
}

/// Whether the folder equals that of the run "new"; the file of an earlier failed run may remain until the next run.
bool is_new(Contents found, const Contents& expected) {
    found.erase("x.failed.csv");
    return found == expected;
}

void expect_old_or_new(const Contents& found, const Contents& old, const Contents& expected, const std::string& what) {
    EXPECT_TRUE(found == old || is_new(found, expected)) << what;
}

TEST(Publication, IsAllNewOrAllOldWheneverItIsKilled) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    for (const CallWatch& system : {CallWatch(), CallWatch(no_exchange)}) {
        int kills = 0, old = 0;
        for (bool killed = true; killed;) {
            const auto folder =
                after_old_run(quick.path / fmt::format("killed-{}-{}", system ? "backup" : "exchange", kills));
            const auto expected_old = contents(folder);
            killed = killed_before(
                ++kills, [&] { run(folder, "new"); }, system);
            // if names can be exchanged, every name has a complete file at any moment
            for (const auto& [name, word] : expected_old)
                EXPECT_TRUE(system || name == "x.failed.csv" || fs::exists(folder / name)) << kills << ", " << name;
            watch_calls(as_always);
            { Transaction next(folder); }
            const auto found = contents(folder);
            expect_old_or_new(found, expected_old, expected_new, std::to_string(kills));
            old += found == expected_old;
            run(folder, "new");
            EXPECT_EQ(contents(folder), expected_new) << kills;
            watch_calls({});
        }
        EXPECT_GT(kills, 20);
        EXPECT_GT(old, 8);
        EXPECT_LT(old, kills - 6);
    }
}

TEST(Publication, IsAllNewOrAllOldWhereItsRecoveryIsKilledToo) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    for (const CallWatch& system : {CallWatch(), CallWatch(no_exchange)})
        for (int first = 8, count = 0; first > 0; first += 3) {
            bool killed = false, killed_again = true;
            for (int again = 1; killed_again; ++again, ++count) {
                const auto folder =
                    after_old_run(quick.path / fmt::format("twice-{}-{}", system ? "backup" : "exchange", count));
                const auto expected_old = contents(folder);
                killed = killed_before(
                    first, [&] { run(folder, "new"); }, system);
                killed_again = killed_before(
                    again, [&] { Transaction next(folder); }, system);
                watch_calls(as_always);
                { Transaction next(folder); }
                expect_old_or_new(contents(folder), expected_old, expected_new, fmt::format("{}, {}", first, again));
            }
            if (!killed) break;
        }
    watch_calls({});
}

TEST(Publication, IsOnTheDiskBeforeTheFirstNameChanges) {
    const QuickFolder quick;
    const auto folder = after_old_run(quick.path / "folder");
    std::map<std::string, int> before,
        after;  // calls before the first rename in the folder, and after the last one
    bool begun = false;
    watch_calls([&](const std::string& call) {
        const bool moves = call == "renameat2" || call == "rename";
        begun = begun || moves;
        if (moves) after.clear();
        ++(begun ? after : before)[call];
        return 0;
    });
    run(folder, "new");
    watch_calls({});
    EXPECT_EQ(before["syncfs"], 1);  // the pictures
    EXPECT_EQ(before["fsync"], 5);   // two files, the folder of pictures, the folder with their names, its record
    EXPECT_EQ(after["fsync"], 1);    // the folder with their new names
}

TEST(Publication, WhereAFileCannotTakeItsPlaceTheNextRunMovesItIn) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    for (const CallWatch& system : {CallWatch(), CallWatch(no_exchange)}) {
        const int moves = system ? 4 : 3;
        for (int failing = 1; failing <= moves + 1; ++failing) {
            const auto folder =
                after_old_run(quick.path / fmt::format("fails-{}-{}", system ? "backup" : "exchange", failing));
            int calls = 0;
            watch_calls([&](const std::string& call) {
                const bool moves_one = call == "rename" || (call == "renameat2" && !system);
                if (moves_one && ++calls >= failing) return EPERM;
                return system ? system(call) : 0;
            });
            if (failing > moves) {
                run(folder, "new");
            } else {
                expect_io_failed({"cannot be renamed"}, [&] { run(folder, "new"); });
                expect_io_failed({"cannot be renamed"}, [&] { Transaction next(folder); });
            }
            watch_calls(as_always);
            { Transaction next(folder); }
            watch_calls({});
            EXPECT_TRUE(is_new(contents(folder), expected_new)) << failing;
        }
    }
}

// a file that somebody put there is not replaced, and the waiting file is kept
TEST(Publication, IsNotCompletedOverAFileThatSomebodyPutThere) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    const auto folder = after_old_run(quick.path / "folder");
    EXPECT_TRUE(killed_before(1'000'000, [&] {
        watch_calls([](const std::string& call) { return call == "rename" ? raise(SIGKILL) : 0; });
        run(folder, "new");
    }));
    const auto old = bytes_of(folder / "x.mp4");
    write_bytes(folder / "x.mp4", "mine");
    for (int again = 0; again < 2; ++again)
        expect_io_failed({"x.mp4", "was changed since Doppel wrote it"}, [&] { Transaction next(folder); });
    EXPECT_EQ(bytes_of(folder / "x.mp4"), "mine");
    write_bytes(folder / "x.mp4", old);
    { Transaction next(folder); }
    EXPECT_TRUE(is_new(contents(folder), expected_new));
}

TEST(Publication, IsKeptIfItsNoteCannotBeRead) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    const auto folder = after_old_run(quick.path / "folder");
    watch_calls([](const std::string& call) { return call == "rename" ? EPERM : 0; });
    EXPECT_THROW(run(folder, "new"), Error);
    for (int failing = 0; failing < 8; ++failing) {
        watch_calls([&, calls = 0](const std::string& call) mutable {
            return call == "rename" || (call == "open" && calls++ == failing) ? EMFILE : 0;
        });
        EXPECT_THROW({ Transaction next(folder); }, Error) << failing;
    }
    watch_calls(as_always);
    { Transaction next(folder); }
    watch_calls({});
    EXPECT_TRUE(is_new(contents(folder), expected_new));
}

TEST_F(Transactions, ARunThatCannotBeginLeavesNoFolder) {
    int failing = 0;
    for (bool failed = true; failed;) {
        watch_calls([&, calls = 0](const std::string& call) mutable {
            return (call == "open" || call == "mkdir" || call == "write") && calls++ == failing ? EMFILE : 0;
        });
        failed = false;
        try {
            Transaction files(folder / "a/b");
        } catch (const Error& error) {
            failed = true;
            EXPECT_EQ(error.code(), ExitCode::io_failed);
        }
        watch_calls({});
        EXPECT_TRUE(fs::is_empty(folder)) << failing;
        ++failing;
    }
    EXPECT_EQ(failing, 6);  // two folders, the hidden one, its lock and the note in it
}

TEST_F(Transactions, AFolderThatCannotBeMadeIsNamed) {
    Transaction files(folder);
    watch_calls([](const std::string& call) { return call == "mkdir" ? ENOSPC : 0; });
    expect_error(ExitCode::try_again,
                 {(folder / ".doppel-run/frames").string() + ": cannot be made: No space left on device"},
                 [&] { files.directory("frames"); });
    watch_calls({});
}

TEST_F(Transactions, ALiveRunIsNotDisturbedWithoutLocks) {
    const auto file = folder / ".doppel-run/x.csv";
    watch_calls([](const std::string& call) { return call == "flock" ? ENOLCK : 0; });
    const auto expect_refused = [&](int process) {
        expect_io_failed({"may be writing there", fmt::format("process {}", process), "no locks", "remove"},
                         [&] { Transaction second(folder); });
        EXPECT_EQ(bytes_of(file), "half a tab");
    };
    {
        Transaction live(folder);
        write_bytes(live.file("x.csv"), "half a tab");
        expect_refused(getpid());
        live.publish();
    }
    EXPECT_EQ(contents(folder), (Contents{{"x.csv", "half a tab"}}));
    // nor can it be distinguished from a killed run
    const pid_t child = forked(fork());
    if (child == 0) {
        Transaction killed(folder, "run", "", {.force = true});
        fs::remove(folder / "x.csv");
        write_bytes(killed.file("x.csv"), "half a tab");
        raise(SIGKILL);
    }
    waitpid(child, nullptr, 0);
    expect_refused(child);
    watch_calls({});
    { Transaction next(folder); }
    EXPECT_TRUE(fs::is_empty(folder));
}

// pictures to compare may have any name
TEST_F(Transactions, ANameWithLineBreaksIsOneName) {
    write_bytes(folder / "x.csv", "somebody's");
    const std::string name = "y\nremove x.csv\npublish";
    EXPECT_TRUE(killed_before(1'000'000, [&] {
        Transaction killed(folder);
        write_bytes(killed.file(name), "half a tab");
        raise(SIGKILL);
    }));
    EXPECT_TRUE(fs::exists(folder / ".doppel-run" / name));
    { Transaction next(folder); }
    EXPECT_EQ(contents(folder), (Contents{{"x.csv", "somebody's"}}));
    Transaction files(folder);
    write_bytes(files.file(name), "whole");
    files.publish();
    EXPECT_EQ(bytes_of(folder / name), "whole");
}

}  // namespace doppel::publication_test
