#include "base/read_file.hpp"

#include "errors.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace doppel::read_file_test {

namespace fs = std::filesystem;

std::string refusal(const fs::path& path) {
    return test::thrown_by([&] { read_whole_file(path, {"a track is a CSV file", std::size_t{1} << 20}); }).second;
}

// a pipe without a writer, or an endless device, once kept the first Ctrl-C from stopping the run
TEST(ReadFile, TakesRegularFilesOfALimitedSizeAlone) {
    const auto folder = fs::path(testing::TempDir()) / ("doppel-read-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const auto pipe = folder / "pipe.csv", zero = folder / "zero.csv", longest = folder / "long.csv";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("/dev/zero", zero);
    std::ofstream(longest) << std::string((std::size_t{1} << 20) + 1, ' ');
    EXPECT_EQ(refusal(pipe), pipe.string() + " is not a file; a track is a CSV file");
    EXPECT_EQ(refusal(zero), zero.string() + " is not a file; a track is a CSV file");
    EXPECT_EQ(refusal(folder), folder.string() + " is a folder; a track is a CSV file");
    EXPECT_EQ(refusal(longest), longest.string() + " has more than 1 MB; a track is a CSV file");
    // the system would open the name up to the NUL
    EXPECT_EQ(refusal(fs::path(longest.string() + std::string("\0b", 2))),
              longest.string() + " b: contains a NUL character; a file name cannot");
    EXPECT_EQ(refusal(folder / "none"), (folder / "none").string() + ": there is no such file");
    std::ofstream(longest) << std::string(std::size_t{1} << 20, ' ');
    EXPECT_EQ(refusal(longest), "no error");
    fs::remove_all(folder);
}

}  // namespace doppel::read_file_test
