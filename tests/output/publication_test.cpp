// Several files that take their places together, whatever happens on the way.
#include "output/fixtures.hpp"
#include "output/system_calls.hpp"
#include "output/transaction.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>

namespace doppel {
namespace publication_test {

using namespace test;

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;

/// Path and bytes of every file below the folder.
Contents contents(const fs::path& folder) {
    Contents all;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) all[entry.path().lexically_relative(folder)] = bytes_of(entry.path());
    return all;
}

/// A run that writes a film, pictures and a manifest, all of which say `word`.
void run(const fs::path& folder, const std::string& word) {
    Transaction files(folder);
    write_bytes(files.file("x.mp4").path, word);
    const Folder& frames = files.directory("frames");
    for (const char* name : {"000000.png", "000001.png"}) write_bytes(frames.path() / name, word);
    files.remove("x.failed.csv");
    write_bytes(files.file("x.json").path, R"({"doppel": {}, "word": ")" + word + R"(", "files": {"x.mp4": {},
        "frames/000000.png": {}, "frames/000001.png": {}, "x.failed.csv": {}}})");
    files.publish();
}

/// An empty folder, in memory where there is one: hundreds of runs wait for a disk for minutes.
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

/// Nothing is synced and nothing fails.
int as_always(const std::string& /*call*/) {
    return 0;
}

/// The folder as the run "old" and a failed one after it left it.
fs::path after_old_run(const fs::path& folder) {
    watch_calls(as_always);
    run(folder, "old");
    watch_calls({});
    write_bytes(folder / "x.failed.csv", "old");
    write_bytes(folder / "notes.txt", "mine");
    return folder;
}

/// What the folder holds after a whole run "new".
Contents after_new_run(const fs::path& where) {
    const auto folder = after_old_run(where / "expected");
    watch_calls(as_always);
    run(folder, "new");
    watch_calls({});
    return contents(folder);
}

/// Does `action` in a process of its own, which is killed before its n-th call, from 1; false where it had fewer.
bool killed_before(int n, const std::function<void()>& action, const CallWatch& other = {}) {
    const pid_t child = test::forked(fork());
    if (child == 0) {
        watch_calls([&, calls = 0](const std::string& call) mutable {
            if (++calls == n) raise(SIGKILL);
            return other ? other(call) : 0;
        });
        try {
            action();
        } catch (const Error&) {
            _exit(1);
        }
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
}

int no_exchange(const std::string& call) {
    return call == "renameat2" ? EINVAL : 0;
}

TEST(Publication, IsAllNewOrAllOldWheneverItIsKilled) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    for (const CallWatch& system : {CallWatch(), CallWatch(no_exchange)}) {
        int kills = 0, old = 0;
        for (bool killed = true; killed;) {
            const auto folder =
                after_old_run(quick.path / fmt::format("killed-{}-{}", system ? "aside" : "exchange", kills));
            const auto expected_old = contents(folder);
            killed = killed_before(
                ++kills, [&] { run(folder, "new"); }, system);
            // at any moment something whole has every name, where two names can be exchanged
            for (const auto& [name, word] : expected_old)
                EXPECT_TRUE(system || name == "x.failed.csv" || fs::exists(folder / name)) << kills << ", " << name;
            watch_calls(as_always);
            { Transaction next(folder); }
            const auto found = contents(folder);
            EXPECT_TRUE(found == expected_old || found == expected_new) << kills;
            old += found == expected_old;
        }
        EXPECT_GT(kills, 30);  // measured 40
        EXPECT_GT(old, 10);
        EXPECT_LT(old, kills - 8);
    }
    watch_calls({});
}

TEST(Publication, IsAllNewOrAllOldWhereItsRecoveryIsKilledToo) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    for (const CallWatch& system : {CallWatch(), CallWatch(no_exchange)})
        for (int first = 20, count = 0; first > 0; first += 3) {
            bool killed = false, killed_again = true;
            for (int again = 1; killed_again; ++again, ++count) {
                const auto folder =
                    after_old_run(quick.path / fmt::format("twice-{}-{}", system ? "aside" : "exchange", count));
                const auto expected_old = contents(folder);
                killed = killed_before(
                    first, [&] { run(folder, "new"); }, system);
                killed_again = killed_before(
                    again, [&] { Transaction next(folder); }, system);
                watch_calls(as_always);
                { Transaction next(folder); }
                const auto found = contents(folder);
                EXPECT_TRUE(found == expected_old || found == expected_new) << first << ", " << again;
            }
            if (!killed) break;
        }
    watch_calls({});
}

TEST(Publication, IsOnTheDiskBeforeTheFirstNameChanges) {
    const QuickFolder quick;
    const auto folder = after_old_run(quick.path / "folder");
    std::map<std::string, int> before,
        after;  // calls before a name of the folder changes, and after the last that does
    bool begun = false;
    watch_calls([&](const std::string& call) {
        const bool moves = call == "renameat2" || call == "renameat";
        begun = begun || moves;
        if (moves) after.clear();
        ++(begun ? after : before)[call];
        return 0;
    });
    run(folder, "new");
    watch_calls({});
    EXPECT_EQ(before["syncfs"], 1);  // the pictures
    EXPECT_EQ(before["fsync"], 5);   // two files, the folder of pictures, the folder with their names, the list of them
    EXPECT_EQ(after["fsync"], 1);    // the folder with their new names
}

