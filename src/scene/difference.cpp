#include "base/error.hpp"
#include "scene/scene.hpp"
#include "scene/side_keys.hpp"

#include <cmath>

namespace doppel {
namespace {

template <class Scalar>
constexpr std::string_view working = std::is_same_v<Scalar, Quad> ? "quad" : "double";
template <class Scalar>
constexpr std::string_view remedy = std::is_same_v<Scalar, Quad> ? "" : ". Set precision = \"quad\"";

/// Throws if the droplet's attraction of the first particle is lost in the rounding of gravity, m/s².
void check_droplets(const Scene& scene, const Side& side) {
    if (!side.motion.parts) return;
    const auto parts = side.motion.parts->cast<double>();
    for (const auto& force : parts.forces) {
        const auto* droplet = std::get_if<Droplet<double>>(&force);
        if (!droplet) continue;
        const double attraction =
            droplet->constant * droplet->mass / (parts.particles.front().place - droplet->place).squaredNorm();
        const double rounding = std::nextafter(side.gravity, 2 * side.gravity) - side.gravity;
        if (attraction >= rounding) continue;
        throw bad_input(
            "{}: the droplet attracts with {:.2g} m/s², below the rounding of g in double ({:.2g}): both sides would "
            "move identically{}",
            scene.preset.name, attraction, rounding, remedy<double>);
    }
}

/// The factor applied before computing: angles become radians, frequencies rad/s.
Quad factor_of(std::string_view unit) {
    if (unit.starts_with("deg")) return pi_of<Quad>() / 180;
    return unit == "Hz" ? 2 * pi_of<Quad>() : Quad(1);
}

/// Throws if a number differs between the sides and is rounded to the same value in `Scalar`.
template <class Scalar>
void check_numbers(const Scene& scene, const std::vector<KeyDifference>& differences) {
    for (const auto& [a, b] : differences) {
        if (!a || !b || a->numbers.size() != b->numbers.size()) continue;
        const auto factor = factor_of(a->unit);
        const auto computed = [&](const Quad& number) { return static_cast<Scalar>(Quad(number * factor)); };
        for (std::size_t i = 0; i < a->numbers.size(); ++i) {
            const auto &of_a = a->numbers[i], &of_b = b->numbers[i];
            if (of_a == of_b || computed(of_a) != computed(of_b)) continue;
            throw bad_input(
                "{}: {}{} is {} on side a and {} on side b, the same number in {}: both sides would move identically{}",
                scene.preset.name, a->name(), a->numbers.size() > 1 ? fmt::format("[{}]", i) : "", text_of(of_a),
                text_of(of_b), working<Scalar>, remedy<Scalar>);
        }
    }
}

/// The system of a side and its initial state, in `Scalar`.
template <class Scalar>
struct System {
    std::optional<Pendulum<Scalar>> chain;
    std::optional<PhysicalPendulum<Scalar>> physical;
    std::optional<Assembly<Scalar>> parts;
    std::vector<Scalar> start;  // of particles that are links of a chain

    explicit System(const MotionSpec& motion) {
        if (motion.parts) {
            parts = motion.parts->cast<Scalar>();
            return;
        }
        if (motion.chain) chain = motion.chain->cast<Scalar>();
        if (motion.physical) physical = motion.physical->cast<Scalar>();
        if (motion.model == Model::angles || !chain) return;
        const auto released = released_as_particles<Scalar, Eigen::Dynamic>(*chain);
        start.assign(released.begin(), released.end());
        for (auto* of : {&*chain, physical ? &physical->chain : &*chain}) of->angle = of->rate = {};
    }
    friend bool operator==(const System&, const System&) = default;
};

template <class Scalar>
bool are_same(const Scene& scene) {
    return System<Scalar>(scene.a.motion) == System<Scalar>(scene.b.motion);
}

/// Throws if the sides' keys differ and their systems differ in quad, but not in `Scalar`. A key may have no effect
/// even in quad, such as a length equal to the initial distance.
template <class Scalar>
void check_systems(const Scene& scene, const std::vector<KeyDifference>& differences) {
    if (scene.a.motion.model != scene.b.motion.model || !are_same<Scalar>(scene)) return;
    if constexpr (std::is_same_v<Scalar, double>)
        if (are_same<Quad>(scene)) return;
    std::string names;
    for (const auto& difference : differences)
        if (const auto name = difference.any().name(); names.find(name) == std::string::npos)
            names += (names.empty() ? "" : ", ") + name;
    throw bad_input("{}: {} differ, but not in the numbers of {}: both sides would move identically{}",
                    scene.preset.name, names, working<Scalar>, remedy<Scalar>);
}

}  // namespace

void check_difference(const Scene& scene) {
    for (const auto* side : {&scene.a, &scene.b})
        if (side->motion.precision == Precision::in_double) check_droplets(scene, *side);
    const auto &a = scene.preset.a, &b = scene.preset.b;
    if (differ_in_kind(a, b) || !a.track.is_none() || !b.track.is_none()) return;
    const auto differences = differing_keys(a, b);
    if (differences.empty()) return;
    if (scene.a.motion.precision == Precision::in_quad && scene.b.motion.precision == Precision::in_quad)
        return check_numbers<Quad>(scene, differences);
    check_numbers<double>(scene, differences);
    check_systems<double>(scene, differences);
}

}  // namespace doppel
