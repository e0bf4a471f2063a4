#include "cli/process.hpp"
#include "output/png.hpp"

namespace doppel::still_program_test {

namespace fs = std::filesystem;
using namespace test;
using Still = ProgramTest;

TEST_F(Still, IsDrawnAloneAndRefusedInOneLine) {
    const auto result = done("still calm --at 0.5 --size 64x64 -o pictures");
    EXPECT_EQ(listing(folder / "pictures"), (Names{"calm", "calm/calm.0.5s.png"}));
    EXPECT_TRUE(has(result.out, "pictures/calm/calm.0.5s.png"));
    for (const auto& [arguments, message] : std::vector<std::pair<Words, std::string>>{
             {"still calm", "--at is required"},
             {"still calm --at soon", "--at must be seconds ≥ 0, such as 6.8 or 1/3; it is \"soon\""},
             {"still calm --at 31", "--at 31: calm ends at 30 s"},
             {"still calm --at 30.0000001", "--at 30.0000001: calm ends at 30 s"},
             {"render calm --to 30.00000001", "--to 30.00000001: calm ends at 30 s"},
             {"still calm --at 1 --set video.format=\"gif\"", "and --format of still, which draws PNG"},
             {"render measured --to 99", "--to 99: measured ends at 2.65 s"},
             {"render calm --from -1", "--from must be seconds ≥ 0"},
             {"render calm --from 1 --frames 0:3", "--frames counts frames, --from and --to seconds; give one"},
             {"render calm --from 3 --to 2",
              "--from 3 --to 2: the end, which is not included, must be after the start"}})
        expect_refused(arguments, 2, message);
    EXPECT_FALSE(fs::exists(folder / "out"));
}

/// Keys of the preset's own format do not apply to the picture.
TEST_F(Still, IsDrawnOfAFilmOfAnyFormat) {
    for (const char* keys : {"format = \"webm\"\ncodec = \"av1\"\ncrf = 60", "format = \"html\"\nposition_bits = 20"}) {
        write_bytes(folder / "x.toml", std::string("[scene]\nduration_s = 1\n[video]\nsize = [64, 64]\n") + keys);
        done("still x.toml --at 0");
        done("compare --render x.toml --at 0 out/x");
    }
}

TEST_F(Still, ADraftHasAQuarterOfThePixels) {
    done("render calm --quality draft --format png --frames 0:1");
    EXPECT_EQ(read_png(folder / "out/calm/frames/000000.png").size, (Size{960, 540}));
}

}  // namespace doppel::still_program_test
