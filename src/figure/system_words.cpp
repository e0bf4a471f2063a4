#include "figure/system_words.hpp"

#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace doppel {
namespace {

constexpr std::size_t max_named = 4;  // shorter chains have each link named

/// "1", or "1, 2, 0.5" if they differ; for long lists the minimum and maximum.
std::string numbers_words(const std::vector<Quad>& quads) {
    std::vector<double> numbers;
    for (const auto& number : quads) numbers.push_back(static_cast<double>(number));
    const auto [minimum, maximum] = std::minmax_element(numbers.begin(), numbers.end());
    if (*minimum == *maximum) return fmt::format("{}", *minimum);
    return numbers.size() > max_named ? fmt::format("{} to {}", *minimum, *maximum)
                                      : fmt::format("{}", fmt::join(numbers, ", "));
}

/// The numbers to name: the first of many equal ones, none of many different ones.
std::vector<Quad> named(const std::vector<Quad>& numbers) {
    if (numbers.size() <= max_named) return numbers;
    const bool are_one = std::count(numbers.begin(), numbers.end(), numbers.front()) == std::ssize(numbers);
    return are_one ? std::vector{numbers.front()} : std::vector<Quad>{};
}

std::string number_words(std::size_t number) {
    constexpr std::array words{"no", "one", "two", "three", "four", "five", "six"};
    return number < words.size() ? words[number] : grouped(static_cast<long>(number));
}

/// Rounded to three digits.
std::string short_text(const Quad& number) {
    return fmt::format("{:.3g}", static_cast<double>(number));
}

std::string degrees(const Quad& angle) {
    return angle == 0 ? "0" : text_of(angle) + "°";
}

bool is_swept(const SweptKeys& swept, std::string_view key) {
    return std::ranges::any_of(swept.keys, [&](const auto& path) { return path.ends_with(key); });
}

std::string model_words(const Scene& scene, const SweptKeys& swept) {
    const auto model = scene.a.motion.model;
    const auto count = scene.preset.a.particles.empty() ? scene.preset.a.links() : scene.preset.a.particles.size();
    const bool particles = !scene.preset.a.particles.empty() || model == Model::constraints;
    auto words = is_swept(swept, "links") ? "chains"
                                          : fmt::format("{} {}{}", number_words(count), particles ? "particle" : "link",
                                                        count == 1 ? "" : "s");
    if (model == scene.b.motion.model && !is_swept(swept, ".model") && !is_swept(swept, ".integrator"))
        words += model == Model::angles        ? " in angles"
                 : model == Model::constraints ? " with constraints"
                                               : " as a mechanism";
    return words;
}

/// The common release angles of both sides: "90°/90°", or the constant ones, "θ₂ = θ₃ = 0".
std::string release_words(const Scene& scene, const SweptKeys& swept) {
    constexpr std::size_t maximum = 3;
    const auto &angles = scene.preset.a.angle_deg, &others = scene.preset.b.angle_deg;
    if (!scene.preset.a.particles.empty() || angles.size() > maximum || is_swept(swept, ".angle_deg")) return "";
    if (is_swept(swept, "links")) return fmt::format("released from {}", degrees(angles.front()));
    const auto is_swept_link = [&](std::size_t i) { return std::ranges::find(swept.angles, i) != swept.angles.end(); };
    if (swept.angles.empty() && angles == others) return slashed(angles, "°");
    std::string named;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (is_swept_link(i) || angles[i] != others[i]) continue;
        const bool same = !named.empty() && i > 0 && angles[i] == angles[i - 1] && !is_swept_link(i - 1);
        const auto name = fmt::format("θ{}", subscript(i + 1)), value = degrees(angles[i]);
        if (same)
            named.insert(named.rfind(" = "), " = " + name);
        else
            named += fmt::format("{}{} = {}", named.empty() ? "" : ", ", name, value);
    }
    return named;
}

