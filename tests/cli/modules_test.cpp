#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>

namespace {

namespace fs = std::filesystem;

// Which module may include which: dependencies have one direction.
//     base ← numeric ← physics ← integrate ← analysis, track ┐
//     base ← image ← render ← plot ←─────────────────────────┼─ scene ← film ← figure, fit ← cli ← main
//     base ← image ← output ─────────────────────────────────┘
const std::map<std::string, std::set<std::string>> needs{
    {"base", {}},
    {"numeric", {"base"}},
    {"physics", {"numeric"}},
    {"integrate", {"physics"}},
    {"analysis", {"integrate"}},
    {"track", {"integrate"}},
    {"image", {"base"}},
    {"render", {"image"}},
    {"plot", {"render"}},
    {"output", {"image"}},
    {"scene", {"analysis", "track", "output", "plot"}},
    {"film", {"scene"}},
    {"figure", {"film"}},
    {"fit", {"film"}},
    {"cli", {"figure", "fit"}},
};

/// The modules that a module needs, and those that these need.
std::set<std::string> allowed(const std::string& module) {
    auto all = needs.at(module);
    for (const auto& other : needs.at(module)) all.merge(allowed(other));
    return all;
}

/// Calls visit(file, module or system header) for every include in src.
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

TEST(Modules, IncludeOnlyWhatTheyMay) {
    long seen = 0;
    for_each_include([&](const fs::path& file, const std::string& header) {
        if (file.filename() == "main.cpp") return;
        const auto module = file.parent_path().filename().string();
        const auto other = fs::path(header).begin()->string();
        ASSERT_TRUE(needs.contains(module)) << file << " is in a module of which nothing is said above";
        if (!needs.contains(other) || other == module || other == header) return;  // <numeric> is a file
        EXPECT_TRUE(allowed(module).contains(other)) << file << " includes " << header;
        ++seen;
    });
    EXPECT_GT(seen, 300);  // measured 334
}

/// Plots consist of shapes and text, and do not depend on OpenGL.
TEST(Modules, PlotsKnowNoOpenGl) {
    for_each_include([](const fs::path& file, const std::string& header) {
        if (file.parent_path().filename() != "plot") return;
        EXPECT_FALSE(header.starts_with("render/gl") || header == "render/renderer.hpp") << file << ": " << header;
    });
}

/// A library whose headers are included in one module only, in files whose names begin with `file`.
struct Library {
    std::string_view header, module, file;
};
constexpr Library libraries[]{
    {"GL/", "render", "gl_"},
    {"EGL/", "render", "gl_"},
    {"stb_truetype", "render", "font"},
    {"ft2build", "render", "font"},
    {"libavformat/", "output", "libav"},
    {"libavcodec/", "output", "libav"},
    {"fontconfig/", "render", "typeface"},
    {"libavutil/", "output", ""},
    {"libdeflate", "output", ""},
    {"libavfilter/", "output", "gif"},
    {"stb_image", "output", ""},
    {"toml++/", "scene", ""},
    {"CLI/", "cli", ""},
};

TEST(Modules, KeepTheirLibrariesToThemselves) {
    std::set<std::string_view> seen;
    for_each_include([&](const fs::path& file, const std::string& header) {
        const auto module = file.parent_path().filename().string(), name = file.filename().string();
        for (const auto& library : libraries) {
            if (!header.starts_with(library.header)) continue;
            seen.insert(library.header);
            const bool is_main = library.module == "cli" && name == "main.cpp";
            EXPECT_TRUE(is_main || (module == library.module && name.starts_with(library.file)))
                << file << ": " << header;
        }
    });
    EXPECT_EQ(seen.size(), std::size(libraries));
}

}  // namespace
