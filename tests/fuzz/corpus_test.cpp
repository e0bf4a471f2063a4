// What libFuzzer found, and 2000 seeded mutations of every preset, through the readers of every build.
#include "figure/preset.hpp"
#include "fuzz/mutation.hpp"
#include "fuzz/reading.hpp"
#include "numeric/clock.hpp"
#include "output/fixtures.hpp"

#include <algorithm>

namespace doppel {

void PrintTo(const PresetText& preset, std::ostream* out) {
    *out << preset.path;
}

namespace {

namespace fs = std::filesystem;

constexpr double patience = 1;  // s of CPU time for one input

/// The refusal's message; a test failure where the readers crash, break their word or take too long.
std::string read_watched(const std::string& input, const std::string& name) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    std::string message;
    try {
        message = test::read_input(input);
    } catch (const std::exception& fault) {
        ADD_FAILURE() << name << ": " << fault.what() << "\n--- input:\n" << input;
    }
    EXPECT_LT(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start, patience) << name << "\n--- input:\n" << input;
    return message;
}

TEST(Readers, KeepTheirWordOnTheCorpus) {
    int inputs = 0;
    for (const auto& file : fs::directory_iterator(fs::path(DOPPEL_SOURCE_DIR) / "tests/fuzz/corpus")) {
        read_watched(test::bytes_of(file.path()), file.path().filename().string());
        ++inputs;
    }
    EXPECT_GE(inputs, 15);
}

class Mutations : public testing::TestWithParam<PresetText> {};

TEST_P(Mutations, AreReadOrRefusedWithAPlace) {
    constexpr int mutations = 2000;
    std::vector<std::string> texts;
    for (const auto& preset : builtin_presets()) texts.push_back(preset.text);
    const auto tokens = test::tokens_of(texts);
    std::mt19937 random(2026);
    EXPECT_EQ(read_watched(GetParam().text, "unchanged"), "");
    int refused = 0;
    for (int i = 0; i < mutations && !HasFailure(); ++i)
        refused += !read_watched(test::mutated(GetParam().text, tokens, random), fmt::format("mutation {}", i)).empty();
    // neither all nor none: else the mutations would test little
    EXPECT_GT(refused, mutations / 4);
    EXPECT_LT(refused, mutations * 49 / 50);
}

INSTANTIATE_TEST_SUITE_P(Presets, Mutations, testing::ValuesIn(builtin_presets()), [](const auto& preset) {
    auto name = preset.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace doppel
