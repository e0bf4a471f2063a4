#pragma once

#include "cli/process.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <thread>

namespace doppel::test {

/// All that is below `folder`, as paths relative to it; nothing where it is not there.
inline std::set<std::string> listing(const std::filesystem::path& folder) {
    std::set<std::string> names;
    if (!std::filesystem::exists(folder)) return names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        names.insert(entry.path().lexically_relative(folder).string());
    return names;
}

/// Until `happened`; false after 30 s.
inline bool wait_until(const std::function<bool()>& happened) {
    for (int i = 0; i < 3000; ++i) {
        if (happened()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// As wait_for(), but a program that does not end by itself within `seconds` is killed (−SIGKILL).
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

/// "doppel: …", and no more.
inline bool one_line(const std::string& text) {
    return text.starts_with("doppel: ") && std::count(text.begin(), text.end(), '\n') == 1;
}

/// Runs a line of shell as shell() does, where it may mount what nobody else sees.
inline Outcome shell_with_mounts(const std::filesystem::path& folder, const std::string& script) {
    const auto prepare = [] { setenv("DOPPEL", DOPPEL_PROGRAM, 1); };
    const std::string unshare = geteuid() == 0 ? "exec unshare -m " : "exec unshare -rm ";
    const auto quoted = unshare + "/bin/sh -c \"$0\"";
    const int code = wait_for(start_program(folder, "/bin/sh", {"-c", quoted, script}, prepare));
    return {code, bytes_of(folder / "stdout"), bytes_of(folder / "stderr")};
}

/// Whether this machine lets a test mount.
inline bool can_mount(const std::filesystem::path& folder) {
    return shell_with_mounts(folder, "mkdir -p m && mount -t tmpfs none m").code == 0;
}

}  // namespace doppel::test
