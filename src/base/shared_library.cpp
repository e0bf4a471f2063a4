#include "base/shared_library.hpp"

#include "base/error.hpp"

#include <dlfcn.h>
#include <fmt/ranges.h>

namespace doppel {

SharedLibrary::SharedLibrary(const std::vector<std::string>& names) {
    std::string faults;
    for (const auto& name : names) {
        handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
        name_ = name;
        if (handle_) return;
        // the message about a library that exists but cannot be used is the more helpful one
        const std::string fault = dlerror();
        if (!fault.starts_with(name + ": cannot open shared object file: No such file"))
            faults += (faults.empty() ? "" : "; ") + fault;
    }
    throw io_failed("{}", faults.empty() ? fmt::format("there is no {}", fmt::join(names, " or ")) : faults);
}

SharedLibrary::Symbol SharedLibrary::operator[](const char* name) const {
    void* const found = dlsym(handle_, name);
    if (!found) throw io_failed("{} has no {}", name_, name);
    return {found};
}

}  // namespace doppel
