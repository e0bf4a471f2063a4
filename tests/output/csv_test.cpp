#include "output/csv.hpp"

#include "output/fixtures.hpp"

#include <bit>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>

namespace doppel::csv_test {

using namespace test;

TEST(Csv, BytesAreThoseOfRfc4180) {
    const auto path = fresh_folder() / "x.csv";
    Csv csv(path, {"sample", "time_s", "log_ratio"});
    csv.add(0L);
    csv.add(0.1);
    csv.add(std::nullopt);
    csv.end_row();
    csv.add(-3L);
    csv.add(1e22);
    csv.add(std::string_view("one, \"two\"\n"));
    csv.end_row();
    csv.finish();
    EXPECT_EQ(bytes_of(path), "sample,time_s,log_ratio\r\n0,0.1,\r\n-3,1e+22,\"one, \"\"two\"\"\n\"\r\n");
}

TEST(Csv, NumbersComeBackAsTheyWere) {
    using Limits = std::numeric_limits<double>;
    std::vector<double> numbers = {5e-324,
                                   0.1,
                                   1.0 / 3.0,
                                   -0.0,
                                   Limits::max(),
                                   Limits::min(),
                                   90.003,
                                   1e23,
                                   2.2250738585072011e-308,
                                   9007199254740993.0};
    std::mt19937_64 random(9);
    while (numbers.size() < 10'000)
        if (const auto x = std::bit_cast<double>(random()); std::isfinite(x)) numbers.push_back(x);

    const auto path = fresh_folder() / "x.csv";
    Csv csv(path, {"x"});
    for (const double x : numbers) {
        csv.add(x);
        csv.end_row();
    }
    csv.finish();
    std::istringstream lines(bytes_of(path));
    std::string line;
    std::getline(lines, line);
    for (const double x : numbers) {
        ASSERT_TRUE(std::getline(lines, line));
        // glibc's strtod rounds correctly, independently of our reader
        ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(line.c_str(), nullptr)), std::bit_cast<std::uint64_t>(x))
            << line;
        ASSERT_EQ(line.back(), '\r');
    }
}

TEST(Csv, RefusesNumbersThatAreNotFinite) {
    Csv csv(fresh_folder() / "x.csv", {"time_s", "energy_J"});
    csv.add(0.0);
    csv.add(1.0);
    csv.end_row();
    csv.add(0.5);
    expect_error(ExitCode::method_failed, {"x.csv", "energy_J of row 1", "nan"}, [&] { csv.add(std::nan("")); });
}

TEST(Csv, RowsHaveTheCellsOfTheHeader) {
    Csv csv(fresh_folder() / "x.csv", {"a", "b"});
    csv.add(1L);
    EXPECT_THROW(csv.end_row(), std::logic_error);
    csv.add(2L);
    EXPECT_THROW(csv.add(3L), std::logic_error);
}

TEST(Csv, AFullDiskIsAnErrorWithItsReason) {
    const std::filesystem::path full = "/dev/full", none = "/none/x.csv";
    expect_error(ExitCode::try_again, {"/dev/full", "No space left on device"}, [&] { Csv(full, {"x"}).finish(); });
    expect_error(ExitCode::try_again, {"/dev/full", "No space left on device"}, [&] {
        Csv csv(full, {"x"});
        for (long k = 0; k < 100'000; ++k) csv.add(k), csv.end_row();
    });
    expect_io_failed({"none/x.csv", "No such file"}, [&] { Csv(none, {"x"}); });
}

TEST(OutputFile, SaysAtOnceWhatAFlushCouldNotWrite) {
    OutputFile full(std::filesystem::path("/dev/full")), file(fresh_folder() / "x");
    full.write("x");
    expect_error(ExitCode::try_again, {"/dev/full", "No space left on device"}, [&] { full.flush(); });
    file.write("x");
    file.flush();
    EXPECT_EQ(test::bytes_of(file.path()), "x");
}

}  // namespace doppel::csv_test
