// Replaces the C library's functions of these names, in this program only.
#include "output/system_calls.hpp"

#include "output/fixtures.hpp"

#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>

namespace {

doppel::test::CallWatch watch;

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Whether the call must fail; sets errno.
bool fails(const char* name) {
    if (!watch) return false;
    errno = watch(name);
    return errno != 0;
}

}  // namespace

void doppel::test::watch_calls(CallWatch wanted) {
    watch = std::move(wanted);
}

bool doppel::test::killed_before(int n, const std::function<void()>& action, const CallWatch& other) {
    const pid_t child = forked(fork());
    if (child == 0) {
        watch_calls([&, calls = 0](const std::string& call) mutable {
            if (++calls == n) raise(SIGKILL);
            return other ? other(call) : 0;
        });
        try {
            action();
        } catch (const Error&) {
            _exit(1);
        }
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
}

extern "C" {

int open(const char* name, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const auto mode = va_arg(rest, unsigned);
    va_end(rest);
    return fails("open") ? -1 : next<int(const char*, int, ...)>("open")(name, flags, mode);
}
int open64(const char* name, int flags, ...) {  // called by libraries
    va_list rest;
    va_start(rest, flags);
    const auto mode = va_arg(rest, unsigned);
    va_end(rest);
    return fails("open64") ? -1 : next<int(const char*, int, ...)>("open64")(name, flags, mode);
}
int mkdir(const char* name, mode_t mode) noexcept {
    return fails("mkdir") ? -1 : next<int(const char*, mode_t)>("mkdir")(name, mode);
}
int rmdir(const char* name) noexcept {
    return fails("rmdir") ? -1 : next<int(const char*)>("rmdir")(name);
}
int unlink(const char* name) noexcept {
    return fails("unlink") ? -1 : next<int(const char*)>("unlink")(name);
}
int unlinkat(int folder, const char* name, int flags) noexcept {
    return fails("unlinkat") ? -1 : next<int(int, const char*, int)>("unlinkat")(folder, name, flags);
}
int remove(const char* name) noexcept {
    return fails("remove") ? -1 : next<int(const char*)>("remove")(name);
}
int rename(const char* old_name, const char* name) noexcept {
    return fails("rename") ? -1 : next<int(const char*, const char*)>("rename")(old_name, name);
}
int renameat2(int from, const char* old_name, int to, const char* name, unsigned flags) noexcept {
    if (fails("renameat2")) return -1;
    return next<int(int, const char*, int, const char*, unsigned)>("renameat2")(from, old_name, to, name, flags);
}
int ftruncate(int file, off_t size) noexcept {
    return fails("ftruncate") ? -1 : next<int(int, off_t)>("ftruncate")(file, size);
}
int flock(int file, int operation) noexcept {
    return fails("flock") ? -1 : next<int(int, int)>("flock")(file, operation);
}
int fsync(int file) {
    if (fails("fsync")) return -1;
    return watch ? 0 : next<int(int)>("fsync")(file);
}
int syncfs(int file) noexcept {
    if (fails("syncfs")) return -1;
    return watch ? 0 : next<int(int)>("syncfs")(file);
}
ssize_t write(int file, const void* bytes, size_t count) {
    return fails("write") ? -1 : next<ssize_t(int, const void*, size_t)>("write")(file, bytes, count);
}
}
