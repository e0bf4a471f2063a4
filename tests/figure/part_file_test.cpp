#include "figure/computation.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <random>

namespace doppel::part_file_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::expect_error;
using test::fresh_folder;
using test::write_bytes;

constexpr double infinite = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();

PartHeader some_header(std::size_t trials) {
    return {"some", "0.1.0", "abc", "cafe", trials, 1, 1};
}

void expect_same_bits(const TrialNumbers& a, const TrialNumbers& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_TRUE(std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]) ||
                    (std::isnan(a[i]) && std::isnan(b[i])))
            << a[i] << " and " << b[i];
}

/// The trials of a file by their index.
KnownTrials trials_in(const fs::path& path) {
    const auto part = read_part_file(path);
    KnownTrials trials(part.header.trials);
    for (const auto& trial : part.trials) trials.at(trial.number) = trial.numbers;
    return trials;
}

/// Trials with numbers of all sizes, and with no numbers.
KnownTrials some_trials() {
    using Limits = std::numeric_limits<double>;
    KnownTrials trials{{0.0, -0.0, none, infinite, -infinite, -none},
                       {Limits::min(), Limits::max(), -Limits::max(), Limits::denorm_min(), -Limits::denorm_min()},
                       {0.1, 1.0 / 3, 1e22, 1e23, 9007199254740993.0, 5e-324, 123456789012345680.0}};
    std::mt19937_64 random(1);
    for (int i = 0; i < 20; ++i) {
        auto& numbers = trials.emplace_back();
        while (numbers.size() < 50)
            if (const auto x = std::bit_cast<double>(random()); !std::isnan(x)) numbers.push_back(x);
    }
    return trials;
}

TEST(PartFile, KeepsEveryNumberToTheBit) {
    const auto path = fresh_folder() / "some.resume";
    const auto trials = some_trials();
    const PartHeader header{"some \"figure\"", "0.1.0", "abc-dirty", "cafe", trials.size(), 2, 3};
    PartWriter writer(path, header, {});
    for (std::size_t i = trials.size(); i-- > 0;) writer.add(i, trials[i]);  // in reverse order
    writer.finish();
    EXPECT_EQ(read_part_file(path).header, header);
    EXPECT_FALSE(read_part_file(path).is_damaged);
    const auto read = trials_in(path);
    ASSERT_EQ(read.size(), trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) expect_same_bits(read[i], trials[i]);
}

TEST(PartFile, BeginsWithWhatIsKnownAndReplacesAnOlderOne) {
    const auto path = fresh_folder() / "some.resume";
    write_bytes(path, "something older");
    PartWriter writer(path, some_header(3), {{1.5}, {}, {2.5, none}});
    const auto read = trials_in(path);  // before the file is closed
    expect_same_bits(read[0], {1.5});
    EXPECT_TRUE(read[1].empty());
    expect_same_bits(read[2], {2.5, none});
    writer.add(1, {7});
    writer.flush();
    expect_same_bits(trials_in(path)[1], {7});
}

/// A block with its checksum, of the bytes of trial, size and numbers.
std::string block_of(std::string_view bytes) {
    std::string block(16, '\0');
    const std::uint64_t size = bytes.size(), sum = libdeflate_crc32(0, bytes.data(), bytes.size());
    std::memcpy(block.data(), &size, 8);
    std::memcpy(block.data() + 8, &sum, 8);
    return block.append(bytes);
}

TEST(PartFile, StopsAtAnInvalidBlock) {
    const auto path = fresh_folder() / "some.resume";
    PartWriter(path, some_header(9), {{1}, {2}}).finish();
    const auto whole = bytes_of(path), good = whole.substr(0, whole.size() - 16);  // without the end
    const auto blocks = good.substr(good.find('\n') + 1), third = std::string(1, 2) + blocks.substr(17, 23);
    const auto longer = third.substr(0, 8) + "\x02" + third.substr(9),
               endless = third.substr(0, 8) + std::string(8, '\xff');
    for (const auto& damaged : {std::string("x"), third, block_of("x"), block_of(third.substr(0, 23)), block_of(longer),
                                block_of(endless), blocks.substr(0, 16) + third}) {
        write_bytes(path, good + damaged + blocks);
        const auto read = trials_in(path);
        EXPECT_TRUE(read_part_file(path).is_damaged) << damaged;
        expect_same_bits(read[0], {1});
        expect_same_bits(read[1], {2});
        for (std::size_t i = 2; i < read.size(); ++i) EXPECT_TRUE(read[i].empty()) << damaged;
    }
    write_bytes(path, good + block_of(third));
    EXPECT_FALSE(read_part_file(path).is_damaged);
    expect_same_bits(trials_in(path)[2], {1});
}

/// Of other bytes: Computation.ResumesFromARecordTruncatedOrDamagedAtAnyByte.
TEST(PartFile, WithAChangedHeaderIsOfAnotherRunOrRefused) {
    const auto path = fresh_folder() / "some.resume";
    PartWriter(path, some_header(3), {{1.25, -2e-300}}).finish();
    const auto bytes = bytes_of(path);
    for (std::size_t at = 0; at <= bytes.find('\n'); ++at)
        for (const int change : {1, 2, 4, 8, 0x20, 0x80}) {
            auto changed = bytes;
            changed[at] = static_cast<char>(changed[at] ^ change);
            write_bytes(path, changed);
            try {
                EXPECT_FALSE(read_part_file(path).header == some_header(3)) << at;
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ExitCode::io_failed);
            }
        }
}

