#pragma once

#include "cli/process.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <thread>

namespace doppel::test {

/// All paths below `folder`, relative to it; empty if it does not exist.
inline std::set<std::string> listing(const std::filesystem::path& folder) {
    std::set<std::string> names;
    if (!std::filesystem::exists(folder)) return names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        names.insert(entry.path().lexically_relative(folder).string());
    return names;
}

/// Waits until `happened` returns true; false after 30 s.
inline bool wait_until(const std::function<bool()>& happened) {
    for (int i = 0; i < 3000; ++i) {
        if (happened()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// Like wait_for(), but kills the program after `seconds` (−SIGKILL).
inline int wait_at_most(pid_t child, double seconds) {
    int status = 0;
    for (double waited = 0; waited < seconds; waited += 0.01) {
        if (waitpid(child, &status, WNOHANG) == child)
            return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    kill(child, SIGKILL);
    return wait_for(child);
}

/// Whether the text is one line that begins with "doppel: ".
inline bool one_line(const std::string& text) {
    return text.starts_with("doppel: ") && std::count(text.begin(), text.end(), '\n') == 1;
}

/// Runs a shell command like shell(), where it may mount without effect on other processes.
inline Outcome shell_with_mounts(const std::filesystem::path& folder, const std::string& script) {
    const auto prepare = [] { setenv("DOPPEL", DOPPEL_PROGRAM, 1); };
    const std::string unshare = geteuid() == 0 ? "exec unshare -m " : "exec unshare -rm ";
    const auto quoted = unshare + "/bin/sh -c \"$0\"";
    const int code = wait_for(start_program(folder, "/bin/sh", {"-c", quoted, script}, prepare));
    return {code, bytes_of(folder / "stdout"), bytes_of(folder / "stderr")};
}

/// Whether this machine allows tests to mount.
inline bool can_mount(const std::filesystem::path& folder) {
    return shell_with_mounts(folder, "mkdir -p m && mount -t tmpfs none m").code == 0;
}

}  // namespace doppel::test
