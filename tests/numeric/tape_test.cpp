#include "numeric/tape.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace doppel {
namespace tape_test {

TEST(Taped, OfBytesThatAreAllZeroIsTheConstantZero) {
    // Eigen 5 sets vectors to zero by memset
    Tape<double> tape(1);
    const auto first = Taped<double>::argument(5, tape), x = Taped<double>::argument(3, tape);
    Taped<double> zero(7);
    std::memset(static_cast<void*>(&zero), 0, sizeof zero);
    EXPECT_EQ(zero.node(), Taped<double>().node());
    zero += x;
    tape.finish();
    tape.term(first.node(), 0) = 5;
    tape.term(x.node(), 0) = 3;
    tape.compute(0);
    EXPECT_EQ(zero.value, 3);
    EXPECT_EQ(tape.term(zero.node(), 0), 3);  // 8 if `zero` counted as the first argument
}

}  // namespace tape_test
}  // namespace doppel
