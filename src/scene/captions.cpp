#include "scene/captions.hpp"

#include "plot/axis.hpp"
#include "scene/side_keys.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

namespace doppel {
namespace {

const QuadPair at_rest{0, 0};  // m/s

/// A statement about a side. The statements at the same index for both sides are about the same property.
struct Statement {
    std::string text;
    bool is_start_angle = false;
    std::string plain = text;  // in plain wording, without symbols
};

std::string model_words(const Side& side) {
    std::string words(name_of(side.motion.model));
    if (side.motion.stabilise == Stabilise::baumgarte) words += " (Baumgarte)";
    if (side.motion.stabilise == Stabilise::projection) words += " (projected)";
    if (side.motion.precision == Precision::in_quad) words += " in quad";
    return words;
}

/// States a quantity of all links, given for both sides with the same length. Short chains: link by link. Long chains:
/// the common value of the links, or the links in which the sides differ.
void state_links(std::string_view symbol, const std::vector<Quad>& values, const std::vector<Quad>& others,
                 std::string_view unit, bool angle, std::vector<Statement>& all) {
    constexpr std::size_t max_listed = 3;
    const auto alike = [](const std::vector<Quad>& of) {
        return std::all_of(of.begin(), of.end(), [&](const Quad& value) { return value == of[0]; });
    };
    const bool listed = values.size() <= max_listed;
    const auto number = [&](std::size_t i) { return fmt::format("{}{}", text_of(values[i]), unit); };
    if (!listed && alike(values) && alike(others))
        return all.push_back({fmt::format("all {} = {}", symbol, number(0)), angle});
    if (!listed && values == others)
        return all.push_back({fmt::format("{0}₁ = {1}, {0}₂ = {2} …", symbol, number(0), number(1)), angle});
    for (std::size_t i = 0; i < values.size(); ++i)
        if (listed || values[i] != others[i])
            all.push_back({fmt::format("{}{} = {}", symbol, subscript(i + 1), number(i)), angle, number(i)});
}

/// "1.2e-03" → "1.2 × 10⁻³"; other numbers are unchanged.
std::string with_power_of_ten(const std::string& digits) {
    const auto e = digits.find('e');
    if (e == std::string::npos) return digits;
    return fmt::format("{} × {}", digits.substr(0, e), power_of_ten(std::stoi(digits.substr(e + 1))));
}

/// For example 0.001 → "1 mm".
std::string length_words(double metres) {
    if (metres >= 0.1) return fmt::format("{:.6g} m", metres);
    if (metres >= 1e-4) return fmt::format("{:.6g} mm", 1000 * metres);
    return scientific(metres) + " m";
}

/// "1 mm to the right and 2 mm up"
std::string offset_words(const QuadPair& from, const QuadPair& to) {
    const auto x = static_cast<double>(to[0] - from[0]), y = static_cast<double>(to[1] - from[1]);
    std::vector<std::string> parts;
    if (x != 0) parts.push_back(fmt::format("{} to the {}", length_words(std::abs(x)), x > 0 ? "right" : "left"));
    if (y != 0) parts.push_back(fmt::format("{} {}", length_words(std::abs(y)), y > 0 ? "up" : "down"));
    return fmt::format("{}", fmt::join(parts, " and "));
}

/// "bob pushed at 1 mm/s", if the other side's velocity is zero.
std::string speed_words(const QuadPair& velocity, const QuadPair& other) {
    if (velocity == at_rest) return "at rest";
    if (other != at_rest) return fmt::format("with ({}, {}) m/s", text_of(velocity[0]), text_of(velocity[1]));
    const double speed = std::hypot(static_cast<double>(velocity[0]), static_cast<double>(velocity[1]));
    return fmt::format("pushed at {}/s", length_words(speed));
}

/// How the particles of a side differ from those of side a, or, for side a, from the other side's. Particles with the
/// same displacement are named together.
void state_particles(const SideSpec& a, const SideSpec& b, bool of_b, std::vector<Statement>& all) {
    std::vector<std::pair<std::string, std::string>> moved;  // displacement; names of the particles
    for (std::size_t i = 0; i < std::min(a.particles.size(), b.particles.size()); ++i) {
        const auto &one = a.particles[i], &other = b.particles[i];
        const auto &self = of_b ? other : one, &opposite = of_b ? one : other;
        if (one.position_m != other.position_m) {
            const auto how = offset_words(one.position_m, other.position_m);
            const auto same = std::find_if(moved.begin(), moved.end(), [&](const auto& m) { return m.first == how; });
            if (same == moved.end())
                moved.emplace_back(how, one.name);
            else
                same->second += " and " + one.name;
        }
        if (one.velocity_m_per_s != other.velocity_m_per_s)
            all.push_back({self.name + " " + speed_words(self.velocity_m_per_s, opposite.velocity_m_per_s)});
        if (one.mass_kg != other.mass_kg) all.push_back({fmt::format("{} {} kg", self.name, text_of(self.mass_kg))});
    }
    for (const auto& [how, who] : moved) all.push_back({who + " " + (of_b ? how : "in place")});
}

/// The drive, if the other side's is different.
void state_drives(const PhysicalSpec& one, const PhysicalSpec& other, std::vector<Statement>& all) {
    if (one.pivot != other.pivot)
        all.push_back({one.pivot.amplitude_m == 0 ? "pivot at rest"
                                                  : fmt::format("pivot ±{} m at {} Hz", text_of(one.pivot.amplitude_m),
                                                                text_of(one.pivot.frequency_hz))});
    if (one.torques == other.torques) return;
    std::vector<std::string> motors;
    for (const auto& motor : one.torques)
        motors.push_back(fmt::format("{} N m at {} Hz", text_of(motor.amplitude_N_m), text_of(motor.frequency_hz)));
    all.push_back({motors.empty() ? "no motor" : fmt::format("motor {}", fmt::join(motors, " and "))});
}

/// The step size, tolerance or accuracy, if the preset sets it.
std::string control_words(const Side& side) {
    if (!side.choice) return step_control_text(side);
    return fmt::format("accuracy {} rad", tolerance_text(parse_quad(fmt::format("{:g}", side.choice->accuracy))));
}

/// For side b, or for side a.
std::vector<Statement> statements(const Scene& scene, const std::vector<KeyDifference>& differences, bool of_b) {
    const auto &spec = of_b ? scene.preset.b : scene.preset.a, &other = of_b ? scene.preset.a : scene.preset.b;
    const auto& side = of_b ? scene.b : scene.a;
    std::vector<Statement> all;
    if (spec.particles.empty()) {
        state_links("θ", spec.angle_deg, other.angle_deg, "°", true, all);
        state_links("ω", spec.omega_deg_per_s, other.omega_deg_per_s, "°/s", false, all);
        state_links("m", spec.mass_kg, other.mass_kg, " kg", false, all);
        state_links("l", spec.length_m, other.length_m, " m", false, all);
    }
    for (const auto& difference : differences)
        if (difference.any().is_of_links) all.push_back({difference.words(of_b)});
    state_drives(spec.physical, other.physical, all);
    state_particles(scene.preset.a, scene.preset.b, of_b, all);
    for (const auto& difference : differences)
        if (difference.any().is_of_part) all.push_back({difference.words(of_b)});
    const auto place = [](const QuadPair& xy) { return fmt::format("({}, {})", text_of(xy[0]), text_of(xy[1])); };
    const auto is_droplet = [](const PartSpec& force) { return force.kind == PartKind::droplet; };
    const auto droplet = std::find_if(spec.forces.begin(), spec.forces.end(), is_droplet);
    if (droplet != spec.forces.end()) {
        const auto kg = static_cast<double>(droplet->mass_kg);
        const auto mass = kg < 0.001 ? scientific(kg) : text_of(droplet->mass_kg);
        all.push_back({fmt::format("a droplet of {} kg at {} m", mass, place(*droplet->position_m))});
    } else if (std::any_of(other.forces.begin(), other.forces.end(), is_droplet)) {
        all.push_back({"no droplet"});
    }
    all.push_back({fmt::format("g = {} m/s²", text_of(spec.gravity_m_per_s2))});
    // settings that follow from an accuracy alone are not stated as a difference
    const bool chosen = scene.a.choice && scene.b.choice;
    const bool any_model = spec.model == ModelChoice::automatic && other.model == ModelChoice::automatic;
    all.push_back({chosen && any_model ? "" : model_words(side)});
    all.push_back({chosen ? "" : std::string(side.method.title)});
    all.push_back({control_words(side)});
    return all;
}

/// "piece-02.csv, 500 Hz"
std::string track_words(const Side& side, const TrackSpec& spec) {
    const auto& samples = side.replay->samples();
    const double rate = static_cast<double>(samples.size() - 1) / samples.duration();
    return fmt::format("{}, {} Hz", std::filesystem::path(spec.file).filename().string(), two_digits(rate));
}

/// For a measured pendulum or its simulation.
SideCaptions captions_of_track(const Side& side, const TrackSpec& track) {
    if (side.replay) return {"measured", track_words(side, track)};
    return {"computed", fmt::format("{}, {}", side.method.title, control_words(side))};
}

std::string system_words(const SideSpec& side, std::string_view plural = "s") {
    if (!side.particles.empty()) {
        const auto masses = side.particles.size();
        return fmt::format("mechanism{} of {}", plural, masses == 1 ? "one mass" : fmt::format("{} masses", masses));
    }
    return chain_words(side.links(), plural);
}

std::string joined(const std::vector<std::string>& parts) {
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// For a side of another type than the other one: the system and its start.
SideCaptions captions_of_kind(const SideSpec& spec, const std::vector<Statement>& all) {
    std::vector<std::string> start;
    for (const auto& statement : all)
        if (statement.is_start_angle) start.push_back(statement.text);
    return {system_words(spec, ""), joined(start)};
}

/// For side b or side a: the difference from the other side.
SideCaptions difference_captions(const std::array<std::vector<Statement>, 2>& all,
                                 const std::vector<KeyDifference>& differences, bool of_b, bool has_label,
                                 Wording wording) {
    std::vector<std::string> differs, start;
    const auto &own = all[of_b ? 1 : 0], &others = all[of_b ? 0 : 1];
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (i >= others.size() || own[i].text != others[i].text)
            differs.push_back(wording == Wording::plain ? own[i].plain : own[i].text);
        else if (own[i].is_start_angle && wording == Wording::exact)
            start.push_back(own[i].text);
    }
    // differences that no statement covers
    if (differs.empty())
        for (const auto& difference : differences) differs.push_back(difference.words(of_b));
    const bool says_nothing = differs.empty();
    if (says_nothing) differs.push_back(of_b ? "b, the same" : "a");
    // a heading contains two statements; the others go to the note
    constexpr std::size_t maximum = 2, max_noted = 4;
    start.insert(start.begin(), differs.begin() + static_cast<long>(std::min(maximum, differs.size())), differs.end());
    if (start.size() > max_noted) {
        start.resize(max_noted);
        start.back() = "…";
    }
    differs.resize(std::min(maximum, differs.size()));
    // with a label set by the preset, the note also states the difference
    if (has_label && !says_nothing) start.insert(start.begin(), differs.begin(), differs.end());
    return {joined(differs), joined(start)};
}

}  // namespace

std::string physical_words(const PhysicalSpec& physical) {
    std::vector<std::string> words;
    for (const auto& property : PhysicalSpec::properties)
        if (physical.has(property) && (words.empty() || words.back() != property.kind))
            words.emplace_back(property.kind);
    if (physical.pivot.amplitude_m != 0) words.push_back("a moving pivot");
    if (!physical.torques.empty()) words.push_back("motors");
    return fmt::format("{}", fmt::join(words, ", "));
}

std::string chain_words(std::size_t links, std::string_view plural) {
    constexpr std::array<std::string_view, 3> words{"", "double ", "triple "};
    if (links > words.size()) return fmt::format("chain{} of {} links", plural, links);
    return fmt::format("{}pendulum{}", words[links - 1], plural);
}

std::string subscript(std::size_t number) {
    constexpr std::array<std::string_view, 10> digits{"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
    std::string text;
    for (const char digit : fmt::format("{}", number)) text += digits[static_cast<std::size_t>(digit - '0')];
    return text;
}

std::string step_control_text(const Side& side) {
    if (side.method.adaptive) return "tolerance " + tolerance_text(side.motion.tolerance);
    const auto& step = side.step;
    return step.numerator == 1 ? fmt::format("1/{} s", grouped(step.denominator)) : fmt::format("{} s", step.value());
}

std::string tolerance_text(const Quad& tolerance) {
    const auto text = with_power_of_ten(text_of(tolerance));
    return text.starts_with("1 × ") ? text.substr(std::string_view("1 × ").size()) : text;
}

std::string grouped(long number) {
    auto digits = fmt::format("{}", number);
    if (digits.size() < 5) return digits;
    for (auto at = static_cast<long>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), " ");
    return digits;
}

std::string two_digits(double value) {
    return with_digits(value, 2);
}

std::string with_digits(double value, int digits) {
    const double unit = std::pow(10.0, std::floor(std::log10(std::max(value, 1.0))) - digits + 1);
    return unit < 1 ? fmt::format("{:.{}g}", value, digits) : grouped(std::lround(std::round(value / unit) * unit));
}

std::array<SideCaptions, 2> side_captions(const Scene& scene, Wording wording) {
    const std::array specs{&scene.preset.a, &scene.preset.b};
    const bool has_track = scene.a.replay || scene.b.replay, differ = differ_in_kind(*specs[0], *specs[1]);
    std::vector<KeyDifference> differences;
    std::array<std::vector<Statement>, 2> all;
    if (!has_track) {
        differences = differing_keys(*specs[0], *specs[1]);
        all = {statements(scene, differences, false), statements(scene, differences, true)};
    }
    if (scene.is_single()) {
        const auto& spec = *specs[0];
        const auto start = has_track ? track_words(scene.a, spec.track) : captions_of_kind(spec, all[0]).note;
        return {SideCaptions{spec.label.value_or(start), spec.note.value_or(spec.label ? start : "")}, {}};
    }
    std::array<SideCaptions, 2> words;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto& spec = *specs[i];
        words[i] = has_track ? captions_of_track(i == 0 ? scene.a : scene.b, spec.track)
                   : differ  ? captions_of_kind(spec, all[i])
                             : difference_captions(all, differences, i == 1, spec.label.has_value(), wording);
        words[i] = {spec.label.value_or(words[i].heading), spec.note.value_or(words[i].note)};
    }
    return words;
}

