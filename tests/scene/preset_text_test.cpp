// The text of a preset before it is interpreted: its file, its name, its bytes.
#include "base/machine.hpp"
#include "output/fixtures.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

namespace doppel::preset_text_test {

namespace fs = std::filesystem;

using test::fresh_folder;
using test::write_bytes;

std::string refused(const std::string& text, const std::vector<std::string>& arguments = {}) {
    return refusal([&] { preset_from(text, arguments); });
}

std::string refused_file(const fs::path& path, const std::atomic<bool>* stop = nullptr) {
    return refusal([&] { find_preset(path.string(), stop); });
}

std::string repeated(const std::string& text, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
}

std::string utf8_of(char32_t c) {
    return fs::path(std::u32string(1, c)).string();
}

TEST(DrawnText, IsOfAtMostAThousandLetters) {
    const auto of = [](std::size_t letters) { return '"' + repeated("θ", letters) + '"'; };
    for (const std::string key : {"title", "subtitle"}) {
        EXPECT_NO_THROW(preset_from(key + " = " + of(1000))) << key;
        EXPECT_EQ(refused(key + " = " + of(1001)),
                  "x.toml:1:1: " + key + " must have at most 1000 letters; it has 1001");
    }
    for (const std::string key : {"label", "note"})
        EXPECT_EQ(refused("[b]\n" + key + " = " + of(1001)),
                  "x.toml:2:1: [b] " + key + " must have at most 1000 letters; it has 1001");
    EXPECT_EQ(refused("[[system.particle]]\nname = " + of(10'000)),
              "x.toml:2:1: [[system.particle]] 1 name must have at most 1000 letters; it has 10000");
}

TEST(PresetText, EveryCharacterComesBackFromTheResolvedPreset) {
    // in blocks, and each control character separately
    std::vector<std::string> texts;
    for (char32_t c = 0; c < 0xa0; ++c) texts.push_back("a" + utf8_of(c) + "b");
    for (char32_t c = 0; c <= 0x10ffff; ++c) {
        if (c % 0x1000 == 0) texts.emplace_back();
        if (c < 0xd800 || c > 0xdfff) texts.back() += utf8_of(c);
    }
    for (const auto& text : texts) {
        const auto json = json_of_toml("title = " + toml_text(text));
        ASSERT_EQ(json["title"].get<std::string>(), text);
    }
}

TEST(PresetText, ANameThatWouldLeadElsewhereIsRefused) {
    const auto folder = fresh_folder();
    const std::vector<std::pair<std::string, std::string>> cases{
        {"..", "leads out of it"},
        {".", "leads out of it"},
        {"a\nb", "contains the control character U+000A"},
        {"a\x7f", "contains the control character U+007F"},
        {"a\xc2\x9b", "contains the control character U+009B"},
        {"a\xe2\x80\xae", "contains the control character U+202E"},
        {"a\xff", "is not UTF-8"},
        {std::string(longest_preset_name + 1, 'n'), "has 192 bytes; at most 191 are possible"}};
    for (const auto& [name, words] : cases) {
        const auto path = folder / (name + ".toml");
        write_bytes(path, "");
        EXPECT_TRUE(says(refused_file(path), words));
    }
    for (const auto& name : {std::string("..a"), std::string(".a"), std::string("90° λ"), std::string("a b"),
                             std::string(longest_preset_name, 'n')}) {
        write_bytes(folder / (name + ".toml"), "");
        EXPECT_EQ(find_preset((folder / (name + ".toml")).string()).name, name);
    }
}

TEST(PresetText, ComesFromAFileOrAPipeOfAFewMegabytes) {
    const auto folder = fresh_folder();
    EXPECT_EQ(refused_file("/dev/zero", &never), "/dev/zero is not a file; a preset is a TOML file");
    write_bytes(folder / "long.toml", std::string((std::size_t{8} << 20) + 1, '\n'));
    EXPECT_EQ(refused_file(folder / "long.toml"),
              (folder / "long.toml").string() + " has more than 8 MB; a preset is a TOML file");

    const auto pipe = folder / "pipe.toml";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(refused_file(pipe), pipe.string() + " is not a file; a preset is a TOML file");
    std::jthread writer([&] {
        std::ofstream out(pipe);
        out << "title = \"one\"\n" << std::flush;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        out << "# and more\n";
    });
    EXPECT_EQ(find_preset(pipe.string(), &never).text, "title = \"one\"\n# and more\n");
    writer.join();
    writer = std::jthread([&] {
        const int file = open(pipe.c_str(), O_WRONLY);
        const std::string portion(std::size_t{1} << 16, ' ');
        while (write(file, portion.data(), portion.size()) > 0) {
        }
        close(file);
    });
    signal(SIGPIPE, SIG_IGN);
    refused_file(pipe, &never);
}

TEST(PresetText, APipeThatNobodyWritesToEndsWhenAsked) {
    const auto pipe = fresh_folder() / "pipe.toml";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::atomic<bool> stop = false;
    const std::jthread ask([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        stop = true;
    });
    EXPECT_EQ(error_of([&] { find_preset(pipe.string(), &stop); }).first, ExitCode::interrupted);
}

TEST(PresetText, AByteOrderMarkIsNoColumn) {
    const auto preset = preset_from("\xEF\xBB\xBFsystem.angle_deg = [90.5, 45.25]\n");
    EXPECT_EQ(preset.a.angle_deg, (std::vector<Quad>{Quad(181) / 2, Quad(181) / 4}));
    EXPECT_EQ(refused("\xEF\xBB\xBFtitel = 1\n"), "x.toml:1:1: a preset has no \"titel\"; did you mean \"title\"?");
}

TEST(PresetText, NumbersAreFoundWhateverStandsBeforeThem) {
    for (const char* text :
         {"title = \"é€²\"\nsystem = {angle_deg = [90.5, 45.25]}\n", "system = {angle_deg = [90.5, 45.25]}\r\n",
          "# é\r\n\r\nsystem.angle_deg = [90.5,\r\n\t45.25]",
          "title = '''aé€''' # 😀\n\nsystem.\"angle_deg\" = [9_0.5, 4_5.25e0]"}) {
        EXPECT_EQ(preset_from(text).a.angle_deg, (std::vector<Quad>{Quad(181) / 2, Quad(181) / 4})) << text;
    }
}

TEST(PresetText, NumbersAreFoundSoonInALongText) {
    std::string lines = "system.links = 5000\nsystem.angle_deg = [1.5", one_line = lines;
    for (int i = 1; i < 5000; ++i) {
        lines += ",\n\n# 90° é\n1.5";
        one_line += ", 1.5000000000000000000000000000000000";
    }
    const std::string before(std::size_t{4} << 20, '\n');
    for (const auto& text : {before + lines + "]\n", one_line + "]\n"}) {
        const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        const auto preset = preset_from(text);
        EXPECT_LT(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start, 2);  // measured 0.1; minutes if counted again for each
        for (const auto& angle : preset.a.angle_deg) ASSERT_EQ(angle, Quad(3) / 2);
    }
}

TEST(PresetText, ADeepKeyIsRefusedBeforeItMakesTables) {
    constexpr std::size_t deep = 200'000;
    const std::string message = "a key can have at most 8 parts; this one has more";
    for (const auto& text :
         {repeated("a.", deep) + "a = 1", "[" + repeated("a.", deep) + "a]", "[[" + repeated("a.", deep) + "a]]",
          "x = {" + repeated("a . ", deep) + "a = 1}", repeated("\"=\".", deep) + "a = 1",
          repeated("'#'.", deep) + "a = 1", "x = [{\"y\" = \"\"\"\n\\\"\"\"\"\"\", " + repeated("1.", deep) + "1 = 1}]",
          "x = {y = '''\n'''''," + repeated("a.", deep) + "a = 1}",
          "x = \"\\\"\" # '\n" + repeated("a.", deep) + "a = 1\n!!!"})
        EXPECT_TRUE(says(refused(text), message)) << text.substr(0, 40) << "\n" << refused(text);
    EXPECT_EQ(refused("\n  a.b.c.d.e.f.g.h.i = 1"), "x.toml:2:18: " + message);
    EXPECT_TRUE(says(refused("", {"x={" + repeated("a.", deep) + "a = 1}"}), message));
    EXPECT_EQ(refusal([&] { parse_set(repeated("a.", deep) + "a=1"); }),
              "--set needs a key of at most 8 parts; this one has 200001");
}

TEST(PresetText, DotsThatAreNoKeyMayBeMany) {
    const auto decimals = "system.angle_deg = [" + repeated("1.5, ", 9) + "2.5]\nsystem.links = 10\n";
    EXPECT_EQ(preset_from(decimals).a.angle_deg.back(), Quad(5) / 2);
    EXPECT_EQ(preset_from("title = \"..........\" # ..........\n#..........").title, "..........");
    EXPECT_EQ(preset_from("title = '..........'").title, "..........");
    EXPECT_EQ(preset_from("title = \"\"\"\\\n..........\"\"\"").title, "..........");
}

TEST(PresetText, WhatIsDrawnHasLettersOfAFont) {
    // code points without a character: no font has them
    const std::string rest =
        ", which the built-in font lacks; it has Latin and Greek letters and signs of mathematics; no font of this "
        "system has them; give a font file in [video.fonts] text";
    const std::string lacks = "contains \"\xcd\xb8\" (U+0378)" + rest;
    EXPECT_EQ(refused("\ntitle = \"a \xcd\xb8\""), "x.toml:2:1: title " + lacks);
    EXPECT_EQ(refused("title = \"\xcd\xb8\xcd\xb9 \xcd\xb8\""),
              "x.toml:1:1: title contains \"\xcd\xb8\" (U+0378), \"\xcd\xb9\" (U+0379)" + rest);
    EXPECT_EQ(refused("title = \"مر\""),
              "x.toml:1:1: title contains \"م\" (U+0645) of a script that Doppel cannot draw (joined or right-to-left "
              "letters)");
    EXPECT_EQ(refused("title = \"a\\u007fb\""),
              "x.toml:1:1: title contains the control character U+007F, which cannot be drawn");
    EXPECT_EQ(refused("[[system.particle]]\nname = \"\xcd\xb8\""), "x.toml:2:1: [[system.particle]] 1 name " + lacks);
    const auto named = [](const std::string& text) {
        return read_preset({"\xcd\xb8", "x.toml", text, "x.toml"}).title;
    };
    EXPECT_EQ(refusal([&] { named(""); }), "x.toml: title is missing, and the preset's name " + lacks);
    EXPECT_EQ(named("title = \"two\""), "two");
    for (const auto* title : {"90°, λ = ½ · √2 – “Ω”", "", "Ελληνικά, Łódź, ∂²x/∂t² ≤ ∞"})
        EXPECT_EQ(preset_from(fmt::format("title = \"{}\"", title)).title, title);
}

}  // namespace doppel::preset_text_test
