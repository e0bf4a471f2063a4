#include "output/fixtures.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel::manifest_test {

using namespace test;

TEST(Manifest, IsFinishedAsTheFilesThatItNames) {
    const auto folder = fresh_folder();
    {
        Transaction files(folder);
        write_bytes(files.file("x.mp4"), "video");
        files.finished("x.mp4");
        write_manifest(files, "x.json", {});
        expect_error(ExitCode::io_failed,
                     {(folder / ".doppel-run/x.mp4").string(), (folder / ".doppel-run/x.json").string()}, [&] {
                         files.keeping_finished(
                             []() -> std::vector<std::filesystem::path> { throw std::runtime_error("no room"); });
                     });
    }
    // sha256sum of "video"
    const auto manifest = Json::parse(bytes_of(folder / ".doppel-run/x.json"));
    EXPECT_EQ(
        manifest,
        Json::parse(
            R"({"files": {"x.mp4": {"bytes": 5, "sha256": "0cab1c9617404faf2b24e221e189ca5945813e14d3f766345b09ca13bbe28ffc"}}})"));
}

TEST(Manifest, KeepsMoreDigitsThanDouble) {
    const auto json = json_of_toml("a = [90.0000000000000000000000001, 90.0, 90, 1e-6]\nb = {c = \"x\", d = true}");
    EXPECT_EQ(json.dump(), R"({"a":["90.0000000000000000000000001",90.0,90,1e-06],"b":{"c":"x","d":true}})");
    const auto preset =
        preset_from("[system]\nprecision = \"quad\"\n[b]\nangle_deg = [90.0000000000000000000000001, 90]");
    const auto resolved = json_of_toml(resolved_toml(preset));
    EXPECT_EQ(resolved["a"]["angle_deg"][0], 90);
    EXPECT_EQ(resolved["b"]["angle_deg"][0], "90.0000000000000000000000001");
}

}  // namespace doppel::manifest_test
