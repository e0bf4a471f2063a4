#pragma once

#include "render/renderer.hpp"

#define GL_GLEXT_PROTOTYPES  // only for the types of functions; no library is linked
#include <GL/glcorearb.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The OpenGL functions that Doppel calls, without the prefix "gl": X(name) for each.
// clang-format off
#define DOPPEL_GL_FUNCTIONS(X) \
    X(AttachShader) X(BindAttribLocation) X(BindBuffer) X(BindFramebuffer) X(BindTexture) \
    X(BindVertexArray) X(BlendEquation) X(BlendFuncSeparate) X(BufferData) X(BufferSubData) \
    X(CheckFramebufferStatus) X(ClearColor) X(Clear) X(ColorMask) X(CompileShader) X(CreateProgram) X(CreateShader) \
    X(DeleteShader) X(DrawArrays) X(Enable) X(EnableVertexAttribArray) X(FramebufferTexture2D) X(GenBuffers) \
    X(GenFramebuffers) X(GenTextures) X(GenVertexArrays) X(GetError) X(GetIntegerv) \
    X(GetProgramiv) X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetUniformLocation) X(LinkProgram) \
    X(PixelStorei) X(ReadPixels) X(ShaderSource) X(TexImage2D) X(TexParameteri) X(TexSubImage2D) X(Uniform2f) \
    X(UseProgram) X(VertexAttribPointer) X(Viewport)
// clang-format on

namespace doppel::gl {

using Function = void (*)();

/// The functions above, loaded from one library.
struct Functions {
#define X(name) decltype(&::gl##name) name = nullptr;
    DOPPEL_GL_FUNCTIONS(X)
#undef X
};

/// The functions of this thread's current context; null if there is none.
extern constinit thread_local const Functions* current;

// Each calls the function of the current context.
#define X(name) inline constexpr auto name = [](const auto&... arguments) { return current->name(arguments...); };
DOPPEL_GL_FUNCTIONS(X)
#undef X

}  // namespace doppel::gl

namespace doppel {

/// An OpenGL 3.3 core context without a window. It must be used and destroyed in the thread that made it. Contexts of
/// different libraries may be used in one thread.
class Context {
public:
    /// A context of a library, and the library's functions for it.
    struct Functions {
        const char* library;  // "OSMesa" or "EGL"
        std::function<void()> bind, release, destroy;
        std::function<gl::Function(const char* name)> find;
    };
    explicit Context(Functions functions) : own_(std::move(functions)) {}
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes this context current in this thread; cheap if it already is. Throws Error on failure.
    void make_current();
    std::string library() const { return own_.library; }

private:
    void retire();

    Functions own_;
    std::optional<gl::Functions> opengl_;  // loaded when the context is first made current
};

/// Names under which the dynamic linker may find the libraries, in order.
struct GlLibraries {
    std::vector<std::string> osmesa{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    std::vector<std::string> egl{"libEGL.so.1", "libEGL.so"};
};

/// Makes a context current. Throws Error (exit 4): why each library failed, and which packages contain them.
std::unique_ptr<Context> make_context(Gl gl, const GlLibraries& libraries = {});

}  // namespace doppel
