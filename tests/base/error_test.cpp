#include "base/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace doppel::error_test {

TEST(Error, IsOneLineWhateverItQuotes) {
    const std::string quoted("a\0b\nc", 5);
    EXPECT_STREQ(bad_input("there is no \"{}\"", quoted).what(), "there is no \"a b c\"");
    EXPECT_STREQ(Error(ExitCode::io_failed, quoted).what(), "a b c");
}

}  // namespace doppel::error_test
