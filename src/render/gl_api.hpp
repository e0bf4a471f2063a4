#pragma once

#define GL_GLEXT_PROTOTYPES  // only for the types of functions; no library is linked
#include <GL/glcorearb.h>

/// The OpenGL functions that Doppel calls, without the prefix "gl": X(name) for each.
// clang-format off
#define DOPPEL_GL_FUNCTIONS(X) \
    X(AttachShader) X(BindAttribLocation) X(BindBuffer) X(BindFramebuffer) X(BindTexture) \
    X(BindVertexArray) X(BlendEquation) X(BlendFuncSeparate) X(BufferData) X(BufferSubData) \
    X(CheckFramebufferStatus) X(ClearColor) X(Clear) X(ColorMask) X(CompileShader) X(CreateProgram) X(CreateShader) \
    X(DeleteBuffers) X(DeleteFramebuffers) X(DeleteProgram) X(DeleteShader) X(DeleteTextures) X(DeleteVertexArrays) \
    X(DrawArrays) X(Enable) X(EnableVertexAttribArray) X(FramebufferTexture2D) X(GenBuffers) \
    X(GenFramebuffers) X(GenTextures) X(GenVertexArrays) X(GetError) X(GetIntegerv) X(GetProgramInfoLog) \
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

/// Calls one function of the current context.
template <class Type, Type Functions::*function>
struct Call;
template <class Result, class... Arguments, Result (*Functions::*function)(Arguments...)>
struct Call<Result (*)(Arguments...), function> {
    Result operator()(Arguments... arguments) const { return (current->*function)(arguments...); }
};
#define X(name) inline constexpr Call<decltype(&::gl##name), &Functions::name> name;
DOPPEL_GL_FUNCTIONS(X)
#undef X

}  // namespace doppel::gl
