#pragma once

#include "base/error.hpp"
#include "image/picture.hpp"
#include "output/sink.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace doppel::test {

/// The folder of the current test; fresh_folder() empties it.
std::filesystem::path test_folder();
std::filesystem::path fresh_folder();

/// A test with an empty folder.
class InFolder : public testing::Test {
protected:
    const std::filesystem::path folder = fresh_folder();
};

/// All paths below `folder`, relative to it; empty if it does not exist.
using Names = std::set<std::string>;
Names listing(const std::filesystem::path& folder);

std::string bytes_of(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// The result of fork(). Throws std::system_error if it failed, because kill(-1, …) would end every process.
inline int forked(int child) {
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    return child;
}

/// Frame k of a scene like a film's: dark background, two pendulums with antialiased discs, fading trails, thin lines.
Picture moving_scene(Size size, long k);

/// Writes `frames` of scene(size, k) as a video; returns its path.
std::filesystem::path film(const std::filesystem::path& path, const VideoOptions& options, long frames,
                           Picture (*scene)(Size, long) = moving_scene);

/// Random bytes, which cannot be compressed.
Picture noise(Size size, unsigned seed);

inline std::vector<Rect> whole(Size size) {
    return {{0, 0, size.width, size.height}};
}

/// Limits the files of this process to `bytes` during its lifetime: the same as a full disk, on any file system.
class FullDisk {
public:
    explicit FullDisk(std::uintmax_t bytes);
    ~FullDisk();
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
};

struct Video;

/// BT.709 in limited range, chroma in the centre.
void expect_bt709(const Video& video);
/// The same, and H.264, yuv420p, the index at the front.
void expect_tags(const Video& video);

/// Whether the text has, or begins with, these words; a failure shows the text.
inline testing::AssertionResult has(const std::string& text, std::string_view words) {
    const bool found = text.find(words) != std::string::npos;
    return testing::AssertionResult(found) << '"' << words << (found ? "\" is in:\n" : "\" is not in:\n") << text;
}
inline testing::AssertionResult has(const std::string& text, std::initializer_list<std::string_view> all) {
    for (const auto words : all)
        if (auto found = has(text, words); !found) return found;
    return testing::AssertionSuccess();
}
inline testing::AssertionResult begins(const std::string& text, std::string_view words) {
    return testing::AssertionResult(text.starts_with(words)) << '"' << words << "\" does not begin:\n" << text;
}

/// Expects that `action` throws an Error with this exit code, whose message contains `words`.
void expect_error(ExitCode code, const std::vector<std::string>& words, const std::function<void()>& action);
inline void expect_io_failed(const std::vector<std::string>& words, const std::function<void()>& action) {
    expect_error(ExitCode::io_failed, words, action);
}

}  // namespace doppel::test
