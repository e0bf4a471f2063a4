// What the pages say that a command can tell: they are run, and must still say so.
#include "cli/sandbox.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace doppel {
namespace docs_test {

namespace fs = std::filesystem;
using namespace test;

/// README.md and docs/*.md.
std::vector<fs::path> pages() {
    const fs::path source(DOPPEL_SOURCE_DIR);
    std::vector<fs::path> all{source / "README.md"};
    for (const auto& entry : fs::directory_iterator(source / "docs"))
        if (entry.path().extension() == ".md") all.push_back(entry.path());
    return all;
}

/// Every match of `pattern` in a page runs as `run` says, which has its groups.
template <class Run>
void on_every(const char* pattern, const Run& run) {
    const std::regex what(pattern);
    int seen = 0;
    for (const auto& page : pages()) {
        const auto text = bytes_of(page);
        for (std::sregex_iterator found(text.begin(), text.end(), what), end; found != end; ++found, ++seen)
            run(page.filename().string(), *found);
    }
    EXPECT_GT(seen, 0);
}

const std::string doppel_is_this_one = "set -e; doppel() { \"$DOPPEL\" \"$@\"; }; ";

TEST(Docs, NumbersWithACommandAreWhatItTells) {
    on_every("<!-- \\$ ([^\\n]*) -->", [](const std::string& page, const std::smatch& found) {
        const auto result = shell(fresh_folder(), doppel_is_this_one + found.str(1));
        EXPECT_EQ(result.code, 0) << page << ": " << found.str(1) << '\n' << result.out << result.err;
    });
}

TEST(Docs, ExamplesPrintWhatTheySay) {
    on_every("\\n```\\n\\$ ./(doppel [^\\n]*)\\n([^`]*)```", [](const std::string& page, const std::smatch& found) {
        const auto result = shell(fresh_folder(), doppel_is_this_one + found.str(1));
        EXPECT_NE(result.out.find(found.str(2)), std::string::npos) << page << ": " << found.str(1) << '\n'
                                                                    << result.out << result.err;
    });
}

}  // namespace docs_test
}  // namespace doppel
