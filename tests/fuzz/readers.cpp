// libFuzzer's programs for Doppel's readers, with AddressSanitizer and UndefinedBehaviorSanitizer (clang):
//
//     cmake --preset fuzz && cmake --build --preset fuzz
//     mkdir -p build/fuzz/found
//     build/fuzz/tests/fuzz_presets -dict=tests/fuzz/toml.dict -max_len=4096 -timeout=2 -runs=100000
//         build/fuzz/found tests/fuzz/corpus presets
//
// The others are fuzz_sets (tests/fuzz/sets), fuzz_parts (tests/fuzz/parts), fuzz_pictures (tests/fuzz/pictures) and
// fuzz_fonts (fonts, with -max_len=100000), each with its own folder for results. Inputs that increase the coverage go
// to the first folder. An input that crashes is written to crash-*; after the correction, move it into the folder in
// tests/fuzz, which the test suite reads in every build.
#include "fuzz/reading.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    doppel::test::DOPPEL_FUZZ_READ({reinterpret_cast<const char*>(data), size});  // an exception is a crash
    return 0;
}
