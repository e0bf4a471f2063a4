#include "cli/process.hpp"
#include "image/golden.hpp"
#include "output/png.hpp"
#include "render/osmesa_or_egl.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace doppel::gl_program_test {

namespace fs = std::filesystem;
using namespace test;
using GlProgram = ProgramTest;

const Words film = "--set scene.duration_s=0.1 --size 160x90 --format png --progress none";
/// The OpenGL library that drew, from the manifest in OUT/NAME/.
std::string drawn_by(const fs::path& out, const std::string& name) {
    const auto manifest = nlohmann::json::parse(bytes_of(out / name / (name + ".json")));
    return manifest["libraries"]["gl"];
}

/// Before a run: the dynamic linker finds these `libraries` first, each of them invalid.
std::function<void()> spoil(const fs::path& folder, const Words& libraries) {
    const auto path = folder / "spoilt";
    fs::create_directory(path);
    for (const auto& library : libraries) write_bytes(path / library, "no library");
    return [path] { setenv("LD_LIBRARY_PATH", path.c_str(), 1); };
}
const Words osmesa_files = "libOSMesa.so.8 libOSMesa.so.6 libOSMesa.so", egl_files = "libEGL.so.1 libEGL.so";

TEST_F(GlProgram, DrawsFilmsWithTheLibraryAskedFor) {
    for (const std::string out : {"osmesa", "egl"}) {
        const auto gl = out == "egl" ? out : name_of_osmesa_or_egl();
        const auto result = done(with({"render", "butterfly", "--gl", gl, "-o", out}, film));
        EXPECT_EQ(result.err, "") << "Mesa's own words are for nobody";
    }
    EXPECT_TRUE(begins(drawn_by(folder / "osmesa", "butterfly"), library_of_osmesa_or_egl() + ", "));
    EXPECT_TRUE(begins(drawn_by(folder / "egl", "butterfly"), "EGL, "));
    done("compare osmesa/butterfly/frames egl/butterfly/frames");
}

TEST_F(GlProgram, NeedsNoLibraryForAnythingButFilms) {
    const auto spoilt = spoil(folder, with(osmesa_files, egl_files));
    for (const auto& command : std::vector<Words>{"--help", "render --help", "list", "check calm",
                                                  "simulate calm --set scene.duration_s=1 --progress none",
                                                  "figure fig2-right --set grid.x.to=9 --progress none"})
        EXPECT_EQ(done(command, spoilt).err, "");
}

TEST_F(GlProgram, DrawsWithEglWhereOsmesaIsMissing) {
    done(with("render butterfly", film), spoil(folder, osmesa_files));
    EXPECT_TRUE(begins(drawn_by(folder / "out", "butterfly"), "EGL, "));
}

TEST_F(GlProgram, ExitsWith4WhereNothingCanDraw) {
    const auto spoilt = spoil(folder, with(osmesa_files, egl_files));
    const std::vector<std::pair<Words, std::vector<std::string>>> cases{
        {with("render butterfly", film), {"OSMesa cannot draw", "libosmesa6", "EGL cannot draw", "libegl-mesa0"}},
        {with("render butterfly --gl osmesa", film), {"OSMesa cannot draw", "libOSMesa.so.8: "}},
        {with("render butterfly --gl egl", film), {"doppel: EGL cannot draw", "libEGL.so.1: "}}};
    for (const auto& [command, all_words] : cases) {
        for (const auto& words : all_words) expect_refused(command, 4, words, spoilt);
        EXPECT_TRUE(left_nothing());
    }
}

}  // namespace doppel::gl_program_test
