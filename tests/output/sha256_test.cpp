#include "output/fixtures.hpp"
#include "output/written.hpp"

namespace doppel::sha256_test {

using namespace test;

// FIPS 180-4's examples, as NIST publishes them
TEST(Sha256, KnownVectors) {
    const auto path = fresh_folder() / "x";
    const auto of = [&](const std::string& bytes) {
        write_bytes(path, bytes);
        return sha256_of_file(path);
    };
    EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(of(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, ErrorsNameThePath) {
    const auto folder = fresh_folder();
    expect_io_failed({"none", "No such file"}, [&] { sha256_of_file(folder / "none"); });
    expect_io_failed({folder.string(), "is not a regular file"}, [&] { sha256_of_file(folder); });
}

}  // namespace doppel::sha256_test
