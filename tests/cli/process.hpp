#pragma once

#include "output/fixtures.hpp"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <iomanip>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace doppel::test {

/// The words of a command line: a text is split at its spaces, outside of 'words in quotes'.
struct Words : std::vector<std::string> {
    Words(const char* text) : Words(std::string(text)) {}
    Words(const std::string& text) {
        std::istringstream words(text);
        for (std::string word; words >> std::quoted(word, '\'');) push_back(word);
    }
    Words(std::initializer_list<std::string> words = {}) : std::vector<std::string>(words) {}
    Words(std::vector<std::string> words) : std::vector<std::string>(std::move(words)) {}
};

inline Words with(Words command, const Words& more) {
    command.insert(command.end(), more.begin(), more.end());
    return command;
}

/// Starts a program in `folder`; its standard output and error go to the files stdout and stderr there.
inline pid_t start_program(const char* program, const Words& arguments, const std::function<void()>& prepare = {},
                           const std::filesystem::path& folder = test_folder()) {
    const pid_t child = forked(fork());
    if (child != 0) return child;
    if (chdir(folder.c_str()) != 0) _exit(99);
    const int out = open("stdout", O_CREAT | O_TRUNC | O_WRONLY, 0644),
              err = open("stderr", O_CREAT | O_TRUNC | O_WRONLY, 0644);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    if (prepare) prepare();
    std::vector<char*> argv{const_cast<char*>(program)};
    for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(program, argv.data());
    _exit(98);
}

inline pid_t start(const Words& arguments, const std::function<void()>& prepare = {},
                   const std::filesystem::path& folder = test_folder()) {
    return start_program(DOPPEL_PROGRAM, arguments, prepare, folder);
}

inline int code_of(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// The exit code, or minus the signal that ended it.
inline int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return code_of(status);
}

/// Waits until `happened` returns true; false after 30 s.
inline bool wait_until(const std::function<bool()>& happened) {
    for (int i = 0; i < 15'000; ++i) {
        if (happened()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

/// Like wait_for(), but kills the program after `seconds` (−SIGKILL).
inline int wait_at_most(pid_t child, double seconds) {
    int status = 0;
    for (double waited = 0; waited < seconds; waited += 0.002) {
        if (waitpid(child, &status, WNOHANG) == child) return code_of(status);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    kill(child, SIGKILL);
    return wait_for(child);
}

struct Outcome {
    int code;
    std::string out, err;
};

inline Outcome outcome_of(pid_t child) {
    const int code = wait_for(child);
    return {code, bytes_of(test_folder() / "stdout"), bytes_of(test_folder() / "stderr")};
}

inline Outcome doppel(const Words& arguments, const std::function<void()>& prepare = {}) {
    return outcome_of(start(arguments, prepare));
}

/// Whether the text is one line that begins with "doppel: ".
inline testing::AssertionResult one_line(const std::string& text) {
    if (text.starts_with("doppel: ") && std::ranges::count(text, '\n') == 1) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "not one line of Doppel's:\n" << text;
}

/// The same; the program must exit with this code.
inline Outcome ends(const Words& arguments, int code, const std::function<void()>& prepare = {}) {
    auto outcome = doppel(arguments, prepare);
    EXPECT_EQ(outcome.code, code) << fmt::format("{}\n{}{}", fmt::join(arguments, " "), outcome.out, outcome.err);
    return outcome;
}
inline Outcome done(const Words& arguments, const std::function<void()>& prepare = {}) {
    return ends(arguments, 0, prepare);
}

/// The same; and with one line that has the words.
inline Outcome expect_refused(const Words& arguments, int code, std::string_view words,
                              const std::function<void()>& prepare = {}) {
    auto outcome = ends(arguments, code, prepare);
    EXPECT_TRUE(one_line(outcome.err)) << fmt::format("{}", fmt::join(arguments, " "));
    EXPECT_TRUE(has(outcome.err, words)) << fmt::format("{}", fmt::join(arguments, " "));
    return outcome;
}

/// In a shell command, the program.
inline const std::string program = "\"$DOPPEL\" ";

/// Runs a shell command in the folder of the test; "$DOPPEL" is the program.
inline Outcome shell(const std::string& script, const std::string& start = "exec /bin/sh -c \"$0\"") {
    const auto prepare = [] { setenv("DOPPEL", DOPPEL_PROGRAM, 1); };
    return outcome_of(start_program("/bin/sh", {"-c", start, script}, prepare));
}

/// The same, where it may mount without effect on other processes.
inline Outcome shell_with_mounts(const std::string& script) {
    return shell(script, fmt::format("exec unshare {} /bin/sh -c \"$0\"", geteuid() == 0 ? "-m" : "-rm"));
}

/// Whether this machine allows tests to mount.
inline bool can_mount() {
    return shell_with_mounts("mkdir -p m && mount -t tmpfs none m").code == 0;
}

inline bool left_nothing() {
    return listing(test_folder() / "out").empty();
}

inline std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// A test that runs the program in an empty folder.
using ProgramTest = InFolder;

/// A preset: a map of flip times, 8 × 8.
inline constexpr const char* small_map =
    "[scene]\nkind = \"grid\"\nduration_s = 1\n[grid]\nquantity = \"flip_time\"\n[grid.x]\npoints = 8\n"
    "[grid.y]\nkey = \"theta2_deg\"\npoints = 8\n";

}  // namespace doppel::test
