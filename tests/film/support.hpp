#pragma once

#include "film/composer.hpp"
#include "film/recording.hpp"
#include "integrate/motion_batch.hpp"
#include "output/sink.hpp"
#include "render/renderer.hpp"
#include "scene/support.hpp"

#include <memory>
#include <optional>

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
    PairRun pair(scene);
    std::optional<MotionBatch> members;
    if (!scene.members.empty()) members.emplace(scene.members, 1);
    for (long n = 0; n <= last; ++n) {
        Snapshot snapshot{pair.next(never_stopped), {}};
        if (members && n > 0) members->advance(never_stopped);
        for (std::size_t k = 0; members && k < members->size(); ++k) snapshot.members.push_back(members->bobs(k));
        visit(snapshot);
    }
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
inline std::unique_ptr<Composer> composed(const Scene& scene, long last, PictureKind dress = PictureKind::film) {
    Recording recording(scene, {last + 1}, true, never_stopped);
    auto composer = std::make_unique<Composer>(scene, recording.bounds(), dress);
    recording.play([&](const Snapshot& snapshot) {
        if (snapshot.pair.share == 0) composer->add(snapshot);
    });
    return composer;
}

/// The picture of one sample.
inline Picture frame_of(const Scene& scene, long sample) {
    const auto composer = composed(scene, sample);
    Renderer renderer(scene.preset.video.size, composer->backdrop(), Gl::automatic, false, scene.preset.video.typeface);
    return renderer.draw(composer->frame());
}

}  // namespace doppel
