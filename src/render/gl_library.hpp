#pragma once

#include "base/error.hpp"

#include <string>
#include <vector>

namespace doppel {

/// A shared library found at run time. It stays for the rest of the process: Mesa does not bear being unloaded.
class Library {
public:
    /// The first of `names` that there is. Throws Error (exit 4), which says why none could be loaded.
    explicit Library(const std::vector<std::string>& names);

    /// Sets `function` to the library's function `name`, whose type is the caller's word. Throws Error (exit 4) where
    /// there is none.
    template <class Function>
    void find(const char* name, Function*& function) const {
        function = reinterpret_cast<Function*>(address(name));
    }

private:
    void* address(const char* name) const;

    std::string name_;
    void* handle_ = nullptr;
};

}  // namespace doppel
