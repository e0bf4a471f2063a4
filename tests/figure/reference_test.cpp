// docs/presets.md says what the lists of keys say.
#include "figure/preset.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace doppel {
namespace reference_test {

constexpr const char* path = DOPPEL_SOURCE_DIR "/docs/presets.md";

TEST(Reference, OfPresetsIsThatOfTheLists) {
    if (std::getenv("DOPPEL_UPDATE_REFERENCE")) std::ofstream(path) << preset_reference();
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    EXPECT_EQ(text.str(), preset_reference()) << "tests/update-reference makes docs/presets.md anew";
}

}  // namespace reference_test
}  // namespace doppel
