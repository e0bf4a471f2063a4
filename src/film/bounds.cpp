#include "film/bounds.hpp"

#include "numeric/state.hpp"

#include <algorithm>
#include <array>
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

void add(MotionBounds& seen, const Scene& scene, const PairState& state, const Observation& side) {
    for (const auto& bob : side.bobs) {
        seen.left = std::min(seen.left, bob.x);
        seen.right = std::max(seen.right, bob.x);
        seen.bottom = std::min(seen.bottom, bob.y);
        seen.top = std::max(seen.top, bob.y);
    }
    const auto link = static_cast<std::size_t>(scene.preset.video.phase_link - 1);
    if (link < side.bobs.size()) seen.fastest = std::max(seen.fastest, std::abs(side.bobs[link].omega));
    for (const double force : side.tension) include(seen.rod_force, force);
    const double kinetic = kinetic_energy(side.bobs);
    auto& energies = seen.energies[&side == &state.a ? 0 : 1];
    for (const double energy : {kinetic, side.energy - kinetic, side.energy}) include(energies, energy);
    if (scene.a.has_angles && scene.b.has_angles)
        for (const auto k : shown_links(side.bobs.size())) {
            include(seen.angles, side.bobs[k].theta * 180 / pi);
            include(seen.rates, side.bobs[k].omega * 180 / pi);
        }
}

/// With a margin of a tenth; includes zero.
Range padded(const Range& seen) {
    const double low = std::min(seen.low, 0.0), high = std::max(seen.high, 0.0), width = high - low;
    if (!(width > 0) || !std::isfinite(width)) return {0, 1};
    return {low < 0 ? low - width / 10 : 0, high > 0 ? high + width / 10 : 0};
}

/// How far apart two chains can get in state space: as fast as each can be, in opposite directions, each bob as far
/// from where it hangs at rest as it can be, on opposite sides. With the energy E above rest, a bob of mass m rises by
/// at most E/(m g), and one that hangs a length l below the pivot is within √(2 l · rise) of its place at rest.
double farthest(const Scene& scene, const PairState& start) {
    const auto energy = [](const Side& side, const Observation& seen) {
        return std::max(seen.energy + side.energy_unit / 2, 0.0);  // J, above rest
    };
    const auto fastest = [](const Side& side, double available) {
        return std::sqrt(2 * available / *std::min_element(side.mass.begin(), side.mass.end()));
    };
    const std::array sides{&scene.a, &scene.b};
    const std::array available{energy(scene.a, start.a), energy(scene.b, start.b)};
    double squares = std::pow(fastest(scene.a, available[0]) + fastest(scene.b, available[1]), 2);
    std::array<double, 2> below{};  // m, of the bob that hangs
    const auto add = [&](const std::array<double, 2>& mass) {
        double swing = 0;
        for (std::size_t s = 0; s < 2; ++s) {
            const double rise = available[s] / (mass[s] * sides[s]->gravity);
            swing += std::sqrt(2 * below[s] * std::min(rise, 2 * below[s]));
        }
        const double apart = std::min(swing + std::abs(below[0] - below[1]), below[0] + below[1]);
        squares += apart * apart + std::pow(mass[0] - mass[1], 2);
    };
    if (differ_in_kind(scene.preset.a, scene.preset.b)) {
        below = {scene.a.reach, scene.b.reach};
        add({scene.a.mass.back(), scene.b.mass.back()});
        return std::sqrt(squares);
    }
    for (std::size_t k = 0; k < scene.a.mass.size(); ++k) {
        for (std::size_t s = 0; s < 2; ++s) below[s] += static_cast<double>(sides[s]->motion.chain->length[k]);
        add({scene.a.mass[k], scene.b.mass[k]});
    }
    return std::sqrt(squares);
}

/// The distance axis where the preset names none: from the decade of the start to as far as the two can get.
Range fitted_distance(const Scene& scene, const std::optional<MotionBounds>& seen) {
    const auto start = PairRun(scene).next(std::atomic<bool>(false));
    constexpr double decades = 1e60;  // the most an axis spans, whatever the masses and lengths
    const bool is_mechanism = scene.a.motion.model == Model::mechanism || scene.b.motion.model == Model::mechanism;
    const double most = is_mechanism && seen ? 1.5 * seen->largest_distance : farthest(scene, start),
                 high = std::isfinite(most) ? std::clamp(most, 1e-12, decades) : decades;
    // unlike sides start together or apart, not a hair apart
    const bool is_hair = start.distance > 0 && !differ_in_kind(scene.preset.a, scene.preset.b);
    const double low = is_hair ? start.distance / 2 : high * (start.distance > 0 ? 1e-4 : 1e-8);
    const double top = std::pow(10, std::ceil(2 * std::log10(high)) / 2);  // a half or a whole decade
    return {std::clamp(std::pow(10, std::floor(std::log10(low))), top / decades, top / 10), top};
}

