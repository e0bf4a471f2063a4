// Files of blocks with checksums.
#include "output/blocks.hpp"

#include "errors.hpp"
#include "output/fixtures.hpp"

namespace doppel::blocks_test {

using namespace test;

constexpr BlockKind kind{R"({"file":"a test")", "is something else", "is damaged"};

struct Numbers {
    long whole = 0;
    std::vector<std::vector<double>> real = {};
    std::string bytes = {};

    friend bool operator==(const Numbers&, const Numbers&) = default;
};

const std::vector<Numbers> some{{7, {{0.5, -1}, {}, {1e300}}, std::string("a\0b", 3)}, {-1, {}, ""}};

void write_some(const std::filesystem::path& path) {
    BlockFile file(path, std::string(kind.start) + "}");
    for (auto numbers : some) {
        file(numbers.whole, numbers.real, numbers.bytes);
        file.end_block();
    }
    file.finish();
}

std::vector<Numbers> read_all(const std::filesystem::path& path) {
    BlockFile file(path, kind);
    std::vector<Numbers> all;
    while (file.next()) {
        auto& numbers = all.emplace_back();
        file(numbers.whole, numbers.real, numbers.bytes);
    }
    return all;
}

TEST(BlockFile, GivesBackWhatWasWrittenOrReportsDamage) {
    const auto path = fresh_folder() / "file";
    write_some(path);
    EXPECT_EQ(read_all(path), some);
    const auto whole = bytes_of(path);
    const auto header = whole.find('\n') + 1;
    for (auto size = header; size < whole.size(); ++size) {
        write_bytes(path, whole.substr(0, size));
        expect_io_failed({path.string() + " is damaged"}, [&] { read_all(path); });
    }
    for (auto at = header; at < whole.size(); ++at)
        for (const int bit : {1, 128}) {
            auto changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ bit);
            write_bytes(path, changed);
            expect_io_failed({path.string() + " is damaged"}, [&] { read_all(path); });
        }
    write_bytes(path, "hello\n");
    expect_io_failed({path.string() + " is something else"}, [&] { read_all(path); });
}

TEST(BlockFile, GivesNoMoreThanABlockContains) {
    const auto path = fresh_folder() / "file";
    write_some(path);
    BlockFile file(path, kind);
    ASSERT_TRUE(file.next());
    Numbers numbers;
    file(numbers.whole, numbers.real, numbers.bytes);
    EXPECT_EQ(thrown_by([&] { file(numbers.whole); }), (Thrown{ExitCode::io_failed, path.string() + " is damaged"}));
    ASSERT_TRUE(file.next());
    std::vector<long> many;  // its size is that of another number
    EXPECT_EQ(thrown_by([&] { file(many); }).first, ExitCode::io_failed);
}

}  // namespace doppel::blocks_test
