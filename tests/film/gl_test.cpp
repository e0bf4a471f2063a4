#include "film/support.hpp"
#include "image/golden.hpp"
#include "render/osmesa_or_egl.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace gl_test {

/// Films a preset with both libraries at once, each drawing only what changes, as a run does.
void expect_the_same_film(const std::string& preset, long samples, long stride) {
    const Scene scene = scene_of(preset, {"video.size=[480, 270]"});
    Composer composer(scene);
    PairRun pair(scene);
    const std::atomic<bool> never = false;
    Renderer osmesa(scene.preset.video.size, composer.backdrop(), test::osmesa_or_egl()),
        egl(scene.preset.video.size, composer.backdrop(), Gl::egl);
    for (long n = 0; n <= samples; ++n) {
        composer.add({pair.next(never), {}});
        if (n % stride != 0) continue;
        const auto list = composer.frame();
        const auto verdict = compare_golden(osmesa.draw(list), egl.draw(list));
        ASSERT_TRUE(verdict.passes) << preset << ", sample " << n << ": " << verdict.why;
        EXPECT_EQ(osmesa.changed(), egl.changed()) << preset << ", sample " << n;
    }
}

// measured, both llvmpipe of one Mesa: no pixel of any frame differs
TEST(GlFilm, IsTheSameByOsmesaAndEgl) {
    expect_the_same_film("butterfly", 240, 6);
    expect_the_same_film("springs", 60, 6);
    expect_the_same_film("whip", 60, 6);
}

}  // namespace gl_test
}  // namespace doppel
