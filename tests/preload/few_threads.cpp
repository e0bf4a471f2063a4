// Preloaded into a program (LD_PRELOAD), allows only DOPPEL_TEST_THREADS threads. Further threads fail to start, as at
// the limits of pids.max or ulimit -u (which does not apply to root).

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
