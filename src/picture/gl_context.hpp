#pragma once

#include <memory>

namespace doppel {

/// An OpenGL 3.3 core context without a window, to be used in the thread that made it.
class Context {
public:
    using Function = void (*)();

    virtual ~Context() = default;
    /// Makes OpenGL's calls of this thread go here; cheap where they already do. Throws Error where it fails.
    virtual void make_current() = 0;
    /// Null where there is no such function.
    virtual Function function(const char* name) const = 0;
};

/// A context that draws in software, with no need of a display. Throws Error where there is none to be had.
std::unique_ptr<Context> make_osmesa_context();

}  // namespace doppel
