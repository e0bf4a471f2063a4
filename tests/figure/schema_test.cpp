// The schema of presets accepts what the reader accepts, and rejects what a schema can reject.
#include "figure/json_schema.hpp"
#include "figure/kinds.hpp"
#include "figure/preset_schema.hpp"
#include "figure/refused_figures.hpp"
#include "figure/support.hpp"
#include "fuzz/mutation.hpp"
#include "scene/refused_presets.hpp"
#include "scene/resolved.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace doppel::schema_test {

namespace fs = std::filesystem;

const test::JsonSchema& schema() {
    static const test::JsonSchema known(Json::parse(test::preset_schema()));
    return known;
}

/// Whether the schema accepts the text as TOML.
bool accepts(const std::string& text) {
    return schema().accepts(json_of_toml(text));
}

/// The reader's error; empty where it accepts the text.
std::string refusal_of(const std::string& text) {
    const PresetText preset{"x", "presets/x.toml", text, "x"};
    const auto [code, message] = error_of([&] {
        if (is_figure(preset))
            read_figure(preset);
        else
            read_preset(preset);
    });
    return code == ExitCode::done ? "" : message;
}

/// Whether the error concerns one key, whatever the others are: then a schema can also reject its value.
bool is_of_one_key(const std::string& message) {
    static const std::regex one_key(
        R"( has no "|must be (a |an |true|from |at most |> |≥ |"|written as|names of)|may hold|must hold at least|must have 2 colours| is missing; )"
        R"(|of 1 to \d+ numbers)");
    // errors that depend on more than the key: other values, the font, the length of a number
    static const std::regex of_more(
        R"(one a link|must be at most \d+ samples|as a frame of a GIF takes|must be at most [a-z_]+ = |\(-?9223372036854775\d+\)|at most 1000 and|from 1 to \d+, as|\[system\] gravity|mass_kg(\[\d+\])? must be > 0; it is -?0$|\[video\] crf must be from 0 to 51|must be "mechanism" or|\[links\] to must|°|must be that of|must be higher|or "one/other"|more digits|a fraction such as .*e-?[0-9]{2}|are both 0|whole number of samples|must be at most \d+ steps|must (not )?be (above|below)|must be another|must be 0 for|, as [a-z0-9_.\[\]]+ is;|for equal ratios|must keep|logarithmic scale|takes points|title is missing|and to as well)");
    return std::regex_search(message, one_key) && !std::regex_search(message, of_more);
}

/// A series of one motion has fewer keys of [system] than one of pairs; the schema of their kind does not state this.
bool is_of_motion(const std::string& text, const std::string& message) {
    if (message.find("[series] duration_s") != std::string::npos || message.find(" values:") != std::string::npos)
        return true;  // other keys decide its range; a value of a grid's axis belongs to another key
    return message.find(" has no ") != std::string::npos &&
           (text.find("\"exponents\"") != std::string::npos || text.find("\"errors\"") != std::string::npos);
}

TEST(Schema, IsThatOfTheLists) {
    const fs::path path = DOPPEL_SOURCE_DIR "/presets/preset.schema.json";
    if (std::getenv("DOPPEL_UPDATE_REFERENCE")) test::write_bytes(path, test::preset_schema());
    EXPECT_EQ(test::bytes_of(path), test::preset_schema()) << "tests/update-reference makes it anew";
}

TEST(Schema, AcceptsEveryPresetAsItIsAndResolved) {
    for (const auto& preset : builtin_presets()) {
        EXPECT_TRUE(accepts(preset.text)) << preset.path;
        const auto resolved = is_figure(preset) ? read_figure(preset).resolved() : resolved_toml(read_preset(preset));
        EXPECT_TRUE(accepts(resolved)) << preset.path << "\n" << resolved;
        EXPECT_TRUE(preset.text.starts_with(is_figure(preset) ? "#:schema ../preset.schema.json\n"
                                                              : "#:schema ./preset.schema.json\n"))
            << preset.path;
    }
}

TEST(Schema, RefusesWhatTheReaderRefusesOfOneKey) {
    std::vector<std::pair<std::string, std::string>> refused;  // texts and their messages
    for (const auto& preset : refused_presets) refused.emplace_back(preset.text, preset.message);
    for (const auto& preset : refused_video_keys)
        refused.emplace_back(std::string("[video]\n") + preset.text, preset.message);
    for (const auto& figure : refused_figures()) refused.emplace_back(figure.text, refusal_of(figure.text));
    int caught = 0;
    for (const auto& [text, message] : refused) {
        if (message.find("Error while parsing") != std::string::npos) continue;
        const bool is_refused = !accepts(text);
        caught += is_refused;
        EXPECT_TRUE(is_refused || !is_of_one_key(message) || is_of_motion(text, message)) << text << "\n" << message;
    }
    EXPECT_GE(caught, 89) << "of " << refused.size();
}

/// The schema accepts what the reader accepts, and rejects each value of one key that the reader rejects. Of 72 000
/// mutations, they differ in 41: numbers beyond double, and fractions beyond 64 bits.
TEST(Schema, AgreesWithTheReaderOnMutations) {
    constexpr int mutations = 30;  // of each preset
    std::vector<std::string> texts;
    for (const auto& preset : builtin_presets()) texts.push_back(preset.text);
    const auto tokens = test::tokens_of(texts);
    std::mt19937 random(2027);
    int read = 0, refused = 0;
    for (const auto& text : texts)
        for (int i = 0; i < mutations; ++i) {
            const auto mutated = test::mutated(text, tokens, random);
            std::string message;
            Json value;
            try {
                value = json_of_toml(mutated);
                message = refusal_of(mutated);
            } catch (const std::exception&) {
                continue;  // not TOML
            }
            ++(message.empty() ? read : refused);
            if (message.empty()) {
                EXPECT_TRUE(schema().accepts(value)) << mutated;
            } else if (is_of_one_key(message) && !is_of_motion(mutated, message)) {
                EXPECT_FALSE(schema().accepts(value)) << message << "\n" << mutated;
            }
        }
    EXPECT_GT(read, 100);
    EXPECT_GT(refused, 100);
}

TEST(Schema, KeepsKindsApart) {
    EXPECT_TRUE(accepts(""));
    EXPECT_TRUE(accepts("[scene]\nkind = \"series\""));
    EXPECT_FALSE(accepts("[links]"));
    EXPECT_FALSE(accepts("[scene]\nkind = \"series\"\n[video]"));
    EXPECT_FALSE(accepts("[scene]\nkind = \"series\"\n[grid]"));
    EXPECT_FALSE(accepts("[scene]\nkind = \"series\"\n[chart]\ncost = \"time\""));
    EXPECT_TRUE(accepts("[scene]\nkind = \"work-precision\"\n[chart]\ncost = \"time\""));
    EXPECT_FALSE(accepts("[scene]\nkind = \"work-precision\"\n[system]"));
}

}  // namespace doppel::schema_test
