// The script "doppel" of a checkout that cannot build.
#include "cli/process.hpp"

namespace doppel::checkout_test {

namespace fs = std::filesystem;
using namespace test;

/// A checkout that requires no packages of the system, not yet built.
fs::path checkout() {
    const auto top = fresh_folder();
    fs::copy_file(fs::path(DOPPEL_SOURCE_DIR) / "doppel", top / "doppel");
    for (const char* part : {"CMakeLists.txt", "CMakePresets.json", "debian-packages.txt"}) write_bytes(top / part, "");
    for (const char* part : {"cmake", "src", "shaders", "fonts", "presets", "templates", "packaging"})
        fs::create_directory(top / part);
    return top;
}

void expect_refused(const Outcome& result, const std::string& reason) {
    EXPECT_EQ(result.code, 4) << result.err;  // 1 means that pictures differ
    EXPECT_TRUE(one_line(result.err)) << result.err;
    EXPECT_TRUE(has(result.err, "/build/release cannot be written: " + reason + "; "));
}

TEST(Checkout, ThatCannotBeWrittenIsReportedInOneLine) {
    const auto top = checkout();
    write_bytes(top / "build", "");
    for (const char* line : {"./doppel compare a b", "./doppel list"})
        expect_refused(shell(std::string("unset DOPPEL_BUILD; ") + line), "Not a directory");
    fs::remove(top / "build");
    if (can_mount())
        expect_refused(shell_with_mounts("unset DOPPEL_BUILD; mount --bind . . && mount -o remount,ro,bind . && "
                                         "cd \"$PWD\" && ./doppel compare a b"),
                       "Read-only file system");
}

TEST(Checkout, ABuildThatFailsIsExit4) {
    checkout();
    const auto result = shell("unset DOPPEL_BUILD; ./doppel compare a b");
    EXPECT_EQ(result.code, 4) << result.err;
}

}  // namespace doppel::checkout_test
