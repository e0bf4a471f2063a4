#pragma once

#include <string>
#include <vector>

namespace doppel {

/// A shared library loaded at run time. It is never unloaded: Mesa cannot be unloaded safely.
class SharedLibrary {
public:
    /// Loads the first of `names` that works. Throws Error (exit 4) with the reasons if none can be loaded.
    explicit SharedLibrary(const std::vector<std::string>& names);

    /// An address that converts to any function pointer type.
    struct Symbol {
        void* address;
        template <class Function>
        operator Function*() const {
            return reinterpret_cast<Function*>(address);
        }
    };
    /// Throws Error (exit 4) if there is no such function.
    Symbol operator[](const char* name) const;

private:
    std::string name_;
    void* handle_ = nullptr;
};

}  // namespace doppel
