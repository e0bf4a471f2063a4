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

/// The picture of one sample.
inline Picture frame_of(const Scene& scene, long sample) {
    Composer composer(scene);
    for_each_snapshot(scene, sample, [&](const Snapshot& snapshot) { composer.add(snapshot); });
    Renderer renderer(scene.preset.video.size, composer.backdrop(), Gl::automatic, false, scene.preset.video.typeface);
    return renderer.draw(composer.frame());
}

}  // namespace doppel
