// Preloaded before a program (LD_PRELOAD), lets it start only as many threads as DOPPEL_TEST_THREADS says; then there
// are no more, as where pids.max or ulimit -u is reached (which holds back nobody who is root).

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) noexcept {
    static std::atomic<int> left = [] {
        const char* const count = std::getenv("DOPPEL_TEST_THREADS");
        return count ? std::atoi(count) : 0;
    }();
    static const auto create = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
    return left-- > 0 ? create(thread, attributes, start, argument) : EAGAIN;
}
