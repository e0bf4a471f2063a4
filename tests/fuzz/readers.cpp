// libFuzzer's programs over what Doppel reads, with AddressSanitizer and UndefinedBehaviorSanitizer (clang):
//
//     cmake --preset fuzz && cmake --build --preset fuzz
//     mkdir -p build/fuzz/found
//     build/fuzz/tests/fuzz_presets -dict=tests/fuzz/toml.dict -max_len=4096 -timeout=2 -runs=100000
//         build/fuzz/found tests/fuzz/corpus presets
//
// and so fuzz_sets (tests/fuzz/sets), fuzz_parts (tests/fuzz/parts), fuzz_pictures (tests/fuzz/pictures) and fuzz_fonts
// (fonts, with -max_len=100000), each with a folder of its own for what it finds. What leads to new places goes to the first folder; an input that crashes is
// written to crash-*: once that is mended, it belongs into the folder in tests/fuzz, which the suite reads in every
// build.
#include "fuzz/reading.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    doppel::test::DOPPEL_FUZZ_READ({reinterpret_cast<const char*>(data), size});  // an exception is a crash
    return 0;
}
