#include "film/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

Schedule schedule_of(const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto frames = [&](const Rational& seconds) { return std::lround(seconds.value() * scene.fps.value()); };
    return {.title = frames(video.title_card_s),
            .hold_start = frames(video.hold_start_s),
            .motion = scene.samples / scene.samples_per_frame + 1,
            .hold_end = frames(video.hold_end_s),
            .end = frames(video.end_card_s)};
}

double card_opacity(long k, long count, double fps, bool comes_up) {
    const double fade = std::max(1.0, std::min(0.5 * fps, static_cast<double>(count) / 2));  // frames
    const double left = static_cast<double>(comes_up ? k + 1 : count - k);
    const double share = std::clamp(left / (fade + 1), 0.0, 1.0);
    return share * share * (3 - 2 * share);
}

}  // namespace doppel
