#include "image/color.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace color_test {

TEST(ParseColor, ReadsSixHexadecimalDigits) {
    EXPECT_EQ(parse_color("#000000"), rgb(0));
    EXPECT_EQ(parse_color("#ffA640"), rgb(0xffa640));
    EXPECT_EQ(parse_color("#ffffff"), (Color{1, 1, 1, 1}));
}

TEST(ParseColor, RefusesEverythingElse) {
    for (const char* text : {"", "#", "ffa640", "#fff", "#ffa64", "#ffa6400", "#ffa64g", "#-ffa64", "#+12345",
                             "# 12345", "#0x1234", " #ffa640", "orange"}) {
        EXPECT_EQ(parse_color(text), std::nullopt) << text;
    }
}

}  // namespace color_test
}  // namespace doppel
