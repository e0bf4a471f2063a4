#pragma once

#include "image/golden.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

enum class Match { passes, differs, missing, unreadable };

/// One picture of a golden comparison.
struct ComparedPicture {
    std::string name;                            // file name without its folder
    std::filesystem::path expected, actual;      // expected: the golden that matches, or the nearest one
    std::vector<std::filesystem::path> goldens;  // any of them may match; the first is no variant, if there is one
    Match match = Match::passes;
    std::string message = {};    // the program's message; of a picture that passes, mostly empty
    GoldenVerdict verdict = {};  // valid if both could be read and have the same size
    Size size = {}, actual_size = {};
    double seconds = 0;  // duration of the comparison
};

struct Comparison {
    std::string expected, actual;  // as the user gave them: pictures, folders, or a preset to draw
    std::vector<ComparedPicture> pictures;

    long count(Match match) const;
    /// "2 of 12 pictures differ"; counts missing pictures, too.
    std::string summary() const;
};

/// The start of the report.
inline constexpr std::string_view junit_start = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Doppel compare -->";

/// JUnit XML for test servers: one test case per picture. A picture that differs or is missing is a failure, one
/// that cannot be read is an error. Throws Error (exit 4) if the file cannot be written.
void write_junit(const std::filesystem::path& place, const Comparison& comparison);

/// One self-contained HTML page: the summary, and each different picture as expected, actual and
/// difference × 16, with a slider between the first two. Above 100 MB, further pictures are listed without pixels.
/// Reads the pictures that differ again, one at a time. Throws Error (exit 4).
void write_compare_page(const std::filesystem::path& place, const Comparison& comparison);

}  // namespace doppel
