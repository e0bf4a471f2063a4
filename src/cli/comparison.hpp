#pragma once

#include "image/golden.hpp"
#include "output/files.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

enum class Match { passes, differs, missing, unreadable };

/// One picture of a golden comparison.
struct ComparedPicture {
    std::string name;  // of the file, without its folder
    std::filesystem::path expected, actual;
    Match match = Match::passes;
    std::string message;    // what the program says of it; empty where it passes
    GoldenVerdict verdict;  // where both could be read and have one size
    Size size, actual_size;
    double seconds = 0;  // that the comparison took
};

struct Comparison {
    std::string expected, actual;  // as they were given: two pictures or two folders
    std::vector<ComparedPicture> pictures;

    long count(Match match) const;
    /// "2 of 12 pictures differ": those that are missing too.
    std::string summary() const;
};

/// What the report begins with.
inline constexpr std::string_view junit_start = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Doppel compare -->";

/// JUnit's XML, as test servers read it: a test case a picture; a picture that differs or is missing is a failure, one
/// that cannot be read an error. Throws Error (exit 4) where it cannot be written.
void write_junit(const std::filesystem::path& place, const Comparison& comparison);

/// One page of HTML that needs nothing else: the summary, and every picture that differs as expected, actual and
/// difference × 16, with a slider between the first two. Of a page over 100 MB the rest is named, not shown. Reads the
/// pictures that differ again, one at a time. Throws Error (exit 4).
void write_compare_page(const std::filesystem::path& place, const Comparison& comparison);

}  // namespace doppel
