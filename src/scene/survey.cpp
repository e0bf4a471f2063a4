#include "scene/survey.hpp"

#include <algorithm>

namespace doppel {

Survey survey(const Scene& scene) {
    const std::atomic<bool> never = false;
    PairRun pair(scene);
    auto moment = pair.next(never);
    const auto& first = moment.a.bobs.front();
    Survey seen{first.x, first.x, first.y, first.y};
    try {
        for (;;) {
            for (const auto* bobs : {&moment.a.bobs, &moment.b.bobs})
                for (const auto& bob : *bobs) {
                    seen.left = std::min(seen.left, bob.x);
                    seen.right = std::max(seen.right, bob.x);
                    seen.bottom = std::min(seen.bottom, bob.y);
                    seen.top = std::max(seen.top, bob.y);
                }
            seen.largest_distance = std::max(seen.largest_distance, moment.distance);
            if (moment.sample == scene.samples) break;
            moment = pair.next(never);
        }
    } catch (const BreakDown&) {  // the run itself will say so
    }
    return seen;
}

}  // namespace doppel
