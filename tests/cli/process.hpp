#pragma once

#include "output/fixtures.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace doppel::test {

/// Starts a program in `folder`; its standard output and error go to the files stdout and stderr there.
inline pid_t start_program(const std::filesystem::path& folder, const char* program,
                           const std::vector<std::string>& arguments, const std::function<void()>& prepare = {}) {
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

inline pid_t start(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                   const std::function<void()>& prepare = {}) {
    return start_program(folder, DOPPEL_PROGRAM, arguments, prepare);
}

/// The exit code, or minus the signal that ended it.
inline int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

struct Outcome {
    int code;
    std::string out, err;
};

inline Outcome doppel(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                      const std::function<void()>& prepare = {}) {
    const int code = wait_for(start(folder, arguments, prepare));
    return {code, bytes_of(folder / "stdout"), bytes_of(folder / "stderr")};
}

/// Runs a shell command in `folder`; "$DOPPEL" is the program.
inline Outcome shell(const std::filesystem::path& folder, const std::string& script) {
    const auto prepare = [] { setenv("DOPPEL", DOPPEL_PROGRAM, 1); };
    const int code = wait_for(start_program(folder, "/bin/sh", {"-c", script}, prepare));
    return {code, bytes_of(folder / "stdout"), bytes_of(folder / "stderr")};
}

inline bool left_nothing(const std::filesystem::path& folder) {
    return !std::filesystem::exists(folder / "out") || std::filesystem::is_empty(folder / "out");
}

inline std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& more) {
    command.insert(command.end(), more.begin(), more.end());
    return command;
}

}  // namespace doppel::test
