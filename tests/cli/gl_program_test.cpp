#include "cli/process.hpp"
#include "image/golden.hpp"
#include "output/png.hpp"
#include "render/osmesa_or_egl.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace doppel::gl_program_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::doppel;
using test::fresh_folder;
using test::left_nothing;
using test::with;

const std::vector<std::string> film{"--set", "scene.duration_s=0.1", "--size", "160x90", "--format",
                                    "png",   "--progress",           "none"};
/// The OpenGL library that drew, from the manifest in OUT/NAME/.
std::string drawn_by(const fs::path& out, const std::string& name) {
    const auto manifest = nlohmann::json::parse(bytes_of(out / name / (name + ".json")));
    return manifest["libraries"]["gl"];
}

/// A folder where the dynamic linker finds `libraries` first, each of them invalid.
fs::path spoil(const fs::path& folder, const std::vector<std::string>& libraries) {
    fs::create_directory(folder / "spoilt");
    for (const auto& library : libraries) test::write_bytes(folder / "spoilt" / library, "no library");
    return folder / "spoilt";
}
const std::vector<std::string> osmesa_files{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"},
    egl_files{"libEGL.so.1", "libEGL.so"};

TEST(GlProgram, DrawsFilmsWithTheLibraryAskedFor) {
    const auto folder = fresh_folder();
    for (const std::string out : {"osmesa", "egl"}) {
        const auto gl = out == "egl" ? out : test::name_of_osmesa_or_egl();
        const auto result = doppel(folder, with({"render", "butterfly", "--gl", gl, "-o", out}, film));
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "") << "Mesa's own words are for nobody";
    }
    EXPECT_EQ(drawn_by(folder / "osmesa", "butterfly").rfind(test::library_of_osmesa_or_egl() + ", ", 0), 0u);
    EXPECT_EQ(drawn_by(folder / "egl", "butterfly").rfind("EGL, ", 0), 0u);
    EXPECT_EQ(doppel(folder, {"compare", "osmesa/butterfly/frames", "egl/butterfly/frames"}).code, 0);
}

TEST(GlProgram, NeedsNoLibraryForAnythingButFilms) {
    const auto folder = fresh_folder();
    const auto path = spoil(folder, with(osmesa_files, egl_files));
    const auto spoilt = [&] { setenv("LD_LIBRARY_PATH", path.c_str(), 1); };
    for (const auto& command : std::vector<std::vector<std::string>>{
             {"--help"},
             {"render", "--help"},
             {"list"},
             {"check", "calm"},
             {"simulate", "calm", "--set", "scene.duration_s=1", "--progress", "none"},
             {"figure", "fig2-right", "--set", "grid.x.to=9", "--progress", "none"}}) {
        const auto result = doppel(folder, command, spoilt);
        EXPECT_EQ(result.code, 0) << command[0] << ": " << result.err;
        EXPECT_EQ(result.err, "");
    }
}

TEST(GlProgram, DrawsWithEglWhereOsmesaIsMissing) {
    const auto folder = fresh_folder();
    const auto path = spoil(folder, osmesa_files);
    const auto spoilt = [&] { setenv("LD_LIBRARY_PATH", path.c_str(), 1); };
    const auto result = doppel(folder, with({"render", "butterfly"}, film), spoilt);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(drawn_by(folder / "out", "butterfly").rfind("EGL, ", 0), 0u);
}

TEST(GlProgram, ExitsWith4WhereNothingCanDraw) {
    const auto folder = fresh_folder();
    const auto path = spoil(folder, with(osmesa_files, egl_files));
    const auto spoilt = [&] { setenv("LD_LIBRARY_PATH", path.c_str(), 1); };
    const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> cases{
        {with({"render", "butterfly"}, film), {"OSMesa cannot draw", "libosmesa6", "EGL cannot draw", "libegl-mesa0"}},
        {with({"render", "butterfly", "--gl", "osmesa"}, film), {"OSMesa cannot draw", "libOSMesa.so.8: "}},
        {with({"render", "butterfly", "--gl", "egl"}, film), {"doppel: EGL cannot draw", "libEGL.so.1: "}}};
    for (const auto& [command, all_words] : cases) {
        const auto result = doppel(folder, command, spoilt);
        EXPECT_EQ(result.code, 4) << result.err;
        for (const auto& words : all_words) EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_TRUE(left_nothing(folder));
    }
}

}  // namespace doppel::gl_program_test
