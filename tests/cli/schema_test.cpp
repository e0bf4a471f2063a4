// The schema of presets, and the line that names it for editors. With the real program.
#include "cli/process.hpp"

#include <nlohmann/json.hpp>

namespace doppel::schema_test {

namespace fs = std::filesystem;
using namespace test;
using Schema = ProgramTest;

const fs::path source = DOPPEL_SOURCE_DIR;

TEST_F(Schema, IsPrinted) {
    const auto printed = done("schema");
    EXPECT_EQ(printed.out, bytes_of(source / "presets/preset.schema.json"));
    EXPECT_EQ(nlohmann::json::parse(printed.out)["$schema"], "http://json-schema.org/draft-04/schema#");
}

TEST_F(Schema, LineOfAShownPresetIsRightForACopy) {
    const auto whole = bytes_of(source / "presets/butterfly.toml");
    const auto rest = whole.substr(whole.find('\n') + 1);
    EXPECT_EQ(doppel("show butterfly").out, rest);  // there is no schema
    fs::create_directories(folder / "presets");
    fs::copy_file(source / "presets/preset.schema.json", folder / "presets/preset.schema.json");
    EXPECT_EQ(doppel("show butterfly").out, "#:schema ./presets/preset.schema.json\n" + rest);
    write_bytes(folder / "mine.toml", whole);
    EXPECT_EQ(doppel("show mine.toml").out, whole);  // a user's preset is printed unchanged
    // the folders of an installed package
    fs::create_directories(folder / "usr/bin");
    fs::create_directories(folder / "usr/share/doppel/presets");
    fs::rename(folder / "presets/preset.schema.json", folder / "usr/share/doppel/presets/preset.schema.json");
    fs::copy_file(DOPPEL_PROGRAM, folder / "usr/bin/doppel");
    const auto installed = wait_for(start_program((folder / "usr/bin/doppel").c_str(), {"show", "butterfly"}));
    EXPECT_EQ(installed, 0);
    EXPECT_EQ(bytes_of(folder / "stdout"),
              "#:schema file://" + (folder / "usr/share/doppel/presets/preset.schema.json").string() + "\n" + rest);
}

TEST_F(Schema, LineThatIsWrongIsToldInOneLine) {
    const auto note = [&](const std::string& line) {
        write_bytes(folder / "mine.toml", "# mine\n" + line + "\n[system]\nintegrator = \"taylor\"\n");
        const auto result = done("check mine.toml --set scene.duration_s=0.1 --set 'video.size=[64, 64]'");
        const auto end = result.out.find("\n") + 1;
        return result.out.starts_with("mine.toml:") ? result.out.substr(0, end) : "";
    };
    const std::string remedy = "; \"doppel schema\" prints the one that editors want\n";
    EXPECT_EQ(note("#:schema ./none.json"),
              "mine.toml:2:1: #:schema names ./none.json, and there is no such file" + remedy);
    write_bytes(folder / "other.json", "{}");
    EXPECT_EQ(note("#:schema other.json"),
              "mine.toml:2:1: #:schema names other.json, which is not this program's schema" + remedy);
    EXPECT_EQ(note("#:schema https://example.org/x.json"), "");
    EXPECT_EQ(note("# no schema"), "");
    EXPECT_EQ(note("#:schema " + (source / "presets/preset.schema.json").string()), "");
    EXPECT_EQ(note("#:schema file://" + (source / "presets/preset.schema.json").string() + " "), "");
}

}  // namespace doppel::schema_test
