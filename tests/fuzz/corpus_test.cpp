// The inputs that libFuzzer found, and seeded mutations of every preset and some files, through all readers.
#include "base/machine.hpp"
#include "figure/preset.hpp"
#include "fuzz/mutation.hpp"
#include "fuzz/reading.hpp"
#include "output/fixtures.hpp"
#include "render/font_files.hpp"

#include <algorithm>

namespace doppel {

void PrintTo(const PresetText& preset, std::ostream* out) {
    *out << preset.path;
}

namespace {

namespace fs = std::filesystem;

// s of CPU time allowed for one input; 18 000 settings of an axis take 0.05 s, with sanitizers 1.2 s
#ifdef DOPPEL_SANITIZE
constexpr double patience = 5;
#else
constexpr double patience = 1;
#endif

using Reader = std::string (*)(std::string_view);

/// The message of the error; the test fails if the reader crashes, violates its contract or takes too long.
std::string read_watched(const std::string& input, const std::string& name, Reader read = test::read_input) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    std::string message;
    try {
        message = read(input);
    } catch (const std::exception& error) {
        ADD_FAILURE() << name << ": " << error.what() << "\n--- input:\n" << input;
    }
    EXPECT_LT(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start, patience) << name << "\n--- input:\n" << input;
    return message;
}

TEST(Readers, ReadOrRefuseTheCorpus) {
    int inputs = 0;
    for (const auto& file : fs::directory_iterator(fs::path(DOPPEL_SOURCE_DIR) / "tests/fuzz/corpus")) {
        read_watched(test::bytes_of(file.path()), file.path().filename().string());
        ++inputs;
    }
    EXPECT_GE(inputs, 15);
}

/// A reader of files, and the folder with its seeds.
struct Files {
    const char* folder;
    Reader read;
    int mutations;  // of each seed
};

void PrintTo(const Files& files, std::ostream* out) {
    *out << files.folder;
}

class ReadersOfFiles : public testing::TestWithParam<Files> {};

TEST_P(ReadersOfFiles, ReadOrRefuseTheCorpusAndItsMutations) {
    const auto& [folder, read, mutations] = GetParam();
    std::mt19937 random(2026);
    read_watched("", "empty", read);
    std::vector<fs::path> seeds;
    for (const auto& file : fs::directory_iterator(fs::path(DOPPEL_SOURCE_DIR) / "tests/fuzz" / folder))
        seeds.push_back(file.path());
    std::sort(seeds.begin(), seeds.end());
    EXPECT_GE(seeds.size(), 3u);
    int accepted = 0, refused = 0;
    for (const auto& seed : seeds) {
        const auto bytes = test::bytes_of(seed);
        accepted += read_watched(bytes, seed.filename().string(), read).empty();
        for (int i = 0; i < mutations && !HasFailure(); ++i)
            refused +=
                !read_watched(test::damaged(bytes, random), fmt::format("{} {}", seed.string(), i), read).empty();
    }
    EXPECT_GE(accepted, 2);
    EXPECT_GT(refused, mutations / 10);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ReadersOfFiles,
                         testing::Values(Files{"sets", test::read_sets, 300}, Files{"parts", test::read_part, 60},
                                         Files{"pictures", test::read_picture, 1000}),
                         [](const auto& files) { return std::string(files.param.folder); });

/// Changes 1 to 4 bytes of a table of the font, or of its directory if `table` equals its number of tables.
std::string with_damaged_table(std::string font, std::size_t table, std::mt19937& random) {
    const auto tables = test::number_at(font, 4, 2), entry = 12 + 16 * table;
    const auto start = table < tables ? test::number_at(font, entry + 8) : 0;
    const auto length = table < tables ? test::number_at(font, entry + 12) : entry;
    constexpr std::size_t head = 512;  // the description at the start of a table
    for (auto changes = 1 + random() % 4; changes > 0; --changes)
        font[start + random() % std::min(length, head)] = static_cast<char>(random() % 256);
    return font;
}

TEST(Fonts, DamagedFontsDoNotCrash) {
    const auto font = test::embedded_font();
    EXPECT_EQ(read_watched(font, "whole", test::read_font), "");
    const auto tables = test::number_at(font, 4, 2);
    std::mt19937 random(2026);
    int accepted = 0;
    for (std::size_t i = 0; i < 250 && !HasFailure(); ++i) {
        const auto table = i % (tables + 1);
        const auto damaged = with_damaged_table(font, table, random);
        accepted += read_watched(damaged, fmt::format("{}, table {}", i, table), test::read_font).empty();
    }
    EXPECT_GT(accepted, 125);  // measured 0
}

class Mutations : public testing::TestWithParam<PresetText> {};

TEST_P(Mutations, AreReadOrRefusedWithAPlace) {
    constexpr int mutations = 500;  // the fuzz build tries more
    std::vector<std::string> texts;
    for (const auto& preset : builtin_presets()) texts.push_back(preset.text);
    const auto tokens = test::tokens_of(texts);
    std::mt19937 random(2026);
    EXPECT_EQ(read_watched(GetParam().text, "unchanged"), "");
    int refused = 0;
    for (int i = 0; i < mutations && !HasFailure(); ++i)
        refused += !read_watched(test::mutated(GetParam().text, tokens, random), fmt::format("mutation {}", i)).empty();
    // neither all nor none, otherwise the mutations would test little
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
