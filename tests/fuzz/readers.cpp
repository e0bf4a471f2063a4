// libFuzzer's program over the preset readers, with AddressSanitizer and UndefinedBehaviorSanitizer (clang):
//
//     cmake --preset fuzz && cmake --build --preset fuzz
//     mkdir -p build/fuzz/found
//     build/fuzz/tests/fuzz_readers -dict=tests/fuzz/toml.dict -max_len=4096 -timeout=2 -runs=100000 \
//         build/fuzz/found tests/fuzz/corpus presets
//
// What leads to new places goes to build/fuzz/found; an input that crashes is written to crash-*: once that is mended,
// it belongs into tests/fuzz/corpus, which the suite reads in every build.
#include "fuzz/reading.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    doppel::test::read_input({reinterpret_cast<const char*>(data), size});  // an exception is a crash
    return 0;
}
