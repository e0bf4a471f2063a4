#pragma once

#include "image/golden.hpp"
#include "output/fixtures.hpp"
#include "output/png.hpp"

#include <cstdlib>
#include <cstring>

namespace doppel::test {

/// Fails if `actual` differs from tests/golden/NAME.png by the golden policy, and saves the files that show why. With
/// DOPPEL_UPDATE_GOLDENS=1 it becomes the golden picture (tests/update-goldens).
inline void expect_golden(const std::string& name, const Picture& actual) {
    const auto golden = std::filesystem::path(DOPPEL_SOURCE_DIR) / "tests/golden" / (name + ".png");
    if (const char* update = std::getenv("DOPPEL_UPDATE_GOLDENS"); update && std::strcmp(update, "1") == 0) {
        ASSERT_EQ(std::getenv("CI"), nullptr) << "goldens are made by a person who looks at them, not by CI";
        write_png(golden, actual);
        return;
    }
    const auto expected = read_png(golden);
    const auto verdict = compare_golden(expected, actual);
    if (verdict.passes) return;
    const auto folder = fresh_folder();
    write_png(folder / "expected.png", expected);
    write_png(folder / "actual.png", actual);
    write_png(folder / "difference.png", difference_picture(expected, actual));
    FAIL() << name << ": " << verdict.why << "\nexpected, actual and the difference ×16 are in " << folder;
}

}  // namespace doppel::test
