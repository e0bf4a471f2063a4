#include "film/bounds.hpp"

#include "numeric/state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace doppel {
namespace {

void include(Range& range, double value) {
    range = {std::min(range.low, value), std::max(range.high, value)};
}

/// Whether the outstretched chain's circle holds all that is drawn: droplets pull from afar, and are not shown.
bool stays_in_circle(const SideSpec& side) {
    return side.particles.empty() && side.constraints.empty() &&
           std::all_of(side.forces.begin(), side.forces.end(),
                       [](const PartSpec& force) { return force.kind == PartKind::droplet; });
}

bool has_circle(const Scene& scene) {
    return stays_in_circle(scene.preset.a) && stays_in_circle(scene.preset.b);
}

bool is_needed(const Scene& scene) {
    const auto& video = scene.preset.video;
    const bool view = video.pendulums && (!has_circle(scene) || video.layout == Arrangement::phase);
    return view || std::any_of(video.strips.begin(), video.strips.end(),
                               [&](StripKind kind) { return !video.ranges[static_cast<std::size_t>(kind)]; });
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
    const double kinetic = side.kinetic_energy;
    auto& energies = seen.energies[&side == &state.a ? 0 : 1];
    for (const double energy : {kinetic, side.energy - kinetic, side.energy}) include(energies, energy);
    include(seen.total_energy, side.energy);
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

/// m
double chain_length(const SideSpec& side) {
    double sum = 0;
    for (const auto& length : side.length_m) sum += static_cast<double>(length);
    return sum;
}

/// The nearest 1, 2 or 5 times a power of ten that is no larger, or no smaller.
double round_number(double value, bool up) {
    const double unit = std::pow(10, std::floor(std::log10(value)));
    double best = up ? 10 * unit : unit;
    for (const double step : {5.0, 2.0, 1.0})
        if (up ? step * unit >= value : step * unit <= value) {
            best = step * unit;
            if (!up) break;
        }
    return best;
}

/// The distance axis where the preset names none: all that the two do, a power of ten at least; of twins that start
/// alike no more than eight, as they come from nothing.
Range fitted_distance(const std::optional<MotionBounds>& seen) {
    constexpr double decades = 1e60;  // the most an axis spans, whatever the masses and lengths
    if (!seen || seen->distance.count == 0) return {1e-8, 1};
    const double most = std::clamp(seen->distance.most, 1e-290, decades);
    const double high = round_number(1.02 * most, true);
    const double least = std::clamp(seen->distance.least, high / decades, most);
    const double low =
        most / least < 100 ? round_number(0.98 * least, false) : std::pow(10, std::floor(std::log10(least)));
    return {std::clamp(low, high / decades, high / 10), high};
}

/// From the least error that shows to the largest there is, two powers of ten to six.
Range fitted_error(const Spread& seen) {
    if (seen.count == 0) return {1e-16, 1};
    const double high = std::pow(10, std::ceil(std::log10(1.02 * seen.most)));
    const double low = std::pow(10, std::floor(std::log10(seen.geometric_mean() / 10)));
    return {std::clamp(low, high * 1e-6, high * 1e-2), high};
}

}  // namespace

void Spread::add(double value) {
    if (!(value > 0) || !std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
    log_sum += std::log(value);
    ++count;
}

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
    return std::log(state.distance / start_distance) / scene.time(state.moment());
}

std::optional<MotionBounds> motion_bounds(const Scene& scene, const std::atomic<bool>& stop) {
    if (!is_needed(scene)) return std::nullopt;
    PairRun pair(scene);
    auto state = pair.next(stop);
    const auto& first = state.a.bobs.front();
    MotionBounds seen{.left = first.x, .right = first.x, .bottom = first.y, .top = first.y};
    const double start_distance = state.distance;
    try {
        for (;;) {
            add(seen, scene, state, state.a);
            add(seen, scene, state, state.b);
            if (start_distance > 0 || 50 * state.sample >= scene.samples) seen.distance.add(state.distance);
            for (const auto& [side, now] : {std::pair{&scene.a, &state.a}, {&scene.b, &state.b}}) {
                if (side->has_energy_error) seen.energy_error.add(std::abs(now->energy_change) / scene.energy_range());
                seen.rod_error.add(now->length_error);
            }
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
    if (has_circle(scene)) {
        const double across = 2 * std::max(chain_length(scene.preset.a) + scene.a.pivot_reach,
                                           chain_length(scene.preset.b) + scene.b.pivot_reach);
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

Range fitted_range(StripKind kind, const std::optional<MotionBounds>& seen) {
    switch (kind) {
        case StripKind::distance:
            return fitted_distance(seen);
        case StripKind::exponent:
            return padded(seen ? seen->exponent : Range{});
        case StripKind::rod_force:
            return padded(seen ? seen->rod_force : Range{});
        case StripKind::energies_a:
        case StripKind::energies_b:
            return padded(seen ? seen->energies[kind == StripKind::energies_a ? 0 : 1] : Range{});
        case StripKind::total_energy:
            return padded(seen ? seen->total_energy : Range{});
        case StripKind::angles:
            return padded(seen ? seen->angles : Range{});
        case StripKind::rates:
            return padded(seen ? seen->rates : Range{});
        case StripKind::energy:
            return fitted_error(seen ? seen->energy_error : Spread{});
        case StripKind::rod_error:
            break;
    }
    return fitted_error(seen ? seen->rod_error : Spread{});
}

}  // namespace doppel