/// The properties of links besides mass and length, with their values if these are few: "torque of 0.5 Hz, joint
/// friction 0.459 N m s".
std::string drive_words(const SideSpec& side, const SweptKeys& swept) {
    const auto& physical = side.physical;
    if (physical.is_none()) return "";
    std::vector<std::string> words;
    for (const auto& torque : physical.torques)
        words.push_back(fmt::format("torque of {} Hz", short_text(torque.frequency_hz)));
    if (physical.pivot.amplitude_m != 0 && !is_swept(swept, "frequency_hz"))
        words.push_back(fmt::format("pivot shaken at {} Hz", short_text(physical.pivot.frequency_hz)));
    if (const auto& joints = physical.joint_viscous_N_m_s;
        !joints.empty() && !is_swept(swept, "joint_viscous_N_m_s") && !is_zero(joints) &&
        std::count(joints.begin(), joints.end(), joints[0]) == std::ssize(joints))
        words.push_back(fmt::format("joint friction {} N m s", short_text(joints[0])));
    return words.empty() ? physical_words(physical) : fmt::format("{}", fmt::join(words, ", "));
}

std::string rate_words(const SideSpec& a, const SideSpec& b) {
    const auto& rates = a.omega_deg_per_s;
    constexpr std::size_t maximum = 3;
    if (!a.particles.empty() || is_zero(rates) || rates != b.omega_deg_per_s || rates.size() > maximum) return "";
    return fmt::format("ω = {} °/s", slashed(rates));
}

/// The common integrator and settings of both sides.
std::string method_words(const Scene& scene, const SweptKeys& swept) {
    std::vector<std::string> words;
    const bool has_one_method = !is_swept(swept, ".integrator"), has_one_step = !swept.step && has_one_method;
    const auto &a = scene.a, &b = scene.b;
    const auto &accuracy = scene.preset.a.accuracy, &other = scene.preset.b.accuracy;
    if (accuracy && other && *accuracy == *other) {
        if (has_one_step) words.push_back(fmt::format("accuracy {} rad", text_of(*accuracy)));
    } else {
        if (a.method.name == b.method.name && has_one_method) words.emplace_back(a.method.title);
        if (step_control_text(a) == step_control_text(b) && has_one_step) words.push_back(step_control_text(a));
    }
    if (a.motion.precision == Precision::in_quad && b.motion.precision == Precision::in_quad &&
        !is_swept(swept, ".precision"))
        words.emplace_back("in quad");
    return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::string slashed(const std::vector<Quad>& numbers, std::string_view unit) {
    std::vector<std::string> texts;
    for (const auto& number : numbers) texts.push_back(fmt::format("{}{}", text_of(number), unit));
    return fmt::format("{}", fmt::join(texts, "/"));
}

std::string released_words(const SideSpec& side) {
    const auto angles = named(side.angle_deg), rates = named(side.omega_deg_per_s);
    const bool rests = is_zero(side.omega_deg_per_s);
    std::string words = rests ? "released at rest" : "released";
    if (!angles.empty()) words += " from " + slashed(angles, "°");
    if (!rests && !rates.empty()) words += fmt::format(" at {} °/s", slashed(rates));
    return words;
}

std::string links_words(const SideSpec& side) {
    return fmt::format("{} of {} m and {} kg, g = {} m/s²", side.links() == 1 ? "a link" : "links",
                       numbers_words(side.length_m), numbers_words(side.mass_kg),
                       static_cast<double>(side.gravity_m_per_s2));
}

std::string pair_subtitle(const Scene& scene, const SweptKeys& swept, const std::string& difference) {
    const auto sides = side_captions(scene);
    std::vector<std::string> parts{
        model_words(scene, swept),
        drive_words(scene.preset.a, swept),
        release_words(scene, swept),
        rate_words(scene.preset.a, scene.preset.b),
        difference,
        sides[0].heading == "a" ? "" : fmt::format("{} against {}", sides[0].heading, sides[1].heading)};
    std::erase(parts, "");
    const auto method = swept.method.empty() ? method_words(scene, swept) : swept.method;
    return fmt::format("{}{}{}", fmt::join(parts, ", "), method.empty() ? "" : "; ", method);
}

}  // namespace doppel
