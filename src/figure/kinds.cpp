#include "figure/kinds.hpp"

#include "scene/captions.hpp"
#include "scene/side_keys.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace doppel {

Preset FigureReader::read_pair(const std::vector<TomlReader*>& more) {
    Preset preset;
    preset.name = preset.title = name;
    clock_fields(scene, preset);
    std::vector<TomlReader*> levels{&top};
    levels.insert(levels.end(), more.begin(), more.end());
    read_sides(document, levels, preset);
    return preset;
}

Preset FigureReader::pair(const std::vector<TomlReader*>& more) {
    auto preset = read_pair(more);
    check_clock(preset, scene);
    return preset;
}

std::vector<TomlReader> FigureReader::entries(std::string_view key) {
    std::vector<TomlReader> all;
    for (const auto* table : top.read_tables(key))
        all.push_back(top.inner(table, fmt::format("[[{}]] {}", key, all.size() + 1)));
    return all;
}

SideSpec FigureReader::release(bool physical) {
    SideSpec side;
    auto system = document.table(top, "system");
    read_release(system, side, physical);
    return side;
}

const MethodEntry& method_named(const TomlReader& table, const std::string& name) {
    if (const auto* method = find_method(name)) return *method;
    throw table.fault("methods", "must be names of methods (doppel list methods); \"{}\" is not", name);
}

const ReleaseParameter& release_parameter(std::string_view name) {
    static constexpr std::array<ReleaseParameter, 4> all{
        {{"theta1_deg", "release angle θ₁, °", 1, [](SideSpec& s, const Quad& x) { s.angle_deg[0] = x; }, 30, false},
         {"theta2_deg", "release angle θ₂, °", 2, [](SideSpec& s, const Quad& x) { s.angle_deg[1] = x; }, 30, false},
         {"mass_ratio", "mass ratio m₁/m₂", 2, [](SideSpec& s, const Quad& x) { s.mass_kg[0] = x * s.mass_kg[1]; }, 0,
          true},
         {"length_ratio", "length ratio l₁/l₂", 2,
          [](SideSpec& s, const Quad& x) { s.length_m[0] = x * s.length_m[1]; }, 0, true}}};
    return *std::find_if(all.begin(), all.end(), [&](const auto& parameter) { return parameter.name == name; });
}

void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names) {
    for (const auto& name : names)
        if (std::count(names.begin(), names.end(), name) > 1)
            throw table.fault(key, "must differ; \"{}\" is named more than once", name);
}

std::string commented(std::string_view text) {
    std::string lines = "#";
    for (const char c : text) lines += c == '\n' ? std::string("\n# ") : std::string(1, c);
    return lines + "\n";
}

Preset film_named(const std::string& name, const TomlReader& table) {
    const auto source = [&] {
        try {
            return find_preset(name);
        } catch (const Error& fault) {
            throw table.fault("scene", "cannot be taken: {}", fault.what());
        }
    }();
    table.demand_drawable("scene", source.name);
    if (is_figure(source)) throw table.fault("scene", "must name a film; \"{}\" is a figure", name);
    return read_preset(source);
}

namespace {

std::string number_words(std::size_t number) {
    constexpr std::array words{"no", "one", "two", "three", "four", "five", "six"};
    return number < words.size() ? words[number] : grouped(static_cast<long>(number));
}

std::string degrees(const Quad& angle) {
    return angle == 0 ? "0" : text_of(angle) + "°";
}

bool is_varied(const Varied& varied, std::string_view key) {
    return std::any_of(varied.keys.begin(), varied.keys.end(), [&](const auto& path) { return path.ends_with(key); });
}

std::string model_words(const Scene& scene, const Varied& varied) {
    const auto model = scene.a.motion.model;
    const auto count = scene.preset.a.particles.empty() ? scene.preset.a.links() : scene.preset.a.particles.size();
    const bool particles = !scene.preset.a.particles.empty() || model == Model::constraints;
    auto words = is_varied(varied, "links") ? "chains"
                                            : fmt::format("{} {}{}", number_words(count),
                                                          particles ? "particle" : "link", count == 1 ? "" : "s");
    if (model == scene.b.motion.model && !is_varied(varied, ".model") && !is_varied(varied, ".integrator"))
        words += model == Model::angles ? " in angles" : model == Model::constraints ? " on rods" : " as a mechanism";
    return words;
}

/// The angles that both sides are released at: "90°/90°", or those that are named, "θ₂ = θ₃ = 0".
std::string release_words(const Scene& scene, const Varied& varied) {
    constexpr std::size_t most = 3;
    const auto &angles = scene.preset.a.angle_deg, &others = scene.preset.b.angle_deg;
    if (!scene.preset.a.particles.empty() || angles.size() > most || is_varied(varied, ".angle_deg")) return "";
    if (is_varied(varied, "links")) return fmt::format("released from {}", degrees(angles.front()));
    const auto is_swept = [&](std::size_t i) {
        return std::find(varied.angles.begin(), varied.angles.end(), i) != varied.angles.end();
    };
    std::string all, named;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        all += fmt::format("{}{}°", all.empty() ? "" : "/", text_of(angles[i]));
        if (is_swept(i) || angles[i] != others[i]) continue;
        const bool same = !named.empty() && i > 0 && angles[i] == angles[i - 1] && !is_swept(i - 1);
        const auto name = fmt::format("θ{}", subscript(i + 1)), value = degrees(angles[i]);
        if (same)
            named.insert(named.rfind(" = "), " = " + name);
        else
            named += fmt::format("{}{} = {}", named.empty() ? "" : ", ", name, value);
    }
    return varied.angles.empty() && angles == others ? all : named;
}

