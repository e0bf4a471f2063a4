#include "errors.hpp"
#include "image/color.hpp"
#include "image/golden.hpp"
#include "render/gl_context.hpp"
#include "render/osmesa_or_egl.hpp"
#include "render/pixels.hpp"
#include "render/renderer.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <thread>

namespace doppel::gl_test {

using test::library_of_osmesa_or_egl;
using test::osmesa_or_egl;

constexpr Size size{480, 270};

/// Every kind of item, with opaque and translucent colours, and edges between pixels.
DisplayList rich_list(int variant) {
    DisplayList list{filled(size, rgb(0x11151d))};
    const auto shift = static_cast<float>(variant) * 3.7f;
    for (int i = 0; i < 12; ++i) {
        const float x = 30.3f + 37.1f * static_cast<float>(i) + shift, y = 60 + 15.7f * static_cast<float>(i % 5);
        const Color color{0.1f + 0.07f * static_cast<float>(i), 0.9f - 0.05f * static_cast<float>(i), 0.5f,
                          i % 2 ? 1.0f : 0.6f};
        list.push_back(Box{x, y, x + 21.5f, y + 17.25f, static_cast<float>(i), color});
        list.push_back(Capsule{{x, y}, {x + 30, y + 90}, 0.7f + 0.5f * static_cast<float>(i), color});
        list.push_back(Ring{{x, 180}, 5.0f + 3 * static_cast<float>(i), 0.8f + 0.3f * static_cast<float>(i), color});
        list.push_back(Label{"Öl " + std::to_string(i),
                             {x, 230},
                             11.0f + static_cast<float>(i),
                             Align::center,
                             i % 3 ? Weight::regular : Weight::bold,
                             color});
    }
    Stroke trail{.vertices = {}, .width = 5.5f, .color = rgb(0xffa640)};
    for (int i = 0; i < 200; ++i) {
        const float t = 0.11f * static_cast<float>(i);
        trail.vertices.push_back({{240 + 200 * std::sin(t) + shift, 135 + 110 * std::sin(1.7f * t)}, t / 22});
    }
    list.push_back(trail);
    return list;
}

Picture drawn(Gl gl, const DisplayList& list) {
    Renderer renderer(size, {}, gl);
    return renderer.draw(list);
}

TEST(Gl, DrawsByTheLibraryThatIsNamed) {
    for (const Gl gl : {osmesa_or_egl(), Gl::egl, Gl::automatic})
        EXPECT_TRUE(Renderer({8, 8}, {}, gl)
                        .description()
                        .starts_with((gl == Gl::egl ? "EGL" : library_of_osmesa_or_egl()) + ", "));
}

TEST(Gl, TakesTheLibraryThatIsThereAndNeverAnotherThanWasAskedFor) {
    const auto expect = [](Gl gl, const GlLibraries& libraries, const std::string& outcome) {
        std::string found;
        const auto [code, message] = test::thrown_by([&] { found = make_context(gl, libraries)->library(); });
        EXPECT_EQ(found.empty() ? message : found, outcome);
        EXPECT_EQ(code, found.empty() ? ExitCode::io_failed : ExitCode::done) << outcome;
    };
    const std::string no_egl =
        "EGL cannot draw here: there is no libnone.so.1 (in Debian: libegl1, libegl-mesa0, libgl1-mesa-dri)";
    expect(Gl::automatic, {}, library_of_osmesa_or_egl());
    expect(Gl::automatic, {.osmesa = {"libnone.so.8"}}, "EGL");
    expect(Gl::automatic, {.osmesa = {"libEGL.so.1"}}, "EGL");  // a library without OSMesa's functions
    if (osmesa_or_egl() == Gl::osmesa) expect(Gl::osmesa, {.osmesa = {"libnone.so.9", "libOSMesa.so.8"}}, "OSMesa");
    expect(Gl::egl, {.egl = {"libnone.so.9", "libEGL.so.1"}}, "EGL");
    expect(Gl::osmesa, {.osmesa = {"libnone.so.8", "libnone.so"}},
           "OSMesa cannot draw here: there is no libnone.so.8 or libnone.so (in Debian: libosmesa6)");
    expect(Gl::egl, {.egl = {"libnone.so.1"}}, no_egl);
    expect(Gl::automatic, {.osmesa = {"libnone.so.8", "libEGL.so.1"}, .egl = {"libnone.so.1"}},
           "OSMesa cannot draw here: libEGL.so.1 has no OSMesaCreateContextAttribs (in Debian: libosmesa6); " + no_egl);
}

TEST(Gl, DrawsTheSameEitherWay) {
    const std::array lists{rich_list(0), rich_list(1)};
    for (const auto& list : lists) {
        const auto verdict = compare_golden(drawn(osmesa_or_egl(), list), drawn(Gl::egl, list));
        EXPECT_TRUE(verdict.passes) << verdict.why;  // measured, both llvmpipe of one Mesa: no pixel differs
    }
    EXPECT_FALSE(compare_golden(drawn(osmesa_or_egl(), lists[0]), drawn(Gl::egl, lists[1])).passes);
}

TEST(Gl, BothShareOneThread) {
    const std::array lists{rich_list(0), rich_list(1)};
    const std::array alone{drawn(osmesa_or_egl(), lists[0]), drawn(Gl::egl, lists[1])};
    Renderer osmesa(size, {}, osmesa_or_egl()), egl(size, {}, Gl::egl);
    for (int round = 0; round < 3; ++round) {
        // each draws while the other one was the last to draw
        EXPECT_EQ(osmesa.draw(lists[0]).rgba, alone[0].rgba) << round;
        EXPECT_EQ(egl.draw(lists[1]).rgba, alone[1].rgba) << round;
        osmesa.draw(lists[1]);
        egl.draw(lists[0]);
        EXPECT_TRUE(egl.description().starts_with("EGL"));
        EXPECT_TRUE(osmesa.description().starts_with(library_of_osmesa_or_egl()));
    }
}

TEST(Gl, GoInAnyOrder) {
    const auto list = rich_list(0);
    const std::array alone{drawn(osmesa_or_egl(), list).rgba, drawn(Gl::egl, list).rgba};
    for (const bool first_goes_first : {true, false}) {
        for (const bool current_goes : {true, false}) {
            std::array<std::optional<Renderer>, 2> renderers;
            renderers[0].emplace(size, DisplayList{}, osmesa_or_egl());
            renderers[1].emplace(size, DisplayList{}, Gl::egl);
            const std::size_t goes = first_goes_first ? 0 : 1, stays = 1 - goes;
            renderers[current_goes ? goes : stays]->draw(list);
            renderers[goes].reset();
            EXPECT_EQ(renderers[stays]->draw(list).rgba, alone[stays]);
            renderers[goes].emplace(size, DisplayList{}, goes == 0 ? osmesa_or_egl() : Gl::egl);
            EXPECT_EQ(renderers[goes]->draw(list).rgba, alone[goes]);
        }
    }
}

TEST(Gl, BothDrawInTwoThreadsAtTheSameTime) {
    const auto list = rich_list(0), other = rich_list(1);
    const std::array alone{drawn(osmesa_or_egl(), list).rgba, drawn(Gl::egl, list).rgba};
    std::array<int, 2> same{};
    {
        std::array<std::jthread, 2> threads;
        for (std::size_t k = 0; k < 2; ++k) {
            threads[k] = std::jthread([&, k] {
                for (int round = 0; round < 3; ++round) {
                    Renderer renderer(size, {}, k == 0 ? osmesa_or_egl() : Gl::egl);
                    for (int i = 0; i < 3; ++i) {
                        renderer.draw(other);
                        same[k] += renderer.draw(list).rgba == alone[k];
                    }
                }
            });
        }
    }
    EXPECT_EQ(same, (std::array{9, 9}));
}

TEST(Gl, AContextThatCannotBeMadeLeavesTheOthersAlone) {
    const auto list = rich_list(0);
    Renderer egl(size, {}, Gl::egl);
    const auto before = egl.draw(list).rgba;
    EXPECT_THROW(make_context(Gl::osmesa, {.osmesa = {"libnone.so.8"}}), Error);
    EXPECT_THROW(Renderer({0, 10}, {}, osmesa_or_egl()), Error);
    egl.draw({});
    EXPECT_EQ(egl.draw(list).rgba, before);
}

}  // namespace doppel::gl_test