std::string scene_caption(const Scene& scene, Wording wording) {
    if (scene.preset.subtitle) return *scene.preset.subtitle;
    if (scene.is_single() && scene.a.replay) return "a real double pendulum";
    if (scene.a.replay && scene.b.replay) return "two real double pendulums";
    if (scene.a.replay || scene.b.replay) return "a real double pendulum and its simulation";
    const auto is_at_rest = [](const SideSpec& side) {
        const auto is_moving = [](const ParticleSpec& particle) { return particle.velocity_m_per_s != at_rest; };
        return side.particles.empty() ? is_zero(side.omega_deg_per_s) : std::ranges::none_of(side.particles, is_moving);
    };
    std::vector<std::string> common;
    if (model_words(scene.a) == model_words(scene.b)) common.push_back(model_words(scene.a));
    if (scene.a.method.name == scene.b.method.name) common.emplace_back(scene.a.method.title);
    if (control_words(scene.a) == control_words(scene.b)) common.push_back(control_words(scene.a));
    if (wording == Wording::plain) common.clear();
    const auto number = scene.members.empty() ? std::string("two") : grouped(static_cast<long>(scene.members.size()));
    const auto one = [](const SideSpec& side) { return system_words(side, ""); };
    const auto systems = scene.is_single() ? "a " + one(scene.preset.a)
                         : differ_in_kind(scene.preset.a, scene.preset.b)
                             ? fmt::format("a {} and a {}", one(scene.preset.a), one(scene.preset.b))
                             : fmt::format("{} {}", number, system_words(scene.preset.a));
    const auto physical = physical_words(scene.preset.a.physical);
    const bool alike = !physical.empty() && physical == physical_words(scene.preset.b.physical);
    return fmt::format("{}{}{}{}{}", systems, alike ? " with " + physical : "",
                       !alike && is_at_rest(scene.preset.a) && is_at_rest(scene.preset.b) ? ", released at rest" : "",
                       common.empty() ? "" : " · ", joined(common));
}

std::string scientific(double value) {
    if (!(value > 0)) return "0";
    if (value >= 0.1 && value < 1000) return two_digits(value);
    return with_power_of_ten(fmt::format("{:.1e}", value));
}

}  // namespace doppel