std::string rate_words(const SideSpec& a, const SideSpec& b) {
    const auto& rates = a.omega_deg_per_s;
    constexpr std::size_t most = 3;
    if (!a.particles.empty() || is_zero(rates) || rates != b.omega_deg_per_s || rates.size() > most) return "";
    std::vector<std::string> texts;
    for (const auto& rate : rates) texts.push_back(text_of(rate));
    return fmt::format("ω = {} °/s", fmt::join(texts, "/"));
}

/// What both sides have in common of how they are stepped.
std::string method_words(const Scene& scene, const Varied& varied) {
    std::vector<std::string> words;
    const bool has_one_method = !is_varied(varied, ".integrator"), has_one_step = !varied.step && has_one_method;
    const auto &a = scene.a, &b = scene.b;
    const auto &accuracy = scene.preset.a.accuracy, &other = scene.preset.b.accuracy;
    if (accuracy && other && *accuracy == *other) {
        if (has_one_step) words.push_back(fmt::format("accuracy {} rad", text_of(*accuracy)));
    } else {
        if (a.method.name == b.method.name && has_one_method) words.emplace_back(a.method.title);
        if (step_control_text(a) == step_control_text(b) && has_one_step) words.push_back(step_control_text(a));
    }
    if (a.motion.precision == Precision::in_quad && b.motion.precision == Precision::in_quad &&
        !is_varied(varied, ".precision"))
        words.emplace_back("in quad");
    return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

bool released_alike(const SideSpec& a, const SideSpec& b) {
    const auto same = [](const ParticleSpec& one, const ParticleSpec& other) {
        return one.mass_kg == other.mass_kg && one.position_m == other.position_m &&
               one.velocity_m_per_s == other.velocity_m_per_s;
    };
    return a.mass_kg == b.mass_kg && a.length_m == b.length_m && a.angle_deg == b.angle_deg &&
           a.omega_deg_per_s == b.omega_deg_per_s &&
           std::equal(a.particles.begin(), a.particles.end(), b.particles.begin(), b.particles.end(), same);
}

bool are_one(const Scene& scene) {
    auto b = scene.preset.b;
    b.model = scene.preset.a.model;  // what was made of them is compared
    return scene.a.motion.model == scene.b.motion.model && differing_keys(scene.preset.a, b).empty();
}

std::string pair_subtitle(const Scene& scene, const Varied& varied, const std::string& apart) {
    std::vector<std::string> parts{model_words(scene, varied)};
    const auto add = [&](std::string words) {
        if (!words.empty()) parts.push_back(std::move(words));
    };
    add(release_words(scene, varied));
    add(rate_words(scene.preset.a, scene.preset.b));
    add(apart);
    if (const auto sides = side_captions(scene); sides[0].heading != "a")
        add(fmt::format("{} against {}", sides[0].heading, sides[1].heading));
    const auto method = varied.method.empty() ? method_words(scene, varied) : varied.method;
    return fmt::format("{}{}{}", fmt::join(parts, ", "), method.empty() ? "" : "; ", method);
}

std::span<const FigureKind> figure_kinds() {
    static const std::array<FigureKind, scene_kinds.size() - 1> kinds{grid_kind,      curves_kind,  convergence_kind,
                                                                      spectrum_kind,  section_kind, work_precision_kind,
                                                                      stability_kind, drift_kind};
    return kinds;
}

}  // namespace doppel