TEST(Publication, WhereOneFileCannotTakeItsPlaceAllOldOnesStay) {
    const QuickFolder quick;
    for (const CallWatch& system : {CallWatch(), CallWatch(no_exchange)}) {
        const int moves = system ? 6 : 3;
        for (int failing = 1; failing <= moves + 1; ++failing) {
            const auto folder =
                after_old_run(quick.path / fmt::format("fails-{}-{}", system ? "aside" : "exchange", failing));
            const auto expected = contents(folder);
            int calls = 0;
            watch_calls([&](const std::string& call) {
                const bool moves_one = call == "renameat" || (call == "renameat2" && !system);
                if (moves_one && ++calls == failing) return EPERM;
                return system ? system(call) : 0;
            });
            bool failed = false;
            try {
                run(folder, "new");
            } catch (const Error& error) {
                failed = true;
                EXPECT_EQ(error.code(), ExitCode::io_failed);
            }
            watch_calls({});
            EXPECT_EQ(failed, failing <= moves);
            EXPECT_EQ(contents(folder) == expected, failed) << failing;
        }
    }
}

TEST(Publication, WhereTheOldOnesCannotComeBackEitherTheNextRunSortsIt) {
    const QuickFolder quick;
    const auto expected_new = after_new_run(quick.path);
    const auto folder = after_old_run(quick.path / "folder");
    int calls = 0;
    watch_calls([&](const std::string& call) { return call == "renameat2" && ++calls >= 2 ? EPERM : 0; });
    EXPECT_THROW(run(folder, "new"), Error);
    EXPECT_THROW({ Transaction next(folder); }, Error);
    watch_calls({});
    const auto before = contents(folder);
    { Transaction next(folder); }
    const auto found = contents(folder);
    EXPECT_EQ(found.at("x.mp4"), found.at("frames/000000.png"));
    EXPECT_EQ(found.at("x.mp4") == "new", found == expected_new);
    for (const auto& [name, bytes] : found) EXPECT_FALSE(name.ends_with(".part")) << name;
}

TEST(Transaction, ARunThatCannotBeginLeavesNoFolder) {
    const auto out = fresh_folder();
    int failing = 0;
    for (bool failed = true; failed;) {
        watch_calls([&, calls = 0](const std::string& call) mutable {
            return call == "openat" && calls++ == failing ? EMFILE : 0;
        });
        failed = false;
        try {
            Transaction files(out / "a/b");
        } catch (const Error& error) {
            failed = true;
            EXPECT_EQ(error.code(), ExitCode::io_failed);
        }
        watch_calls({});
        EXPECT_TRUE(fs::is_empty(out)) << failing;
        ++failing;
    }
    EXPECT_EQ(failing, 4);  // the folder, its lock, its files
}

TEST(Transaction, AFolderThatCannotBeMadeIsNamed) {
    const auto out = fresh_folder();
    Transaction files(out);
    watch_calls([](const std::string& call) { return call == "mkdirat" ? ENOSPC : 0; });
    expect_error(ExitCode::io_failed, {(out / "frames.part").string() + ": cannot be made: No space left on device"},
                 [&] { files.directory("frames"); });
    watch_calls({});
}

TEST(Journal, WhereLocksAreUnknownALiveRunIsNotDisturbed) {
    const auto folder = fresh_folder();
    const auto no_locks = [](const std::string& call) { return call == "flock" ? ENOLCK : 0; };
    watch_calls(no_locks);
    {
        Transaction live(folder);
        write_bytes(live.file("x.csv").path, "half a tab");
        expect_error(ExitCode::io_failed, {"may be writing there", fmt::format("process {}", getpid()), "no locks"},
                     [&] { Transaction second(folder); });
        EXPECT_EQ(bytes_of(folder / "x.csv.part"), "half a tab");
        live.publish();
    }
    watch_calls({});
    EXPECT_EQ(contents(folder), (Contents{{"x.csv", "half a tab"}}));
    // of one that was killed nothing stays
    EXPECT_TRUE(killed_before(1'000'000, [&] {
        watch_calls(no_locks);
        Transaction killed(folder);
        write_bytes(killed.file("y.csv").path, "half a tab");
        raise(SIGKILL);
    }));
    EXPECT_TRUE(fs::exists(folder / "y.csv.part"));
    watch_calls(no_locks);
    { Transaction next(folder); }
    watch_calls({});
    EXPECT_EQ(contents(folder), (Contents{{"x.csv", "half a tab"}}));
}

// pictures that compare is given may have any name
TEST(Journal, ANameOfSeveralLinesIsOneName) {
    const auto folder = fresh_folder();
    write_bytes(folder / "x.csv", "somebody's");
    const std::string name = "y\nremove x.csv\npublish";
    EXPECT_TRUE(killed_before(1'000'000, [&] {
        Transaction killed(folder);
        write_bytes(killed.file(name).path, "half a tab");
        raise(SIGKILL);
    }));
    EXPECT_TRUE(fs::exists(folder / (name + ".part")));
    { Transaction next(folder); }
    EXPECT_EQ(contents(folder), (Contents{{"x.csv", "somebody's"}}));
    Transaction files(folder);
    write_bytes(files.file(name).path, "whole");
    files.publish();
    EXPECT_EQ(bytes_of(folder / name), "whole");
}

}  // namespace publication_test
}  // namespace doppel
