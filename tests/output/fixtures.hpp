#pragma once

#include "base/error.hpp"
#include "image/picture.hpp"
#include "output/sink.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <vector>

namespace doppel::test {

/// An empty folder for the current test.
std::filesystem::path fresh_folder();

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

/// Expects that `action` throws an Error with this exit code, whose message contains `words`.
void expect_error(ExitCode code, const std::vector<std::string>& words, const std::function<void()>& action);

}  // namespace doppel::test
