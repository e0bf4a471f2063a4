#include "errors.hpp"
#include "render/gl_context.hpp"
#include "render/gl_painter.hpp"
#include "render/pixels.hpp"
#include "render/renderer.hpp"

#include <gtest/gtest.h>

namespace doppel::gl_errors_test {

constexpr Size size{480, 270};

/// Crossing strokes, which need several ways of blending.
DisplayList strokes(int variant) {
    DisplayList list{filled(size, black)};
    for (int k = 0; k < 3; ++k) {
        Stroke stroke{.vertices = {}, .width = 6, .color = rgb(0xffa640)};
        for (int i = 0; i < 40; ++i) {
            const float t = 0.2f * static_cast<float>(i + 7 * k + variant);
            stroke.vertices.push_back({{240 + 200 * std::sin(t), 135 + 110 * std::sin(1.7f * t)}, 1});
        }
        list.push_back(stroke);
    }
    return list;
}

/// OpenGL's functions, where `change` makes one fail at its first use.
template <class Change>
class Broken {
public:
    explicit Broken(Change change) : whole_(gl::current), broken_(*whole_) {
        change(broken_);
        gl::current = &broken_;
    }
    ~Broken() { gl::current = whole_; }
    Broken(const Broken&) = delete;
    Broken& operator=(const Broken&) = delete;

private:
    const gl::Functions* whole_;
    gl::Functions broken_;
};

/// OpenGL's error queue: one error, then none.
GLenum out_of_memory() {
    static int calls = 0;
    return calls++ % 2 == 0 ? GL_OUT_OF_MEMORY : GL_NO_ERROR;
}

TEST(GlErrors, SayWhatThereIsNoMemoryFor) {
    const auto context = make_context(Gl::automatic);
    const auto forget = [](gl::Functions& functions) { functions.GetError = out_of_memory; };
    const auto broken = [&](const auto& action) {
        const Broken now(forget);
        const auto [code, message] = test::thrown_by(action);
        EXPECT_EQ(code, ExitCode::io_failed);
        return message;
    };
    EXPECT_EQ(broken([] { gl::Painter painter(size); }),
              "OpenGL has no memory for the shaders and the buffers of their input");
    EXPECT_EQ(broken([] { gl::check_errors("a cup of tea"); }), "OpenGL has no memory for a cup of tea");

    Renderer renderer(size);
    const DisplayList dot{Capsule{{20, 20}, {20, 20}, 5, white}};
    EXPECT_EQ(broken([&] { renderer.draw(dot); }), "OpenGL has no memory for the outlines of 1 shapes");
    EXPECT_EQ(broken([&] { renderer.draw(dot); }), "OpenGL has no memory for drawing a picture of 480 × 270 px");
    const DisplayList word{Label{"W", {20, 60}, 20, Align::left, Weight::regular, white}};
    EXPECT_EQ(broken([&] { renderer.draw(word); }), "OpenGL has no memory for an atlas of 1 glyphs");
}

TEST(GlErrors, WhileDrawingLeaveNoPicture) {
    Renderer renderer(size);
    const auto list = strokes(0);
    const auto whole = renderer.draw(list).rgba;
    {
        const Broken now([](gl::Functions& functions) {
            functions.BlendEquation = [](GLenum) { gl::Enable(GL_TRIANGLES); };  // not a valid argument
        });
        EXPECT_EQ(
            test::thrown_by([&] { renderer.draw(strokes(1)); }),
            (test::Thrown{ExitCode::io_failed, "OpenGL failed at drawing a picture of 480 × 270 px: error 0x0500"}));
    }
    EXPECT_EQ(renderer.draw(list).rgba, whole) << "and the next is as it should be";
}

}  // namespace doppel::gl_errors_test
