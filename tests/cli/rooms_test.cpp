#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

// Who may include whom: dependencies run one way.
//     numeric ← physics ← integrate ← analysis ┐
//     numeric ← picture ← output ──────────────┴← scene ← film ← figure ← cli ← main
const std::map<std::string, std::set<std::string>> needs{
    {"numeric", {}},
    {"physics", {"numeric"}},
    {"integrate", {"physics", "numeric"}},
    {"analysis", {"integrate", "physics", "numeric"}},
    {"picture", {"numeric"}},
    {"output", {"picture", "numeric"}},
    {"scene", {"analysis", "integrate", "physics", "output", "picture", "numeric"}},
    {"film", {"scene", "analysis", "integrate", "physics", "output", "picture", "numeric"}},
    {"figure", {"film", "scene", "analysis", "integrate", "physics", "output", "picture", "numeric"}},
    {"cli", {"figure", "film", "scene", "analysis", "integrate", "physics", "output", "picture", "numeric"}},
};

/// Calls visit(file, room or system header) for every include in src.
template <class Visit>
void for_each_include(Visit&& visit) {
    const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(DOPPEL_SOURCE_DIR) / "src")) {
        if (!entry.is_regular_file()) continue;
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);)
            if (std::smatch match; std::regex_search(line, match, include)) visit(entry.path(), match[1].str());
    }
}

TEST(Rooms, IncludeOnlyWhatTheyMay) {
    long seen = 0;
    for_each_include([&](const fs::path& file, const std::string& header) {
        const auto room = file.parent_path().filename().string();
        const auto other = fs::path(header).begin()->string();
        if (!needs.contains(room) || !needs.contains(other) || other == room) return;
        EXPECT_TRUE(needs.at(room).contains(other)) << file << " includes " << header;
        ++seen;
    });
    EXPECT_GT(seen, 30);
}

TEST(Rooms, KeepTheirLibrariesToThemselves) {
    for_each_include([](const fs::path& file, const std::string& header) {
        const auto room = file.parent_path().filename().string(), name = file.filename().string();
        if (header.starts_with("GL/") || header.starts_with("EGL/")) {
            EXPECT_TRUE(room == "picture" && name.starts_with("gl_")) << file;
        }
        if (header.starts_with("libavformat/") || header.starts_with("libavcodec/") ||
            header.starts_with("libswscale/")) {
            EXPECT_TRUE(room == "output" && (name.starts_with("libav") || name == "video.cpp")) << file;
        }
        if (header.starts_with("CLI/")) {
            EXPECT_TRUE(room == "cli" || name == "main.cpp") << file;
        }
    });
}

}  // namespace
