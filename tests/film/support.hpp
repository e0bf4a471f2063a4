#pragma once

#include "film/composer.hpp"
#include "integrate/motion_batch.hpp"
#include "render/renderer.hpp"
#include "scene/support.hpp"

namespace doppel {

/// Calls visit(snapshot) for the samples 0 … last.
template <class Visit>
void for_each_snapshot(const Scene& scene, long last, Visit&& visit) {
    PairRun pair(scene);
    std::optional<MotionBatch> members;
    if (!scene.members.empty()) members.emplace(scene.members, 1);
    const std::atomic<bool> never = false;
    for (long n = 0; n <= last; ++n) {
        Snapshot snapshot{pair.next(never), {}};
        if (members && n > 0) members->advance(never);
        for (std::size_t k = 0; members && k < members->size(); ++k) snapshot.members.push_back(members->bobs(k));
        visit(snapshot);
    }
}

/// A preset x.toml of this text.
inline Scene scene_of_text(const std::string& text) {
    return make_scene(read_preset({"x", "presets/x.toml", text}));
}

/// What makes a chain one of one link, the sides at these angles.
inline std::vector<std::string> one_link_at(const std::string& a, const std::string& b) {
    return {"system.links=1",
            "system.mass_kg=[1]",
            "system.length_m=[1]",
            "system.omega_deg_per_s=[0]",
            "system.angle_deg=[" + a + "]",
            "a.angle_deg=[" + a + "]",
            "b.angle_deg=[" + b + "]"};
}

/// The picture of one sample.
inline Picture frame_of(const Scene& scene, long sample) {
    Composer composer(scene);
    for_each_snapshot(scene, sample, [&](const Snapshot& snapshot) { composer.add(snapshot); });
    Renderer renderer(scene.preset.video.size, composer.backdrop(), Gl::automatic, false, scene.preset.video.typeface);
    return renderer.draw(composer.frame());
}

}  // namespace doppel
