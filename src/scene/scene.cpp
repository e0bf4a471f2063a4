#include "scene/scene.hpp"

#include "base/error.hpp"
#include "scene/method_choice.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

double Scene::time(long sample) const {
    return static_cast<double>(sample) * static_cast<double>(preset.sample_hz.denominator) /
           static_cast<double>(preset.sample_hz.numerator);
}

std::optional<double> Scene::horizon() const {
    long first = samples;
    for (const auto* side : {&a, &b})
        if (side->choice) first = std::min(first, side->choice->horizon);
    if (first == samples) return std::nullopt;
    return time(first);
}

namespace {

constexpr const char* remedy = "both sides would move identically. Set precision = \"quad\"";

void check_rounding(const Scene& scene, const char* key, const std::vector<Quad>& a, const std::vector<Quad>& b) {
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (a[i] == b[i] || static_cast<double>(a[i]) != static_cast<double>(b[i])) continue;
        throw bad_input("{}: {}[{}] is {} on side a and {} on side b, the same number in double: {}", scene.preset.name,
                        key, i, text_of(a[i]), text_of(b[i]), remedy);
    }
}

/// The pull of every droplet on the first particle, m/s².
void check_droplets(const Scene& scene, const Side& side) {
    if (!side.motion.parts) return;
    const auto parts = side.motion.parts->cast<double>();
    for (const auto& force : parts.forces) {
        const auto* droplet = std::get_if<Droplet<double>>(&force);
        if (!droplet) continue;
        const double pull =
            droplet->constant * droplet->mass / (parts.particles.front().place - droplet->place).squaredNorm();
        const double rounding = std::nextafter(side.gravity, 2 * side.gravity) - side.gravity;
        if (pull >= rounding) continue;
        throw bad_input("{}: the droplet pulls with {:.2g} m/s², below the rounding of g in double ({:.2g}): {}",
                        scene.preset.name, pull, rounding, remedy);
    }
}

/// Throws Error (exit 2) where what sets the sides apart is lost in double: two numbers that differ and round to the
/// same, or a droplet whose pull vanishes next to gravity.
void check_precision(const Scene& scene) {
    for (const auto* side : {&scene.a, &scene.b})
        if (side->motion.precision == Precision::in_double) check_droplets(scene, *side);
    if (scene.a.motion.precision == Precision::in_quad && scene.b.motion.precision == Precision::in_quad) return;
    const auto &a = scene.preset.a, &b = scene.preset.b;
    check_rounding(scene, "mass_kg", a.mass_kg, b.mass_kg);
    check_rounding(scene, "length_m", a.length_m, b.length_m);
    check_rounding(scene, "angle_deg", a.angle_deg, b.angle_deg);
    check_rounding(scene, "omega_deg_per_s", a.omega_deg_per_s, b.omega_deg_per_s);
    check_rounding(scene, "gravity_m_per_s2", {a.gravity_m_per_s2}, {b.gravity_m_per_s2});
    for (std::size_t i = 0; i < std::min(a.particles.size(), b.particles.size()); ++i) {
        const auto &one = a.particles[i], &other = b.particles[i];
        const auto numbers = [](const ParticleSpec& p) {
            return std::vector<Quad>{p.position_m[0], p.position_m[1], p.velocity_m_per_s[0], p.velocity_m_per_s[1],
                                     p.mass_kg};
        };
        check_rounding(scene, one.name.c_str(), numbers(one), numbers(other));
    }
}

/// Errors say whose they are.
Side side_of(const Preset& preset, const SideSpec& spec, char name, const std::atomic<bool>& stop) {
    try {
        if (spec.accuracy) return choose_side(spec, preset.duration_s, preset.sample_hz, stop);
        return make_side(spec, preset.sample_hz);
    } catch (const Error& fault) {
        throw Error(fault.code(), fmt::format("{}: side {}: {}", preset.name, name, fault.what()));
    }
}

/// The members of an ensemble, stepped as side a is.
std::vector<MotionSpec> members_of(const Scene& scene) {
    const auto &first = scene.preset.a, &last = scene.preset.b;
    std::vector<MotionSpec> members;
    for (int k = 0; k < scene.preset.video.members; ++k) {
        const Quad share = Quad(k) / (scene.preset.video.members - 1);
        const auto between = [&](const Quad& from, const Quad& to) { return Quad(from + share * (to - from)); };
        SideSpec member = first;
        for (const auto numbers :
             {&SideSpec::mass_kg, &SideSpec::length_m, &SideSpec::angle_deg, &SideSpec::omega_deg_per_s})
            std::transform((first.*numbers).begin(), (first.*numbers).end(), (last.*numbers).begin(),
                           (member.*numbers).begin(), between);
        member.gravity_m_per_s2 = between(first.gravity_m_per_s2, last.gravity_m_per_s2);
        members.push_back(scene.a.motion);
        members.back().chain = chain_of(member);
        members.back().wants_tension = false;
    }
    return members;
}

}  // namespace

Scene make_scene(const Preset& preset, const std::atomic<bool>& stop) {
    Scene scene{.preset = preset,
                .a = side_of(preset, preset.a, 'a', stop),
                .b = side_of(preset, preset.b, 'b', stop),
                .samples = product(preset.duration_s, preset.sample_hz)->numerator,
                .members = {},
                .fps = {},
                .samples_per_frame = 1};
    const auto samples_a_second = *product(preset.sample_hz, preset.video.speed);
    scene.fps = preset.video.fps.value_or(samples_a_second);
    scene.samples_per_frame = quotient(samples_a_second, scene.fps)->numerator;
    const auto wanted = [&](StripKind kind) {
        return std::find(preset.video.strips.begin(), preset.video.strips.end(), kind) != preset.video.strips.end();
    };
    scene.a.motion.wants_tension = scene.b.motion.wants_tension = wanted(StripKind::rod_force);
    check_precision(scene);
    if (preset.video.layout == Arrangement::ensemble) scene.members = members_of(scene);
    return scene;
}

}  // namespace doppel
