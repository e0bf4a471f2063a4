#pragma once

#include "film/composer.hpp"
#include "film/recording.hpp"
#include "output/sink.hpp"
#include "render/pixels.hpp"
#include "scene/support.hpp"

#include <memory>

namespace doppel {

inline MotionBounds bounds_of(const Scene& scene) {
    return Recording(scene, {1}, true, never_stopped).bounds();
}
inline Layout make_layout(const Scene& scene) {
    return make_layout(scene, bounds_of(scene));
}

/// Calls visit(snapshot) for the samples 0 … last.
template <class Visit>
void for_each_snapshot(const Scene& scene, long last, Visit&& visit) {
    Recording(scene, {last + 1}, !scene.members.empty(), never_stopped).play([&](const Snapshot& snapshot) {
        if (snapshot.pair.share == 0) visit(snapshot);
    });
}

inline PairState state_at(const Scene& scene, long sample) {
    PairState last;
    for_each_snapshot(scene, sample, [&](const Snapshot& seen) { last = seen.pair; });
    return last;
}

/// A scene from a preset x.toml with this text.
inline Scene scene_of_text(const std::string& text) {
    return make_scene(read_preset({"x", "presets/x.toml", text}));
}

/// The arguments that make a chain of one link, released at these angles.
inline std::vector<std::string> one_link_at(const std::string& a, const std::string& b) {
    return {"system.links=1",
            "system.mass_kg=[1]",
            "system.length_m=[1]",
            "system.omega_deg_per_s=[0]",
            "system.angle_deg=[" + a + "]",
            "a.angle_deg=[" + a + "]",
            "b.angle_deg=[" + b + "]"};
}

/// A composer that has processed the samples 0 … last.
std::unique_ptr<Composer> composed(const Scene&&, long) = delete;
inline std::unique_ptr<Composer> composed(const Scene& scene, long last) {
    Recording recording(scene, {last + 1}, true, never_stopped);
    auto composer = std::make_unique<Composer>(scene, recording.bounds());
    recording.play([&](const Snapshot& snapshot) {
        if (snapshot.pair.share == 0) composer->add(snapshot);
    });
    return composer;
}

/// Of one sample.
inline Picture frame_of(const Scene& scene, long sample) {
    const auto composer = composed(scene, sample);
    Renderer renderer(scene.preset.video.size, composer->backdrop(), Gl::automatic, false, scene.preset.video.typeface);
    return renderer.draw(composer->frame());
}

/// A preset, its layout, and the picture of one sample.
struct Drawn {
    Scene scene;
    Layout layout = make_layout(scene);
    Picture picture;

    explicit Drawn(const Scene& of, long sample = 0) : scene(of), picture(frame_of(scene, sample)) {}
    bool has(Point at, Color color, int slack = 3) const { return is_color(picture, at, color, slack); }
};

}  // namespace doppel
