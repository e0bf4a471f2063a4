#include "render/gl_objects.hpp"

#include "base/error.hpp"
#include "embedded/render.hpp"

#include <utility>

namespace doppel::gl {
namespace {

/// The driver's log of a shader or program.
template <class GetLog>
std::string log(GetLog get, GLuint number) {
    std::string text(1024, '\0');
    GLsizei length = 0;
    get(number, static_cast<GLsizei>(text.size()), &length, text.data());
    text.resize(static_cast<std::size_t>(length));
    return text;
}

void attach(GLuint program, GLenum type, const std::string& name) {
    const std::string_view source = embedded_file(render_files(), name);
    const char* text = source.data();
    const auto length = static_cast<GLint>(source.size());
    const GLuint shader = CreateShader(type);
    ShaderSource(shader, 1, &text, &length);
    CompileShader(shader);
    AttachShader(program, shader);
    DeleteShader(shader);
    GLint compiled = GL_FALSE;
    GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) throw io_failed("shaders/{}: {}", name, log(GetShaderInfoLog, shader));
}

std::string name_of(GLenum error) {
    constexpr std::pair<GLenum, const char*> names[] = {
        {GL_INVALID_ENUM, "GL_INVALID_ENUM"},
        {GL_INVALID_VALUE, "GL_INVALID_VALUE"},
        {GL_INVALID_OPERATION, "GL_INVALID_OPERATION"},
        {GL_INVALID_FRAMEBUFFER_OPERATION, "GL_INVALID_FRAMEBUFFER_OPERATION"}};
    for (const auto& [number, name] : names)
        if (number == error) return name;
    return fmt::format("error {:#06x}", error);
}

}  // namespace

void check_errors(const std::string& what) {
    const GLenum first = GetError();
    if (first == GL_NO_ERROR) return;
    bool no_memory = false;
    // a driver may store several errors; a lost context returns one for ever
    GLenum error = first;
    for (int k = 0; k < 16 && error != GL_NO_ERROR; ++k, error = GetError()) no_memory |= error == GL_OUT_OF_MEMORY;
    if (no_memory) throw io_failed("OpenGL has no memory for {}", what);
    throw io_failed("OpenGL failed at {}: {}", what, name_of(first));
}

Program::Program(const std::string& fragment) : number_(CreateProgram()) {
    attach(number_, GL_VERTEX_SHADER, "quad.vert");
    attach(number_, GL_FRAGMENT_SHADER, fragment);
    GLuint location = 0;
    for (const char* input :
         {"vertex_position", "vertex_frame", "vertex_shape", "vertex_params", "vertex_parabola", "vertex_tint"})
        BindAttribLocation(number_, location++, input);
    LinkProgram(number_);
    GLint linked = GL_FALSE;
    GetProgramiv(number_, GL_LINK_STATUS, &linked);
    if (!linked) throw io_failed("shaders/quad.vert and {}: {}", fragment, log(GetProgramInfoLog, number_));
}

}  // namespace doppel::gl
