#include "base/shared_library.hpp"

#include "base/error.hpp"

#include <dlfcn.h>
#include <fmt/ranges.h>

namespace doppel {

SharedLibrary::SharedLibrary(const std::vector<std::string>& names) {
    std::string errors;
    for (const auto& name : names) {
        handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
        name_ = name;
        if (handle_) return;
        // the message about a library that exists but cannot be used is the more helpful one
        const std::string error = dlerror();
        if (!error.starts_with(name + ": cannot open shared object file: No such file"))
            errors += (errors.empty() ? "" : "; ") + error;
    }
    throw io_failed("{}", errors.empty() ? fmt::format("there is no {}", fmt::join(names, " or ")) : errors);
}

SharedLibrary::Symbol SharedLibrary::operator[](const char* name) const {
    void* const found = dlsym(handle_, name);
    if (!found) throw io_failed("{} has no {}", name_, name);
    return {found};
}

}  // namespace doppel