/// From the least error that shows to all there is.
Range fitted_error(const Scene& scene) {
    const bool low_order = scene.a.method.order == 1 || scene.b.method.order == 1;
    return low_order ? Range{1e-8, 1} : Range{1e-16, 1};
}

}  // namespace

std::vector<std::size_t> shown_links(std::size_t count) {
    constexpr std::size_t most = 3;
    std::vector<std::size_t> shown;
    for (std::size_t k = 0; k < count; ++k)
        if (count <= most || k == 0 || k + 1 == count) shown.push_back(k);
    return shown;
}

std::optional<double> exponent_so_far(const Scene& scene, const PairState& state, double start_distance) {
    if (state.sample == 0 || 20 * state.sample < scene.samples) return std::nullopt;
    if (!(state.distance > 0 && start_distance > 0)) return std::nullopt;
    return std::log(state.distance / start_distance) / scene.time_of_tick(state.tick);
}

std::optional<MotionBounds> motion_bounds(const Scene& scene, const std::atomic<bool>& stop) {
    if (!is_needed(scene)) return std::nullopt;
    PairRun pair(scene);
    auto state = pair.next(stop);
    const auto& first = state.a.bobs.front();
    MotionBounds seen{first.x, first.x, first.y, first.y};
    const double start_distance = state.distance;
    try {
        for (;;) {
            add(seen, scene, state, state.a);
            add(seen, scene, state, state.b);
            seen.largest_distance = std::max(seen.largest_distance, state.distance);
            if (const auto exponent = exponent_so_far(scene, state, start_distance)) include(seen.exponent, *exponent);
            if (state.sample == scene.samples) break;
            state = pair.next(stop);
        }
    } catch (const BreakDown&) {  // the run itself will say so
    }
    return seen;
}

/// The circle that the outstretched chain reaches; of a mechanism, the places that it visits.
View fitted_view(const Scene& scene, const std::optional<MotionBounds>& seen) {
    if (scene.a.motion.model != Model::mechanism && scene.b.motion.model != Model::mechanism) {
        const double across = 2 * std::max(scene.a.reach, scene.b.reach);
        return {.width = across, .height = across};
    }
    double left = seen->left, right = seen->right, bottom = seen->bottom, top = seen->top;
    for (const auto* side : {&scene.a, &scene.b})
        for (const auto& line : side->lines)
            for (const auto* end : {&line.from, &line.to})
                if (const auto* place = std::get_if<Place<double>>(end)) {
                    left = std::min(left, (*place)[0] - line.radius);
                    right = std::max(right, (*place)[0] + line.radius);
                    bottom = std::min(bottom, (*place)[1] - line.radius);
                    top = std::max(top, (*place)[1] + line.radius);
                }
    const double least = 1e-3 * std::max({right - left, top - bottom, 1e-6});
    const View view{(left + right) / 2, (bottom + top) / 2, std::max(right - left, least),
                    std::max(top - bottom, least), false};
    return std::isfinite(view.width + view.height) ? view : View{.width = 2, .height = 2, .is_circle = false};
}

Range fitted_range(StripKind kind, const Scene& scene, const std::optional<MotionBounds>& seen) {
    switch (kind) {
        case StripKind::distance:
            return fitted_distance(scene, seen);
        case StripKind::exponent:
            return padded(seen ? seen->exponent : Range{});
        case StripKind::rod_force:
            return padded(seen ? seen->rod_force : Range{});
        case StripKind::energies_a:
        case StripKind::energies_b:
            return padded(seen ? seen->energies[kind == StripKind::energies_a ? 0 : 1] : Range{});
        case StripKind::angles:
            return padded(seen ? seen->angles : Range{});
        case StripKind::rates:
            return padded(seen ? seen->rates : Range{});
        case StripKind::energy:
        case StripKind::rod_error:
            break;
    }
    return fitted_error(scene);
}

}  // namespace doppel
