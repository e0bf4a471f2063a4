#include "allocations.hpp"

#include <atomic>
#include <cstddef>

namespace {
std::atomic<long> count = 0;
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {
    ++count;
    return __libc_malloc(size);
}
#endif

long doppel::allocations() {
    return count;
}
