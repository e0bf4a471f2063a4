#include "base/text.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace doppel::text_test {

std::vector<char32_t> characters(std::string_view text) {
    std::vector<char32_t> all;
    while (!text.empty()) all.push_back(next_character(text));
    return all;
}

TEST(Text, IsReadCharacterByCharacter) {
    EXPECT_EQ(characters("aé€😀"), (std::vector<char32_t>{'a', 0xe9, 0x20ac, 0x1f600}));
    // incomplete, overlong, half a surrogate pair, beyond Unicode: each byte is one character
    EXPECT_EQ(characters("\xc3"), (std::vector<char32_t>{0xfffd}));
    EXPECT_EQ(characters("\xc0\xaf"), (std::vector<char32_t>{0xfffd, 0xfffd}));
    EXPECT_EQ(characters("\xed\xa0\x80z"), (std::vector<char32_t>{0xfffd, 0xfffd, 0xfffd, 'z'}));
    EXPECT_EQ(characters("\xf4\x90\x80\x80").size(), 4u);
}

TEST(Text, IsUtf8OrNot) {
    EXPECT_TRUE(is_utf8(""));
    EXPECT_TRUE(is_utf8("90°, λ, 😀, \xef\xbf\xbd"));  // U+FFFD itself is well-formed
    for (const char* text : {"\xff", "a\x80", "\xc3", "\xed\xa0\x80", "\xc0\xaf"}) EXPECT_FALSE(is_utf8(text)) << text;
}

TEST(Text, OfADurationHasTwoDigits) {
    for (const auto& [seconds, text] : {std::pair(2.54, "2.5 s"), {99.4, "99 s"}, {99.6, "2 min"}, {36'000.0, "10 h"}})
        EXPECT_EQ(duration_text(seconds), text);
}

TEST(Text, OnOneLineIsSanitised) {
    EXPECT_EQ(on_one_line("plain, 90° · λ"), "plain, 90° · λ");
    EXPECT_EQ(on_one_line("a\nb\r\tc\x1b[31md\x7f"), "a b  c [31md ");
    EXPECT_EQ(on_one_line("\xc2\x9b"
                          "31m"),
              " 31m");  // the escape of C1
    EXPECT_EQ(on_one_line("a\xe2\x80\xae"
                          "b\xe2\x80\xa8"
                          "c"),
              "a b c");  // a switch to right-to-left; a line separator
    EXPECT_EQ(on_one_line("\x9b"
                          "1m"),
              "\xef\xbf\xbd"
              "1m");  // the same escape as a single byte
    EXPECT_EQ(on_one_line(std::string_view("\0", 1)), " ");
}

TEST(Text, SizesForPeople) {
    for (const auto& [bytes, text] : {std::pair(0.0, "0 bytes"),
                                      {999.0, "999 bytes"},
                                      {1000.0, "1 kB"},
                                      {2.5e5, "250 kB"},
                                      {1.5e6, "1.5 MB"},
                                      {2e9, "2.0 GB"},
                                      {17.6e12, "17.6 TB"}})
        EXPECT_EQ(bytes_text(bytes), text);
}

TEST(Text, ShortenedEndsWithAWholeCharacter) {
    EXPECT_EQ(shortened("90° ½", 7), "90° ½");  // the whole text
    EXPECT_EQ(shortened("90° ½", 6), "90° …");
    EXPECT_EQ(shortened("90° ½", 3), "90…");
    EXPECT_EQ(shortened("90° ½", 4), "90°…");
    EXPECT_EQ(shortened("½", 0), "…");
}

TEST(Text, TheNearestWordIsATypingErrorAwayOrBeginsSo) {
    const std::vector<std::string_view> keys{"mass_kg", "length_m", "gravity_m_per_s2", "rod_mass_kg",
                                             "fps",     "poster_s", "background_color"};
    for (const auto& [word, meant] : std::vector<std::pair<const char*, const char*>>{
             {"mas_kg", "mass_kg"},
             {"mass", "mass_kg"},
             {"gravity", "gravity_m_per_s2"},
             {"grvity", "gravity_m_per_s2"},
             {"fsp", "fps"},
             {"zzzzzz", ""},
             {"backgruond_colour", "background_color"},
             {"bakgrund_kolour", "background_color"},  // 4 of 15 letters differ
             {"bakgrnd_kollour", ""},                  // 6 letters differ
             {"ptr", ""},                              // no part of poster_s
             {"colour", ""}})
        EXPECT_EQ(nearest(word, keys).value_or(""), meant);
    EXPECT_FALSE(nearest("x", {}));
    const std::vector<std::string_view> sides{"a", "b"};
    EXPECT_FALSE(nearest("x", sides));  // no letter is right
}

}  // namespace doppel::text_test