/// Editors and file systems change line ends.
TEST(PartFile, RejectsOtherLineEnds) {
    const auto path = fresh_folder() / "some.resume";
    PartWriter(path, some_header(2), {{1}, {2}}).finish();
    auto bytes = bytes_of(path);
    bytes.insert(bytes.find('\n'), "\r");
    write_bytes(path, bytes);
    EXPECT_EQ(trials_in(path).size(), 2u);  // space in JSON
    bytes = bytes_of(path);
    bytes.insert(bytes.find('\n') + 1, "\r");
    write_bytes(path, bytes);
    EXPECT_TRUE(read_part_file(path).is_damaged);
}

TEST(PartFile, ReadsRegularFilesAlone) {
    const auto folder = fresh_folder();
    PartWriter(folder / "whole", some_header(1), {{1}}).finish();
    fs::create_symlink(folder / "whole", folder / "link");
    fs::create_symlink("/dev/zero", folder / "endless");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    fs::create_directory(folder / "folder");
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    fmt::format_to_n(address.sun_path, sizeof address.sun_path - 1, "{}", (fs::relative(folder) / "socket").string());
    const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0) << address.sun_path;
    for (const auto& [name, why] : {std::pair("link", "is a symbolic link"),
                                    {"endless", "is a symbolic link"},
                                    {"pipe", "is not a regular file"},
                                    {"folder", "is not a regular file"},
                                    {"socket", "cannot be read"}})
        expect_error(ExitCode::io_failed, {(folder / name).string(), why}, [&] { read_part_file(folder / name); });
    close(listener);
}

TEST(PartFile, ReadsNoEndlessHeader) {
    const auto path = fresh_folder() / "some.resume";
    write_bytes(path, "");
    fs::resize_file(path, std::uintmax_t{1} << 40);  // a sparse file: no blocks on the disk
    expect_error(ExitCode::io_failed, {path.string(), "is no file of trials"}, [&] { read_part_file(path); });
}

/// A header's JSON with one key changed, or left out.
std::string with_key(const std::string& key, const Json& value) {
    Json header{{"file", "doppel trials"},
                {"format", 3},
                {"figure", "some"},
                {"version", "0.1.0"},
                {"revision", "abc"},
                {"preset_sha256", "cafe"},
                {"trials", 3},
                {"shard", 1},
                {"of", 1}};
    header[key] = value;
    if (value.is_null()) header.erase(key);
    return header.dump() + "\n";
}

TEST(PartFile, RefusesWhatIsSomethingElse) {
    const auto path = fresh_folder() / "some.resume";
    write_bytes(path, with_key("trials", 3));
    EXPECT_EQ(read_part_file(path).header, some_header(3));
    std::vector<std::string> others{"", "\n", "sample,time_s\r\n0,0\r\n", "[]\n", "3\n", "null\n", "{}\n"};
    others.insert(others.end(), {"{\"file\":\"a table\"}\n", "\x89PNG\r\n\x1a\n"});
    for (const auto* key : {"file", "figure", "format", "preset_sha256", "trials"})
        others.push_back(with_key(key, nullptr));
    const std::initializer_list<std::pair<const char*, std::vector<Json>>> changed{
        {"file", {"doppel film shard"}},
        {"figure", {3}},
        {"format", {"3", 2}},
        {"of", {0, -2, 4294967297, 100001}},
        {"shard", {0, 2, -1, 1.5, true}},
        {"trials", {"many", Json::array(), -1, 0, 1e300, 1000000000000000}}};
    for (const auto& [key, values] : changed)
        for (const auto& value : values) others.push_back(with_key(key, value));
    for (const auto& other : others) {
        SCOPED_TRACE(other);
        write_bytes(path, other);
        expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
    }
    fs::remove(path);
    expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
    fs::create_directory(path);
    expect_error(ExitCode::io_failed, {path.string()}, [&] { read_part_file(path); });
}

TEST(PartFile, ReportsWhereItCannotBeWritten) {
    const auto folder = fresh_folder();
    expect_error(ExitCode::io_failed, {(folder / "none/some").string()},
                 [&] { PartWriter(folder / "none/some", some_header(1), {}); });
    fs::create_directories(folder / "taken/inside");
    expect_error(ExitCode::io_failed, {(folder / "taken").string()},
                 [&] { PartWriter(folder / "taken", some_header(1), {}); });
    const test::FullDisk disk(1000);
    expect_error(ExitCode::io_failed, {(folder / "full").string()}, [&] {
        PartWriter writer(folder / "full", some_header(1), {});
        for (int i = 0; i < 10'000; ++i) writer.add(0, {0.1234567});
        writer.finish();
    });
}

TEST(PartHeader, PartsAreAllOfItAndDiffByATrialAtMost) {
    for (const std::size_t trials : {1u, 5u, 181u, 1000u})
        for (const int of : {1, 2, 3, 7, 181, 400}) {
            std::size_t next = 0, minimum = trials, maximum = 0;
            for (int i = 1; i <= of; ++i) {
                auto header = some_header(trials);
                header.shard = i;
                header.of = of;
                EXPECT_EQ(header.first(), next);
                minimum = std::min(minimum, header.last() - header.first());
                maximum = std::max(maximum, header.last() - header.first());
                next = header.last();
            }
            EXPECT_EQ(next, trials);
            EXPECT_LE(maximum - minimum, 1u);
        }
}

TEST(PartHeader, IsThatOfTheNumbersAlone) {
    const auto figure = figure_of("fig2-right"),
               drawn = figure_of("fig2-right", {"chart.theme=\"dark\"", "title=\"x\""}),
               other = figure_of("fig2-right", {"grid.difference=0.004"});
    EXPECT_EQ(header_of(figure), header_of(drawn));
    EXPECT_NE(header_of(figure).preset, header_of(other).preset);
    EXPECT_NE(header_of(figure, {1, 2}), header_of(figure));
}

}  // namespace doppel::part_file_test
