#pragma once

#define GL_GLEXT_PROTOTYPES  // their types; no library is linked
#include <GL/glcorearb.h>

#include <functional>

/// The functions of OpenGL that Doppel calls, without their prefix "gl": X(name) each.
// clang-format off
#define DOPPEL_GL_FUNCTIONS(X) \
    X(ActiveTexture) X(AttachShader) X(BindAttribLocation) X(BindBuffer) X(BindFramebuffer) X(BindTexture) \
    X(BindVertexArray) X(BlendEquation) X(BlendFuncSeparate) X(BufferData) X(BufferSubData) \
    X(CheckFramebufferStatus) X(ClearColor) X(Clear) X(ColorMask) X(CompileShader) X(CreateProgram) X(CreateShader) \
    X(DeleteBuffers) X(DeleteFramebuffers) X(DeleteProgram) X(DeleteShader) X(DeleteTextures) X(DeleteVertexArrays) \
    X(DrawElementsBaseVertex) X(Enable) X(EnableVertexAttribArray) X(FramebufferTexture2D) X(GenBuffers) \
    X(GenFramebuffers) X(GenTextures) X(GenVertexArrays) X(GetError) X(GetIntegerv) X(GetProgramInfoLog) \
    X(GetProgramiv) X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetUniformLocation) X(LinkProgram) \
    X(PixelStorei) X(ReadPixels) X(ShaderSource) X(TexImage2D) X(TexParameteri) X(TexSubImage2D) X(Uniform2f) \
    X(UseProgram) X(VertexAttribPointer) X(Viewport)
// clang-format on

namespace doppel::gl {

using Function = void (*)();

/// The functions above as one library has them.
struct Functions {
#define X(name) decltype(&::gl##name) name = nullptr;
    DOPPEL_GL_FUNCTIONS(X)
#undef X
};

/// Those of the context that is current in this thread; null where none is.
extern constinit thread_local const Functions* current;

/// A function of the current context.
template <class Type, Type Functions::*function>
struct Call;
template <class Result, class... Arguments, Result (*Functions::*function)(Arguments...)>
struct Call<Result (*)(Arguments...), function> {
    Result operator()(Arguments... arguments) const { return (current->*function)(arguments...); }
};
#define X(name) inline constexpr Call<decltype(&::gl##name), &Functions::name> name;
DOPPEL_GL_FUNCTIONS(X)
#undef X

/// Asks `find` for each function. Throws Error where one is missing.
Functions load(const std::function<Function(const char* name)>& find);

}  // namespace doppel::gl
