#include "scene/precision.hpp"

#include <cmath>
#include <limits>

namespace doppel {
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

}  // namespace

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

}  // namespace doppel
