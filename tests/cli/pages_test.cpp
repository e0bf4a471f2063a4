#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace pages_test {

namespace fs = std::filesystem;

const fs::path top = DOPPEL_SOURCE_DIR;

std::string text_of(const fs::path& page) {
    std::ifstream file(page);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> pages() {
    std::vector<fs::path> found{top / "README.md"};
    for (const auto& entry : fs::directory_iterator(top / "docs"))
        if (entry.path().extension() == ".md") found.push_back(entry.path());
    return found;
}

/// The first group of `pattern` for each match.
std::vector<std::string> all(const std::string& text, const std::regex& pattern) {
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        found.push_back((*match)[1]);
    return found;
}

TEST(Pages, LinkToFilesThatExist) {
    std::size_t links = 0;
    for (const auto& page : pages())
        for (const auto& target : all(text_of(page), std::regex(R"(\]\(([^)#:]+)\))"))) {
            EXPECT_TRUE(fs::exists(page.parent_path() / target)) << page << " links to " << target;
            ++links;
        }
    EXPECT_GT(links, 25u);  // measured 60
}

TEST(Pages, TheReadmeIsShort) {
    const auto readme = text_of(top / "README.md");
    EXPECT_GT(readme.size(), 2000u);
    EXPECT_LE(readme.size(), 6144u);
}

TEST(Pages, AreShortAndSayWhatTheReaderCanDo) {
    for (const auto& page : pages()) {
        const auto text = text_of(page);
        EXPECT_LE(text.size(), 12'288u) << page;
        const bool is_made_by_a_test = page.filename() == "study.md";
        if (page.filename() != "README.md" && !is_made_by_a_test) {
            EXPECT_LT(text.find("\n\nAfter reading this page you "), 100u) << page;
        }
    }
}

/// Every preset of `folder` is named on `page`, as code.
void expect_named(const fs::path& folder, const fs::path& page) {
    const auto text = text_of(page);
    std::size_t presets = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != ".toml") continue;
        const auto name = entry.path().stem().string();
        // the figures of the study: from fig2-left to fig8
        const bool is_of_study = std::regex_match(name, std::regex("fig[2-8].*"));
        EXPECT_TRUE(is_of_study || text.find('`' + name + '`') != std::string::npos) << page << " lacks " << name;
        ++presets;
    }
    EXPECT_GT(presets, 10u);
}

TEST(Pages, NameEveryPreset) {
    expect_named(top / "presets", top / "docs/films.md");
    expect_named(top / "presets/figures", top / "docs/figures.md");
}

}  // namespace pages_test
