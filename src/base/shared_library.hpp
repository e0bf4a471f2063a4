#pragma once

#include <string>
#include <vector>

namespace doppel {

/// A shared library found at run time. It stays for the rest of the process: Mesa cannot be unloaded safely.
class SharedLibrary {
public:
    /// The first of `names` that there is. Throws Error (exit 4), which says why none could be loaded.
    explicit SharedLibrary(const std::vector<std::string>& names);

    /// An address that converts to any type of function.
    struct Symbol {
        void* address;
        template <class Function>
        operator Function*() const {
            return reinterpret_cast<Function*>(address);
        }
    };
    /// Throws Error (exit 4) where there is no such function.
    Symbol operator[](const char* name) const;

private:
    std::string name_;
    void* handle_ = nullptr;
};

}  // namespace doppel
