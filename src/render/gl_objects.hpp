#pragma once

#include "render/gl_api.hpp"

#include <string>

namespace doppel::gl {

/// Throws Error (exit 4) if OpenGL has reported an error since the last call. `what`: the task, "a canvas of 64 × 64
/// px".
void check_errors(const std::string& what);

/// Owns an OpenGL object. Its context must be current at construction and destruction.
template <auto& generate, auto& destroy>
class Object {
public:
    Object() { generate(1, &number_); }
    ~Object() { destroy(1, &number_); }
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    operator GLuint() const { return number_; }

private:
    GLuint number_ = 0;
};

using Buffer = Object<GenBuffers, DeleteBuffers>;
using Texture = Object<GenTextures, DeleteTextures>;
using VertexArray = Object<GenVertexArrays, DeleteVertexArrays>;
using Framebuffer = Object<GenFramebuffers, DeleteFramebuffers>;

/// shaders/quad.vert, whose inputs have the locations 0 to 5 in their order there, and a fragment shader beside it;
/// compiled and linked.
class Program {
public:
    explicit Program(const std::string& fragment);
    ~Program() { DeleteProgram(number_); }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    operator GLuint() const { return number_; }

private:
    GLuint number_;
};

}  // namespace doppel::gl
