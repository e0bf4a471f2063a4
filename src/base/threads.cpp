#include "base/threads.hpp"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>

namespace doppel {
namespace {

/// Whether the address space has room for the stack of another thread.
bool has_room_for_a_stack() {
    pthread_attr_t usual;
    std::size_t bytes = std::size_t{8} << 20;
    if (pthread_attr_init(&usual) == 0) {
        pthread_attr_getstacksize(&usual, &bytes);
        pthread_attr_destroy(&usual);
    }
    void* const room = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
    return room != MAP_FAILED && munmap(room, bytes) == 0;
}

bool is_limited(decltype(RLIMIT_AS) what) {
    rlimit limit{};
    return getrlimit(what, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace

Error no_thread() {
    constexpr const char* none = "the system allows this process no more threads";
    const bool space = is_limited(RLIMIT_AS), data = is_limited(RLIMIT_DATA);
    if ((space || data) && !has_room_for_a_stack())
        return io_failed("{}: there is no memory for its stack; raise the limit of its memory ({})", none,
                         space && data ? "ulimit -v and ulimit -d"
                         : space       ? "ulimit -v"
                                       : "ulimit -d");
    return io_failed("{}; raise its limit (ulimit -u, or pids.max of its control group) or end other programs", none);
}

}  // namespace doppel
