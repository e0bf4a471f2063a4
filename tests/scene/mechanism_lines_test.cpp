#include "physics/mechanisms.hpp"
#include "scene/scene.hpp"

#include <gtest/gtest.h>

namespace doppel::mechanism_lines_test {

using namespace counted;

TEST(MechanismLines, SayWhatToDraw) {
    using Kind = MechanismLine::Kind;
    auto parts = four_bars();
    parts.constraints.push_back(SlotLine<double>{two, P(0, 1), P(2, 0)});
    parts.constraints.push_back(SlotCircle<double>{two, P(3, 1), 2});
    parts.forces.push_back(Spring<double>{two, P(0, 2), 5, 0.5});
    const auto lines = lines_of(parts);
    ASSERT_EQ(lines.size(), 8u);
    EXPECT_EQ(lines[0].kind, Kind::anchor);
    EXPECT_EQ(lines[1].kind, Kind::rod);
    EXPECT_EQ(std::get<std::size_t>(lines[1].from), two);
    EXPECT_EQ(std::get<std::size_t>(lines[1].to), one);
    EXPECT_EQ(lines[5].kind, Kind::slot_line);
    EXPECT_EQ(std::get<P>(lines[5].to), P(2, 1));
    EXPECT_EQ(lines[6].kind, Kind::slot_circle);
    EXPECT_EQ(lines[6].radius, 2);
    EXPECT_EQ(lines[7].kind, Kind::spring);
    EXPECT_EQ(std::get<P>(lines[7].to), P(0, 2));
}

}  // namespace doppel::mechanism_lines_test
