#include "film/survey.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

void include(Range& range, double value) {
    range = {std::min(range.low, value), std::max(range.high, value)};
}

bool is_needed(const Scene& scene) {
    const auto& video = scene.preset.video;
    const bool is_mechanism = scene.a.motion.model == Model::mechanism || scene.b.motion.model == Model::mechanism;
    const auto fits_itself = [&](StripKind kind) {
        const bool by_formula = is_logarithmic(kind) && !(kind == StripKind::distance && is_mechanism);
        return !by_formula && !video.ranges[static_cast<std::size_t>(kind)];
    };
    const bool view = video.pendulums && (is_mechanism || video.layout == Arrangement::phase);
    return view || std::any_of(video.strips.begin(), video.strips.end(), fits_itself);
}

void add(Survey& seen, const Scene& scene, const Observation& side) {
    for (const auto& bob : side.bobs) {
        seen.left = std::min(seen.left, bob.x);
        seen.right = std::max(seen.right, bob.x);
        seen.bottom = std::min(seen.bottom, bob.y);
        seen.top = std::max(seen.top, bob.y);
    }
    const auto link = static_cast<std::size_t>(scene.preset.video.phase_link - 1);
    if (link < side.bobs.size()) seen.fastest = std::max(seen.fastest, std::abs(side.bobs[link].omega));
    for (const double force : side.tension) include(seen.rod_force, force);
}

}  // namespace

std::optional<double> exponent_so_far(const Scene& scene, const Moment& moment, double start_distance) {
    if (moment.sample == 0 || 20 * moment.sample < scene.samples) return std::nullopt;
    if (!(moment.distance > 0 && start_distance > 0)) return std::nullopt;
    return std::log(moment.distance / start_distance) / scene.time(moment.sample);
}

std::optional<Survey> survey(const Scene& scene, const std::atomic<bool>& stop) {
    if (!is_needed(scene)) return std::nullopt;
    PairRun pair(scene);
    auto moment = pair.next(stop);
    const auto& first = moment.a.bobs.front();
    Survey seen{first.x, first.x, first.y, first.y};
    const double start_distance = moment.distance;
    try {
        for (;;) {
            add(seen, scene, moment.a);
            add(seen, scene, moment.b);
            seen.largest_distance = std::max(seen.largest_distance, moment.distance);
            if (const auto exponent = exponent_so_far(scene, moment, start_distance)) include(seen.exponent, *exponent);
            if (moment.sample == scene.samples) break;
            moment = pair.next(stop);
        }
    } catch (const BreakDown&) {  // the run itself will say so
    }
    return seen;
}

}  // namespace doppel
